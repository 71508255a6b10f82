// A pattern that shows how texture coordinates stretch and where they are cut.

import { CanvasTexture, RepeatWrapping, SRGBColorSpace } from 'three';

const SQUARES = 16;
const PIXELS = 64;

/** Squares of two greys; rows and columns have hues of their own, so that places can be told apart. */
export function checkerTexture() {
  const canvas = document.createElement('canvas');
  canvas.width = SQUARES * PIXELS;
  canvas.height = SQUARES * PIXELS;
  const context = canvas.getContext('2d');
  for (let row = 0; row < SQUARES; row++) {
    for (let column = 0; column < SQUARES; column++) {
      const isDark = (row + column) % 2 === 0;
      const hue = Math.round((360 * column) / SQUARES);
      context.fillStyle = `hsl(${hue} ${20 + 3 * row}% ${isDark ? 38 : 82}%)`;
      context.fillRect(column * PIXELS, row * PIXELS, PIXELS, PIXELS);
    }
  }
  const texture = new CanvasTexture(canvas);
  texture.wrapS = RepeatWrapping;
  texture.wrapT = RepeatWrapping;
  texture.colorSpace = SRGBColorSpace;
  texture.anisotropy = 8;
  return texture;
}
