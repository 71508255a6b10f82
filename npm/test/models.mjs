/** Meshes to test with: the built-in models, and shapes of closed form. */

import { execFileSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';

const here = dirname(fileURLToPath(import.meta.url));
const folder = join(here, 'models');

/** A built-in model, as the native library generates it. */
export function modelOf(name) {
  if (!existsSync(folder)) {
    const words = ['run', '--locked', '--quiet', '--package', 'limitmesh-models', '--example', 'models', '--', folder];
    execFileSync('cargo', words, { cwd: join(here, '..', '..'), stdio: 'inherit' });
  }
  const file = extension => join(folder, `${name}.${extension}`);
  const bytes = extension => new Uint8Array(readFileSync(file(extension))).buffer;
  const faceSize = existsSync(file('index4')) ? 4 : 3;
  return { positions: new Float64Array(bytes('positions')), index: new Uint32Array(bytes(`index${faceSize}`)), faceSize };
}

/** A torus knot as three.js makes it by TorusKnotGeometry(1, 0.4, around, radial), with every vertex once. */
export function torusKnot(around = 128, radial = 8) {
  const positions = new Float32Array(3 * around * radial);
  const at = u => {
    const [p, q] = [2, 3];
    const over = (q / p) * u;
    return [(2 + Math.cos(over)) * 0.5 * Math.cos(u), (2 + Math.cos(over)) * Math.sin(u) * 0.5, Math.sin(over) * 0.5];
  };
  for (let i = 0; i < around; i++) {
    const u = (i / around) * 2 * Math.PI * 2;
    const [a, b] = [at(u), at(u + 0.01)];
    const tangent = a.map((x, k) => b[k] - x);
    const binormal = unit(cross(tangent, a.map((x, k) => b[k] + x)));
    const normal = unit(cross(binormal, tangent));
    for (let j = 0; j < radial; j++) {
      const v = (j / radial) * 2 * Math.PI;
      const [cx, cy] = [-0.4 * Math.cos(v), 0.4 * Math.sin(v)];
      a.forEach((x, k) => (positions[3 * (i * radial + j) + k] = x + cx * normal[k] + cy * binormal[k]));
    }
  }
  const index = [];
  const vertex = (i, j) => (i % around) * radial + (j % radial);
  for (let i = 0; i < around; i++) {
    for (let j = 0; j < radial; j++) {
      const [a, b, c, d] = [vertex(i, j), vertex(i, j + 1), vertex(i + 1, j + 1), vertex(i + 1, j)];
      index.push(a, d, b, b, d, c);
    }
  }
  return { positions, index: Uint32Array.from(index) };
}

function cross(a, b) {
  return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];
}

function unit(a) {
  const length = Math.hypot(...a);
  return a.map(x => x / length);
}
