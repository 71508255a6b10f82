/** What adapters refine: parts of a mesh, each with triangles of one material and all that its vertices carry. */

import { LimitmeshError } from './error.js';
import type { Semantic } from './types.js';

/** Triangles with vertices of their own. */
export interface Part {
  /** Three numbers a vertex. */
  positions: Float64Array;
  /** Three vertices a triangle. */
  corners: Uint32Array;
  /** By morph target, how it moves the vertices; null where it does not. */
  displacements: (Float64Array | null)[];
  /** By vertex, the joints that move it with their weights above 0, by joint. */
  influences: Influence[][] | null;
  /** All else that is carried. */
  values: PartValues[];
}

/** A joint and its weight. */
export interface Influence {
  joint: number;
  weight: number;
}

/** Values of all vertices of a part. */
export interface PartValues {
  /** The same in all parts of a mesh for what is one. */
  name: string;
  components: number;
  data: Float64Array;
  semantic: Semantic;
  /** What components are that a part has fewer of than others. */
  filler: 0 | 1;
}

/** The influences on vertices, of pairs that may repeat or weigh nothing. */
export function influencesOf(count: number, pairs: (vertex: number) => Iterable<Influence>): Influence[][] {
  return Array.from({ length: count }, (_, vertex) => {
    const sums = new Map<number, number>();
    for (const { joint, weight } of pairs(vertex)) {
      if (weight > 0 && weight < Infinity) sums.set(joint, (sums.get(joint) ?? 0) + weight);
    }
    return [...sums].map(([joint, weight]) => ({ joint, weight })).sort((a, b) => a.joint - b.joint);
  });
}

/** Refuses positions that are nowhere. */
export function checkFinite(positions: Float64Array, name: string): void {
  const at = positions.findIndex(x => !Number.isFinite(x));
  if (at < 0) return;
  const place = `${name}[${Math.floor(at / 3)}]`;
  throw new LimitmeshError('mesh', place, `${place} is at ${positions[at]}, expected finite coordinates`);
}
