/**
 * What parts carry, into channels of their joined mesh, and out of its refinement into vertices: one for each vertex of the surface, each
 * side of a sharp edge, and each combination of values there.
 */

import { NONE, type Joined } from './join.js';
import { densest, weightsChannel } from './skin.js';
import { turnedFaces } from './turned.js';
import type { Part, PartValues } from './parts.js';
import type { Channel, Refined, RefinedChannel } from './types.js';

/** The channels of a joined mesh, and which of them is what. */
export interface Carried {
  channels: Channel[];
  /** By channel the names of `values`; undefined for others. */
  names: (string | undefined)[];
  /** By target its channel of displacements; -1 where nothing moves. */
  displacements: number[];
  /** The channel of a skin's weights and the joints that they are of. */
  weights: { channel: number; joints: number[] } | null;
  /** By triangle, what belongs together. */
  groups: Uint32Array;
}

/** A part of a refined mesh. */
export interface Grown {
  /** By vertex, that of the refined mesh, and the first corner of it that has this vertex. */
  vertices: Uint32Array;
  corners: Uint32Array;
  normals: Float32Array;
  /** By vertex, -1 where it is of triangles that are turned back, and 1 elsewhere. */
  signs: Int8Array;
  /** Three vertices a triangle. */
  index: Uint32Array;
  /** By triangle, the part's own that it came from. */
  parents: Uint32Array;
}

/** Channels for all that is carried. Triangles of different `groups` stay apart. */
export function carriedOf(joined: Joined, groups: Uint32Array): Carried {
  const { parts } = joined;
  const carried: Carried = { channels: [], names: [], displacements: [], weights: null, groups };
  const add = (channel: Channel, name?: string) => {
    carried.names.push(name);
    return carried.channels.push(channel) - 1;
  };
  for (const name of new Set(parts.flatMap(part => part.values.map(own => own.name)))) add(valuesChannel(name, parts, joined), name);
  const targets = Math.max(0, ...parts.map(part => part.displacements.length));
  for (let target = 0; target < targets; target++) {
    const channel = displacementChannel(target, parts, joined);
    carried.displacements.push(channel === null ? -1 : add(channel));
  }
  const found = weightsChannel(parts, joined);
  if (found !== null) carried.weights = { joints: found.joints, channel: add(found.channel) };
  if (groups.some(group => group !== groups[0])) {
    const kept = Float64Array.from({ length: Math.max(...new Set(groups)) + 1 }, (_, group) => group);
    add({ name: 'groups', data: kept, components: 1, index: groups, domain: 'face', semantic: 'label' });
  }
  return carried;
}

/** Values at corners: corners at one vertex with the same value have one. */
function valuesChannel(name: string, parts: readonly Part[], joined: Joined): Channel {
  const own = parts.map(part => part.values.find(values => values.name === name));
  const { semantic } = own.find(values => values !== undefined)!;
  const components = Math.max(...own.map(values => values?.components ?? 0));
  const data: number[] = [];
  const index = new Uint32Array(joined.index.length);
  const known = new Map<string, number>();
  parts.forEach((part, at) => {
    const rows = new Uint32Array(part.positions.length / 3).fill(NONE);
    part.corners.forEach((v, corner) => {
      if (rows[v] === NONE) {
        const value = valueOf(own[at], components, v);
        const key = `${joined.vertexOf[at]![v]}:${value.join()}`;
        if (!known.has(key)) known.set(key, data.push(...value) / components - 1);
        rows[v] = known.get(key)!;
      }
      index[3 * joined.firstFace[at]! + corner] = rows[v]!;
    });
  });
  return { name, data: Float64Array.from(data), components, index, domain: 'corner', semantic };
}

function valueOf(values: PartValues | undefined, components: number, v: number): number[] {
  const value = new Array<number>(components).fill(values?.filler ?? 0);
  for (let i = 0; i < (values?.components ?? 0); i++) value[i] = values!.data[v * values!.components + i]!;
  return value;
}

/** How a target moves the vertices, if it moves any. */
function displacementChannel(target: number, parts: readonly Part[], joined: Joined): Channel | null {
  const data = new Float64Array(joined.positions.length);
  joined.origins.forEach(({ part, vertex }, v) => {
    const own = parts[part]!.displacements[target];
    if (own) data.set(own.subarray(3 * vertex, 3 * vertex + 3), 3 * v);
  });
  if (data.every(x => x === 0)) return null;
  return { name: `targets[${target}]`, data, components: 3, domain: 'vertex', semantic: 'displacement' };
}

/** The vertices of a refined surface: those on sharp edges stand once for each side. */
export interface Surface {
  /** By face, whether its triangles are to be turned back. */
  turned: Uint8Array;
  /** By corner. */
  vertices: Uint32Array;
  /** By vertex of the surface. */
  normals: Float32Array;
}

