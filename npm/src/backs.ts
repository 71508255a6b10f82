/**
 * Front and back of a sheet where both are triangles, such as those of leaves and cards: each is a sheet of its own. A triangle is a back if an
 * earlier one has its vertices and runs the other way around them.
 */

import type { Part } from './parts.js';

/** By part and vertex, a number for vertices that stand and move together. */
export type Kinds = Uint32Array[];

/** Parts whose backs have vertices of their own, with kinds of their own. */
export function withBacks(parts: readonly Part[], kinds: Kinds): { parts: readonly Part[]; kinds: Kinds } {
  const backs = backsOf(parts, kinds);
  if (backs.every(own => own.size === 0)) return { parts, kinds };
  const most = kinds.reduce((most, own) => own.reduce((most, kind) => Math.max(most, kind), most), 0);
  const split = parts.map((part, at) => (backs[at]!.size === 0 ? { part, sources: [] } : splitPart(part, backs[at]!)));
  return {
    parts: split.map(own => own.part),
    kinds: split.map(({ sources }, at) => Uint32Array.from([...kinds[at]!, ...sources.map(v => kinds[at]![v]! + most + 1)])),
  };
}

/** By part, the triangles that are backs. */
function backsOf(parts: readonly Part[], kinds: Kinds): Set<number>[] {
  const fronts = new Map<string, boolean>();
  return parts.map(({ corners }, part) => {
    const backs = new Set<number>();
    for (let t = 0; t < corners.length / 3; t++) {
      const [a, b, c] = [0, 1, 2].map(i => kinds[part]![corners[3 * t + i]!]!) as [number, number, number];
      const sorted = [a, b, c].sort((x, y) => x - y);
      const isUp = sorted[1] === [b, c, a][[a, b, c].indexOf(sorted[0]!)];
      const key = sorted.join(' ');
      if (!fronts.has(key)) fronts.set(key, isUp);
      else if (fronts.get(key) !== isUp) backs.add(t);
    }
    return backs;
  });
}

/** A part with copies of the vertices that some triangles have, for these, and what they are copies of. */
function splitPart(part: Part, triangles: Set<number>): { part: Part; sources: number[] } {
  const count = part.positions.length / 3;
  const sources: number[] = [];
  const copies = new Map<number, number>();
  const corners = part.corners.map((v, corner) => {
    if (!triangles.has(Math.floor(corner / 3))) return v;
    if (!copies.has(v)) copies.set(v, count + sources.push(v) - 1);
    return copies.get(v)!;
  });
  const repeated = (numbers: Float64Array, size: number) => {
    const all = new Float64Array(numbers.length + size * sources.length);
    all.set(numbers);
    sources.forEach((v, i) => all.set(numbers.subarray(v * size, (v + 1) * size), numbers.length + i * size));
    return all;
  };
  const split: Part = {
    positions: repeated(part.positions, 3),
    corners,
    displacements: part.displacements.map(own => own && repeated(own, 3)),
    influences: part.influences && [...part.influences, ...sources.map(v => part.influences![v]!)],
    values: part.values.map(own => ({ ...own, data: repeated(own.data, own.components) })),
  };
  return { part: split, sources };
}
