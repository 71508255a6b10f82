/**
 * How morph targets change normals. Limit normals are known of the mesh at rest; those of a moved one are estimated from its triangles, by
 * Max's weights (1999), less what the same estimate gives at rest, so that what does not move keeps its limit normals.
 */

import type { Surface } from './carry.js';
import type { RefinedChannel } from './types.js';

/** By vertex of the surface, what a target adds to its normal; 0 where there is none then. */
export function addedNormals(index: Uint32Array, surface: Surface, positions: ArrayLike<number>, moved: RefinedChannel): Float32Array {
  const added = estimated(surface, corner => {
    const [at, by] = [3 * index[corner]!, 3 * moved.index[corner]!];
    return [positions[at]! + moved.data[by]!, positions[at + 1]! + moved.data[by + 1]!, positions[at + 2]! + moved.data[by + 2]!];
  });
  const rest = estimated(surface, corner => {
    const at = 3 * index[corner]!;
    return [positions[at]!, positions[at + 1]!, positions[at + 2]!];
  });
  return Float32Array.from(added, (x, i) => {
    const first = i - (i % 3);
    return added[first] === 0 && added[first + 1] === 0 && added[first + 2] === 0 ? 0 : x - rest[i]!;
  });
}

type Point = [number, number, number];

function estimated({ vertices, normals }: Surface, pointAt: (corner: number) => Point): Float64Array {
  const sums = new Float64Array(normals.length);
  for (let first = 0; first < vertices.length; first += 3) {
    const points = [pointAt(first), pointAt(first + 1), pointAt(first + 2)];
    for (let i = 0; i < 3; i++) add(sums, vertices[first + i]!, points[i]!, points[(i + 1) % 3]!, points[(i + 2) % 3]!);
  }
  for (let at = 0; at < sums.length; at += 3) {
    const length = Math.hypot(sums[at]!, sums[at + 1]!, sums[at + 2]!);
    for (let i = at; i < at + 3; i++) sums[i] = length > 0 && length < Infinity ? sums[i]! / length : 0;
  }
  return sums;
}

/** Adds what the triangle at a corner says of a vertex's normal. */
function add(sums: Float64Array, vertex: number, a: Point, b: Point, c: Point): void {
  const [u, v] = [minus(b, a), minus(c, a)];
  const lengths = dot(u, u) * dot(v, v);
  if (!(lengths > 0)) return;
  for (let i = 0; i < 3; i++) {
    const [j, k] = [(i + 1) % 3, (i + 2) % 3];
    sums[3 * vertex + i]! += (u[j]! * v[k]! - u[k]! * v[j]!) / lengths;
  }
}

function minus(a: Point, b: Point): Point {
  return [a[0] - b[0], a[1] - b[1], a[2] - b[2]];
}

function dot(a: Point, b: Point): number {
  return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