export function surfaceOf(joined: Joined, refined: Refined): Surface {
  const { index, normals, sides } = refined;
  const vertices = index.slice();
  const count = normals.length / 3;
  const added: number[] = [];
  const known = new Map<string, number>();
  sides.corners.forEach((corner, at) => {
    const normal = sides.normals.subarray(3 * at, 3 * at + 3);
    const key = `${index[corner]}:${normal.join()}`;
    if (!known.has(key)) known.set(key, count + added.push(...normal) / 3 - 1);
    vertices[corner] = known.get(key)!;
  });
  const all = new Float32Array(normals.length + added.length);
  all.set(normals);
  all.set(added, normals.length);
  return { turned: turnedFaces(joined, refined), vertices, normals: all };
}

/**
 * A part of a refined mesh: the triangles that come from its faces, the first of which is `first`, in the order that they have. Corners are
 * one vertex where the surface has one, channels `decisive` have one value, and `sideOf` gives one number for the faces.
 */
export function grown(
  refined: Refined, surface: Surface, decisive: readonly RefinedChannel[], faces: { first: number; end: number }, sideOf: (face: number) => number,
): Grown {
  const numbering = new Numbering(surface, decisive);
  const index: number[] = [];
  const parents: number[] = [];
  refined.parents.forEach((face, triangle) => {
    if (face < faces.first || face >= faces.end) return;
    parents.push(face - faces.first);
    const isTurned = surface.turned[face] === 1;
    const side = 2 * sideOf(face) + (isTurned ? 1 : 0);
    for (const i of isTurned ? [0, 2, 1] : [0, 1, 2]) index.push(numbering.number(3 * triangle + i, side));
  });
  const corners = Uint32Array.from(numbering.corners);
  const normals = new Float32Array(3 * corners.length);
  const signs = Int8Array.from(corners, corner => (surface.turned[refined.parents[Math.floor(corner / 3)]!] === 1 ? -1 : 1));
  corners.forEach((corner, v) => normals.set(directionAt(surface, corner).map(x => signs[v]! * x), 3 * v));
  const vertices = corners.map(corner => refined.index[corner]!);
  return { vertices, corners, normals, signs, index: Uint32Array.from(index), parents: Uint32Array.from(parents) };
}

/** A unit normal; upwards where there is no direction. */
function directionAt({ vertices, normals }: Surface, corner: number): number[] {
  const at = 3 * vertices[corner]!;
  const [x, y, z] = [normals[at]!, normals[at + 1]!, normals[at + 2]!];
  const length = Math.hypot(x, y, z);
  return length > 0 && length < Infinity ? [x / length, y / length, z / length] : [0, 0, 1];
}

/** Gives numbers to corners: equal ones to those that are one vertex. */
class Numbering {
  readonly #surface: Surface;
  readonly #decisive: readonly RefinedChannel[];
  /** By vertex of the surface the first number that it has, and by number the next of the same vertex. */
  readonly #first: Uint32Array;
  readonly #next: number[] = [];
  readonly #sides: number[] = [];
  /** By number, its first corner. */
  readonly corners: number[] = [];

  constructor(surface: Surface, decisive: readonly RefinedChannel[]) {
    this.#surface = surface;
    this.#decisive = decisive;
    this.#first = new Uint32Array(surface.normals.length / 3).fill(NONE);
  }

  number(corner: number, side: number): number {
    const v = this.#surface.vertices[corner]!;
    for (let own = this.#first[v]!; own !== NONE; own = this.#next[own]!) {
      const other = this.corners[own]!;
      if (this.#sides[own] === side && this.#decisive.every(channel => isSame(channel, corner, other))) return own;
    }
    const number = this.corners.push(corner) - 1;
    this.#sides.push(side);
    this.#next.push(this.#first[v]!);
    this.#first[v] = number;
    return number;
  }
}

/** Whether two corners have the same value, as 32-bit numbers. */
function isSame({ index, data, components }: RefinedChannel, a: number, b: number): boolean {
  if (index[a] === index[b]) return true;
  for (let i = 0; i < components; i++) {
    if (Math.fround(data[index[a]! * components + i]!) !== Math.fround(data[index[b]! * components + i]!)) return false;
  }
  return true;
}

/** The values of a channel at some corners. */
export function valuesAt(corners: Uint32Array, { index, data, components }: RefinedChannel): Float64Array {
  const values = new Float64Array(corners.length * components);
  corners.forEach((corner, v) => {
    for (let i = 0; i < components; i++) values[v * components + i] = data[index[corner]! * components + i]!;
  });
  return values;
}

/** What is known by vertex of the surface, such as changes of normals, by vertex of a part. */
export function turnedBack({ corners, signs }: Grown, surface: Surface, numbers: ArrayLike<number>): Float32Array {
  const found = new Float32Array(3 * corners.length);
  corners.forEach((corner, v) => {
    for (let i = 0; i < 3; i++) found[3 * v + i] = signs[v]! * numbers[3 * surface.vertices[corner]! + i]!;
  });
  return found;
}

/** Four joints a vertex, with weights that add up to 1. */
export function skinAt(corners: Uint32Array, { weights }: Carried, refined: Refined): { joints: Uint32Array; weights: Float64Array } | null {
  return weights === null ? null : densest(corners, refined.channels[weights.channel]!, weights.joints);
}
