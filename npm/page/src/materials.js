// How surfaces are drawn: the file's own materials or ours, all with edges over them.

import { Color, DoubleSide, MeshStandardMaterial } from 'three';
import { SHADER } from './colours.js';

// The corner of its triangle that a vertex is, as triangles share no vertices here.
const CORNER_VERTEX = `
int corner = gl_VertexID % 3;
vCorner = vec3(float(corner == 0), float(corner == 1), float(corner == 2));`;

// Edges one pixel wide; where triangles are smaller than some pixels they would cover everything.
const EDGES = `
vec3 acrossPixel = fwidth(vCorner);
vec3 fromEdges = smoothstep(vec3(0.0), 1.3 * acrossPixel, vCorner);
float onEdge = 1.0 - min(min(fromEdges.x, fromEdges.y), fromEdges.z);
onEdge *= 1.0 - smoothstep(0.25, 0.6, max(max(acrossPixel.x, acrossPixel.y), acrossPixel.z));
gl_FragColor.rgb = mix(gl_FragColor.rgb, edgeColour, edgesShown * onEdge);`;

// In place of the material's own light: the legend's colour, a little darker where the surface turns away.
const DISTANCE = `
float facing = abs(dot(normalize(normal), normalize(vViewPosition)));
gl_FragColor = vec4(colourOfShare(vDistance / greatestDistance) * (0.8 + 0.2 * facing), 1.0);`;

/** What all materials of a stage share. */
export class Materials {
  uniforms = {
    edgesShown: { value: 0 },
    edgeColour: { value: new Color() },
    greatestDistance: { value: 1 },
  };

  constructor(checker) {
    this.plain = this.withEdges(this.standard({ roughness: 0.55 }));
    this.checker = this.withEdges(this.standard({ roughness: 0.7, map: checker }));
    this.distance = this.withDistances(this.standard({}));
  }

  standard(options) {
    // Pushed back a little, so that the cage lies over it.
    return new MeshStandardMaterial({
      side: DoubleSide,
      polygonOffset: true,
      polygonOffsetFactor: 1,
      polygonOffsetUnits: 1,
      ...options,
    });
  }

  /** Draws edges over a material. */
  withEdges(material) {
    material.onBeforeCompile = (shader) => this.insert(shader, '', '', EDGES);
    return material;
  }

  withDistances(material) {
    material.onBeforeCompile = (shader) => {
      this.insert(shader, 'varying float vDistance;', SHADER, DISTANCE + EDGES);
      shader.vertexShader = shader.vertexShader
        .replace('#include <common>', '#include <common>\nattribute float distanceOfTriangle;')
        .replace('#include <begin_vertex>', '#include <begin_vertex>\nvDistance = distanceOfTriangle;');
    };
    material.customProgramCacheKey = () => 'distance';
    return material;
  }

  insert(shader, varyings, functions, end) {
    Object.assign(shader.uniforms, this.uniforms);
    const both = `#include <common>\nvarying vec3 vCorner;\n${varyings}`;
    shader.vertexShader = shader.vertexShader
      .replace('#include <common>', both)
      .replace('#include <begin_vertex>', `#include <begin_vertex>${CORNER_VERTEX}`);
    const own = 'uniform float edgesShown;\nuniform vec3 edgeColour;\nuniform float greatestDistance;';
    shader.fragmentShader = shader.fragmentShader
      .replace('#include <common>', `${both}\n${own}\n${functions}`)
      .replace('#include <dithering_fragment>', `#include <dithering_fragment>${end}`);
  }

  /** Colours for light or dark surroundings. Edges are in the picture's own colours. */
  setDark(isDark) {
    this.plain.color.set(isDark ? 0x8ea3b8 : 0xb4c2d0);
    this.uniforms.edgeColour.value.setRGB(0.05, 0.06, 0.08);
  }
}
