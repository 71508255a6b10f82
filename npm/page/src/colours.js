// The colours of distances: viridis, which colour-blind people can read and which prints in grey.

const VIRIDIS = ['440154', '472d7b', '3b528b', '2c728e', '21918c', '28ae80', '5ec962', 'addc30', 'fde725'];

/** A gradient from none to all. */
export const GRADIENT = `linear-gradient(to right, ${VIRIDIS.map((hex) => `#${hex}`).join(', ')})`;

const vector = (hex) => {
  const parts = [0, 2, 4].map((at) => (parseInt(hex.slice(at, at + 2), 16) / 255).toFixed(4));
  return `vec3(${parts.join(', ')})`;
};

/** A function of a shader: the colour of a share, in the picture's own colours. */
export const SHADER = `
vec3 colourOfShare(float share) {
  const vec3 colours[${VIRIDIS.length}] = vec3[](${VIRIDIS.map(vector).join(', ')});
  float place = clamp(share, 0.0, 1.0) * ${(VIRIDIS.length - 1).toFixed(1)};
  int below = min(int(place), ${VIRIDIS.length - 2});
  return mix(colours[below], colours[below + 1], place - float(below));
}`;
