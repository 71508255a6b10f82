/**
 * Refines the meshes of a document of glTF Transform, as the program does it with glTF files.
 *
 * Lengths are those of the scene: a mesh is refined at the size of its largest appearance, and per cent are of the diagonal of all that the
 * scene shows. The primitives of a mesh stay without gaps where they share edges. Points and lines stay as they are.
 */

import type { Document, Mesh, Transform } from '@gltf-transform/core';
import { ADAPTER_OPTIONS, requestOf, type AdapterOptions } from './adapter.js';
import { extent, isGiven, number, oneOf } from './check.js';
import { LimitmeshError } from './error.js';
import { readMesh, type ReadPrimitive } from './gltf-read.js';
import { Placements } from './gltf-scene.js';
import { writeMesh } from './gltf-write.js';
import { refineAsync } from './index.js';
import { named } from './options.js';
import type { Refined, WorkerOptions } from './types.js';

/** Options of `refine` but for those that the document answers, and those that name vertices. */
export type LimitmeshOptions = Omit<AdapterOptions, 'creases' | 'corners'> & {
  /** `'auto'` finds the sharp edges of parts. Default: `'none'`. */
  creases?: 'auto' | 'none' | null;
} & WorkerOptions;

const OPTIONS = ADAPTER_OPTIONS.filter(name => name !== 'corners');

/** A transform that brings each mesh of a document within a tolerance of its smooth surface. `triangles` is for each mesh. */
export function limitmesh(options?: LimitmeshOptions | null): Transform {
  const { creases, ...rest } = named(options, OPTIONS, true);
  const isFound = oneOf(creases ?? 'none', 'creases', ['auto', 'none']) === 'auto';
  const o: AdapterOptions & WorkerOptions = { ...rest, ...(isFound ? { creases: 'auto' } : {}) };
  return async function limitmesh(document: Document): Promise<void> {
    const meshes = new Map(document.getRoot().listMeshes().map((mesh, i) => [mesh, readMesh(mesh, nameOf(mesh, i))]));
    const placements = new Placements(document);
    const told = inScene(o, placements.diagonal(meshes));
    for (const [i, [mesh, primitives]] of [...meshes].entries()) {
      if (primitives.length === 0) continue;
      const line = await refineMesh(document, primitives, placements.stretch(mesh), told);
      document.getLogger().info(`limitmesh: ${nameOf(mesh, i)}: ${line}`);
    }
  };
}

function nameOf(mesh: Mesh, i: number): string {
  return mesh.getName() === '' ? `meshes[${i}]` : `meshes[${i}] '${mesh.getName()}'`;
}

/** Options whose per cent are lengths in the scene. */
function inScene(o: AdapterOptions & WorkerOptions, diagonal: number): AdapterOptions & WorkerOptions {
  const length = (value: unknown, place: string, least?: 'of at least') => {
    const { amount, isPart } = extent(value, place, least);
    return isPart ? amount * diagonal : amount;
  };
  const hasGoal = isGiven(o.tolerance) || isGiven(o.triangles) || isGiven(o.angle);
  const found = { ...o };
  // Where nothing is shown each mesh has its own diagonal.
  if (diagonal === 0) return found;
  if (isGiven(o.tolerance) || !hasGoal) found.tolerance = length(o.tolerance ?? '0.1%', 'tolerance');
  if (isGiven(o.interpolate) && typeof o.interpolate !== 'boolean') found.interpolate = length(o.interpolate, 'interpolate', 'of at least');
  return found;
}

/** Refines a mesh at a scale, and puts it back; gives what is said of it. */
async function refineMesh(document: Document, primitives: ReadPrimitive[], scale: number, o: AdapterOptions & WorkerOptions): Promise<string> {
  const parts = primitives.map(own => own.part);
  const groups = Uint32Array.from(parts.flatMap((part, i) => new Array<number>(part.corners.length / 3).fill(i)));
  const weld = isGiven(o.weld) ? number(o.weld, 'weld', 'a distance of at least 0, or null', x => x >= 0 && x < Infinity) / scale : o.weld;
  const { joined, carried, options } = requestOf(parts, groups, { ...o, ...(weld === undefined ? {} : { weld }) });
  const positions = joined.positions.map(x => x * scale);
  try {
    const refined = await refineAsync(positions, joined.index, { ...options, precision: 'f64' });
    writeMesh(document, { primitives, joined, carried, refined, scale });
    return told(refined, joined.index.length / 3, scale);
  } catch (thrown) {
    if (thrown instanceof LimitmeshError && thrown.message.startsWith(NO_FACES)) return `kept as it is: ${thrown.message}`;
    throw thrown;
  }
}

/** What the engine says of a mesh whose triangles have no area. */
const NO_FACES = 'no face is left';

function told({ positions, index, error, stop, diagnosis }: Refined, before: number, scale: number): string {
  const count = (triangles: number) => triangles.toLocaleString('en');
  const within = `${(error.upper + roundingOf(positions, scale)).toPrecision(3)}${error.certified ? '' : ' (estimated)'}`;
  const ended = stop === 'met' || stop === 'triangles' ? '' : `; ended by ${stop}`;
  const repairs = diagnosis.clean ? '' : `; ${diagnosis.repairs.join('; ')}`;
  return `${count(before)} → ${count(index.length / 3)} triangles within ${within} of the surface${ended}${repairs}`;
}

/** The farthest that a vertex moves in the scene as its numbers become those of 32 bits. */
function roundingOf(positions: ArrayLike<number>, scale: number): number {
  let most = 0;
  for (let i = 0; i < positions.length; i++) {
    const own = positions[i]! / scale;
    most = Math.max(most, scale * Math.abs(own - Math.fround(own)));
  }
  return Math.sqrt(3) * most;
}
