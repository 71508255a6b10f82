/**
 * The parts of a mesh as one: vertices that are one become one, and those that move apart stay apart.
 *
 * Within a part vertices are one if position, displacements of all morph targets, and joints with their weights are the same, perhaps within
 * a distance. Two parts are joined along edges that are open in both and run oppositely, as a solid of several materials has them; where they
 * merely touch they are not.
 */

import { withBacks, type Kinds } from './backs.js';
import { clusters, equals, type Point } from './near.js';
import type { Part } from './parts.js';

/** All parts as one mesh. */
export interface Joined {
  /** As they were given, but that backs have vertices of their own. */
  parts: readonly Part[];
  positions: Float64Array;
  /** The triangles of one part after those of another. */
  index: Uint32Array;
  /** By part and its vertex, the vertex of this mesh; `NONE` for those in no triangle. */
  vertexOf: Uint32Array[];
  /** By vertex, a part's vertex that it is. */
  origins: Place[];
  /** By part, its first triangle; and at last how many there are. */
  firstFace: number[];
}

/** A vertex of a part. */
export interface Place {
  part: number;
  vertex: number;
}

export const NONE = 0xffff_ffff;

/** Joins parts, where numbers within a distance are the same; without one indices alone connect triangles. */
export function join(given: readonly Part[], distance: number | null): Joined {
  const { parts, kinds } = withBacks(given, distance === null ? eachItsOwn(given) : kindsOf(given, distance));
  const names = parts.map((part, i) => namesOf(part, kinds[i]!));
  const sets = new Sets();
  const first = names.map(own => sets.add(own.vertices.length));
  if (distance !== null && parts.length > 1) {
    for (const [a, b] of sharedEnds(parts, names, kinds)) sets.unite(first[a.part]! + a.vertex, first[b.part]! + b.vertex);
  }
  const numbers = new Map<number, number>();
  const origins: Place[] = [];
  const numberOf = (part: number, name: number): number => {
    const root = sets.root(first[part]! + name);
    if (!numbers.has(root)) {
      numbers.set(root, origins.length);
      origins.push({ part, vertex: names[part]!.vertices[name]! });
    }
    return numbers.get(root)!;
  };
  // In the order in which triangles come to them.
  names.forEach((own, part) => own.vertices.forEach((_, name) => void numberOf(part, name)));
  const vertexOf = names.map(({ ofVertex }, part) => ofVertex.map(name => (name === NONE ? NONE : numberOf(part, name))));
  return { parts, vertexOf, origins, positions: positionsAt(parts, origins), ...trianglesOf(parts, vertexOf) };
}

function positionsAt(parts: readonly Part[], origins: Place[]): Float64Array {
  const positions = new Float64Array(3 * origins.length);
  origins.forEach(({ part, vertex }, v) => positions.set(parts[part]!.positions.subarray(3 * vertex, 3 * vertex + 3), 3 * v));
  return positions;
}

function trianglesOf(parts: readonly Part[], vertexOf: Uint32Array[]): { index: Uint32Array; firstFace: number[] } {
  const firstFace = [0];
  for (const { corners } of parts) firstFace.push(firstFace.at(-1)! + corners.length / 3);
  const index = new Uint32Array(3 * firstFace.at(-1)!);
  parts.forEach(({ corners }, part) => index.set(corners.map(v => vertexOf[part]![v]!), 3 * firstFace[part]!));
  return { index, firstFace };
}

function eachItsOwn(parts: readonly Part[]): Kinds {
  let next = 0;
  return parts.map(part => new Uint32Array(part.positions.length / 3).map(() => next++));
}

function kindsOf(parts: readonly Part[], distance: number): Kinds {
  const all = parts.flatMap((part, at) => Array.from({ length: part.positions.length / 3 }, (_, vertex) => ({ part: at, vertex })));
  const steps = [clusters(all.length, at => pointOf(parts[all[at]!.part]!.positions, all[at]!.vertex), distance)];
  const targets = Math.max(0, ...parts.map(part => part.displacements.length));
  for (let target = 0; target < targets; target++) {
    steps.push(clusters(all.length, at => pointOf(parts[all[at]!.part]!.displacements[target], all[at]!.vertex), distance));
  }
  if (parts.some(part => part.influences !== null)) {
    const own = (at: number) => parts[all[at]!.part]!.influences?.[all[at]!.vertex] ?? [];
    steps.push(equals(all.length, at => own(at).map(({ joint }) => joint).join()));
    const most = all.reduce((most, _, at) => Math.max(most, own(at).length), 0);
    // What a difference of weights makes of a place is about its share of the diagonal. Three weights at a time are a point.
    const share = distance / diagonalOf(parts) || 0;
    for (let first = 0; first < most; first += 3) {
      const weight = (at: number, i: number) => own(at)[first + i]?.weight ?? 0;
      steps.push(clusters(all.length, at => [weight(at, 0), weight(at, 1), weight(at, 2)], share));
    }
  }
  const kinds = steps.reduce((kinds, own) => equals(all.length, at => `${kinds[at]} ${own[at]}`));
  let first = 0;
  return parts.map(part => kinds.subarray(first, (first += part.positions.length / 3)));
}

