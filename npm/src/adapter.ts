/** What adapters have in common: the options that they take, and how they ask for a refinement of parts. */

import { bad, isGiven, number, whole } from './check.js';
import { carriedOf, type Carried } from './carry.js';
import { LimitmeshError } from './error.js';
import { join, NONE, type Joined } from './join.js';
import { REFINE_OPTIONS } from './options.js';
import type { Part } from './parts.js';
import type { Options, Refined } from './types.js';

/** Options of `refine` but for what the geometry itself says. */
export type AdapterOptions = Omit<Options, 'channels' | 'faceSize' | 'precision'>;

const TOLD: readonly string[] = ['channels', 'faceSize', 'precision'];

export const ADAPTER_OPTIONS = REFINE_OPTIONS.filter(name => !TOLD.includes(name));

/** What is told of a refinement beside its triangles. */
export type Report = Pick<Refined, 'error' | 'stop' | 'levels' | 'inverted' | 'creaseAngle' | 'diagnosis'>;

export function reportOf({ error, stop, levels, inverted, creaseAngle, diagnosis }: Refined): Report {
  return { error, stop, levels, inverted, creaseAngle, diagnosis };
}

/** All that `refine` needs. */
export interface Request {
  joined: Joined;
  carried: Carried;
  options: Options;
}

/** The refinement of parts; `groups` has by triangle what belongs together. */
export function requestOf(parts: readonly Part[], groups: Uint32Array, o: AdapterOptions): Request {
  const joined = join(parts, weldOf(o.weld));
  const carried = carriedOf(joined, groups);
  const options: Options = { ...o, channels: carried.channels, weld: null };
  // A flat region has triangles across the faces that values belong to.
  if (carried.channels.length > 0 && o.flatRegions === true) options.flatRegions = false;
  if (carried.channels.length > 0 && o.flatRegions === undefined) options.flatRegions = false;
  return { joined, carried, options };
}

/** Vertices are welded here, not by the engine, as they may be moved apart. */
function weldOf(weld: AdapterOptions['weld']): number | null {
  if (!isGiven(weld)) return weld === null ? null : 0;
  return number(weld, 'weld', 'a distance of at least 0, or null', x => x >= 0 && x < Infinity);
}

/** Sharp edges and vertices, given by the vertices of the one part that there is, `count` of them. */
export function onJoined(o: AdapterOptions, { vertexOf }: Joined, count: number): Pick<AdapterOptions, 'creases' | 'corners'> {
  const [own] = vertexOf;
  const vertex = (value: unknown, place: string) => {
    const v = own![whole(value, place, 0, count - 1)]!;
    if (v === NONE) throw new LimitmeshError('option', place, `${place} names vertex ${String(value)}, which is in no triangle`);
    return v;
  };
  const found: Pick<AdapterOptions, 'creases' | 'corners'> = {};
  if (Array.isArray(o.creases)) {
    found.creases = o.creases.map((row, i) => {
      if (!Array.isArray(row)) throw bad(`creases[${i}]`, row, 'an edge such as [0, 1]');
      return [vertex(row[0], `creases[${i}]`), vertex(row[1], `creases[${i}]`), ...row.slice(2)] as [number, number];
    });
  }
  if (Array.isArray(o.corners)) {
    found.corners = o.corners.map((row, i) => {
      const place = `corners[${i}]`;
      return Array.isArray(row) ? [vertex(row[0], place), row[1] as number] : vertex(row, place);
    });
  }
  return found;
}
