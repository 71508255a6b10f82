/**
 * Faces that the engine turned round: those against their neighbours, and surfaces that are inside out. In a scene the winding says which
 * side is drawn, as of the inside of a sky, so that they are turned back. A face is turned if its triangles look the other way on the whole.
 */

import type { Joined } from './join.js';
import type { Refined } from './types.js';

/** By face, whether it was turned. */
export function turnedFaces({ positions: cage, index: faces }: Joined, { positions, index, parents, diagnosis }: Refined): Uint8Array {
  const turned = new Uint8Array(faces.length / 3);
  const { flipped_faces: flipped, inside_out_components: insideOut } = diagnosis.findings;
  if (!flipped?.count && !insideOut?.count) return turned;
  const sums = new Float64Array(turned.length);
  parents.forEach((face, triangle) => (sums[face]! += dot(area(positions, index, triangle), area(cage, faces, face))));
  return turned.map((_, face) => (sums[face]! < 0 ? 1 : 0));
}

/** A triangle's normal, as long as its area twice. */
function area(positions: ArrayLike<number>, index: Uint32Array, triangle: number): number[] {
  const at = (corner: number, i: number) => positions[3 * index[3 * triangle + corner]! + i]!;
  const [u, v] = [1, 2].map(corner => [0, 1, 2].map(i => at(corner, i) - at(0, i))) as [number[], number[]];
  return [0, 1, 2].map(i => u[(i + 1) % 3]! * v[(i + 2) % 3]! - u[(i + 2) % 3]! * v[(i + 1) % 3]!);
}

function dot(a: number[], b: number[]): number {
  return a[0]! * b[0]! + a[1]! * b[1]! + a[2]! * b[2]!;
}