/** A vertex that is not moved is moved by 0. */
function pointOf(numbers: Float64Array | null | undefined, v: number): Point {
  return numbers ? [numbers[3 * v]!, numbers[3 * v + 1]!, numbers[3 * v + 2]!] : [0, 0, 0];
}

/** Of the box around all vertices. */
export function diagonalOf(parts: readonly Part[]): number {
  const [low, high] = [[Infinity, Infinity, Infinity], [-Infinity, -Infinity, -Infinity]];
  for (const { positions } of parts) {
    positions.forEach((x, i) => {
      low[i % 3] = Math.min(low[i % 3]!, x);
      high[i % 3] = Math.max(high[i % 3]!, x);
    });
  }
  return Math.hypot(high[0]! - low[0]!, high[1]! - low[1]!, high[2]! - low[2]!);
}

/** The vertices of a part that differ, each with a number as its name. */
interface Names {
  /** A vertex of the part for each. */
  vertices: number[];
  /** The name of each vertex; `NONE` for those in no triangle. */
  ofVertex: Uint32Array;
}

function namesOf(part: Part, kinds: Uint32Array): Names {
  const ofVertex = new Uint32Array(kinds.length).fill(NONE);
  const vertices: number[] = [];
  const known = new Map<number, number>();
  for (const v of part.corners) {
    if (ofVertex[v] !== NONE) continue;
    const kind = kinds[v]!;
    if (!known.has(kind)) {
      known.set(kind, vertices.length);
      vertices.push(v);
    }
    ofVertex[v] = known.get(kind)!;
  }
  return { vertices, ofVertex };
}

/** An edge that is open in a part: its ends by name, from the lower kind to the higher, and whether its triangle runs so. */
interface OpenEdge {
  key: string;
  isUp: boolean;
  ends: [Place, Place];
}

/** Pairs of names at both ends of edges that are open in two parts, run oppositely, and in no third. */
function sharedEnds(parts: readonly Part[], names: Names[], kinds: Kinds): [Place, Place][] {
  const edges = new Map<string, OpenEdge[]>();
  parts.forEach((own, part) => {
    for (const edge of openEdges(own, part, names[part]!, kinds[part]!)) {
      const met = edges.get(edge.key);
      if (met === undefined) edges.set(edge.key, [edge]);
      else met.push(edge);
    }
  });
  const pairs: [Place, Place][] = [];
  for (const [a, b, ...others] of edges.values()) {
    if (b === undefined || others.length > 0 || a!.isUp === b.isUp) continue;
    pairs.push([a!.ends[0], b.ends[0]], [a!.ends[1], b.ends[1]]);
  }
  return pairs;
}

function openEdges({ corners }: Part, part: number, { vertices, ofVertex }: Names, kinds: Uint32Array): OpenEdge[] {
  const uses = new Map<string, number>();
  const all: [number, number][] = [];
  for (let corner = 0; corner < corners.length; corner++) {
    const next = corner % 3 === 2 ? corner - 2 : corner + 1;
    const [a, b] = [ofVertex[corners[corner]!]!, ofVertex[corners[next]!]!];
    if (a === b) continue;
    all.push([a, b]);
    uses.set(named(a, b), (uses.get(named(a, b)) ?? 0) + 1);
  }
  const open = all.filter(([a, b]) => uses.get(named(a, b)) === 1);
  return open.map(([a, b]) => {
    const [from, to] = [kinds[vertices[a]!]!, kinds[vertices[b]!]!];
    const [low, high] = from < to ? [a, b] : [b, a];
    return { key: named(from, to), isUp: from < to, ends: [{ part, vertex: low }, { part, vertex: high }] };
  });
}

function named(a: number, b: number): string {
  return a < b ? `${a} ${b}` : `${b} ${a}`;
}

/** Numbers in sets that grow together. */
class Sets {
  readonly #above: number[] = [];

  /** Adds so many numbers, each a set; gives the first. */
  add(count: number): number {
    const first = this.#above.length;
    for (let i = 0; i < count; i++) this.#above.push(first + i);
    return first;
  }

  root(number: number): number {
    let own = number;
    while (this.#above[own] !== own) own = this.#above[own] = this.#above[this.#above[own]!]!;
    return own;
  }

  unite(a: number, b: number): void {
    const [low, high] = [this.root(a), this.root(b)].sort((x, y) => x - y) as [number, number];
    this.#above[high] = low;
  }
}
