/**
 * Adaptive subdivision of meshes to a tolerance with a proven distance.
 *
 * `refine` and its like need `await ready` once; `refineAsync` works in a worker and needs nothing.
 */

import { buffersOf } from './arrays.js';
import { isGiven, oneOf, shown } from './check.js';
import { compiling, started } from './core.js';
import { LimitmeshError } from './error.js';
import { perform, type Done, type Job } from './jobs.js';
import { Caught } from './listen.js';
import { meshOf, tag, trianglesOf } from './mesh.js';
import { controlOf, controlOfFile, faceSizeOf, FILE_OPTIONS, goalsOf, howOf, MEASURE_OPTIONS, named, REFINE_OPTIONS, SURFACE_OPTIONS } from './options.js';
import { Pool, type Wishes } from './pool.js';
import { text as workerText } from './generated/worker-text.js';
import type {
  Distance, FileOptions, Format, Limits, MeasureOptions, MeshLike, Numbers, Options, Refined, RefinedFile, SurfaceOptions, WorkerOptions,
} from './types.js';

export { LimitmeshError, type ErrorCode } from './error.js';
export { supported } from './module.js';
export type * from './types.js';

/** Resolves when the engine is compiled and started; rejects where it cannot be. */
export const ready: Promise<void> = compiling.then(() => void started());
ready.catch(() => {});

/** Refines a mesh to a goal: within a proven distance of its smooth limit surface. */
export function refine(positions: Numbers, index: Numbers | null, options?: Options | null): Refined {
  const o = named(options, REFINE_OPTIONS, false);
  return now(refineJob(positions, index, o), o);
}

/** Refines a mesh in a worker, so that the page goes on. */
export async function refineAsync(positions: Numbers, index: Numbers | null, options?: (Options & WorkerOptions) | null): Promise<Refined> {
  const o = named(options, REFINE_OPTIONS, true);
  return later(refineJob(positions, index, o), o);
}

/** Where the vertices of a mesh go on its limit surface, exactly, and the limit normals there. */
export function limit(positions: Numbers, index: Numbers | null, options?: SurfaceOptions | null): Limits {
  const o = named(options, SURFACE_OPTIONS, false);
  const mesh = meshOf(positions, index, o);
  return now({ kind: 'limit', mesh, control: controlOf(o), isSingle: isSingle(positions, o) }, o);
}

/** The distance between two meshes, or with `limitOf` between a mesh and a limit surface. */
export function measure(a: MeshLike, b: MeshLike | null, options?: MeasureOptions | null): Distance {
  const o = named(options, MEASURE_OPTIONS, false);
  return now(measureJob(a, b, o), o);
}

/** Measures in a worker. */
export async function measureAsync(a: MeshLike, b: MeshLike | null, options?: (MeasureOptions & WorkerOptions) | null): Promise<Distance> {
  const o = named(options, MEASURE_OPTIONS, true);
  return later(measureJob(a, b, o), o);
}

/** Refines a file with what it carries, in a worker. The module that reads and writes files is loaded by the first call. */
export async function refineFile(
  bytes: Uint8Array, from: Format, to: Format, options?: (FileOptions & WorkerOptions) | null,
): Promise<RefinedFile> {
  const o = named(options, FILE_OPTIONS, true);
  if (!(bytes instanceof Uint8Array)) throw new LimitmeshError('read', 'bytes', `bytes is ${shown(bytes)}, expected a Uint8Array`);
  const control = controlOfFile(o);
  const job: Job & { kind: 'file' } = {
    kind: 'file', bytes: new Uint8Array(bytes), from: String(from) as Format, to: String(to) as Format, control, goals: goalsOf(o, false, control),
  };
  const wishes = wishesOf(o);
  wishes.signal?.throwIfAborted();
  const { run } = await import('./files.js');
  return (await run(job, buffersOf(job), wishes)) as RefinedFile;
}

function refineJob(positions: Numbers, index: Numbers | null, o: Options): Job & { kind: 'refine' } {
  const control = controlOf(o);
  const goals = goalsOf(o, isSingle(positions, o), control);
  return { kind: 'refine', mesh: meshOf(positions, index, o), control, goals };
}

function measureJob(a: MeshLike, b: MeshLike | null, o: MeasureOptions): Job & { kind: 'measure' } {
  if (isGiven(b) === isGiven(o.limitOf)) {
    throw new LimitmeshError('option', 'limitOf', 'the second mesh and limitOf: one of them is measured against');
  }
  const how = howOf(o);
  const surface = meshLike(a, 'a', 3);
  if (isGiven(b)) return { kind: 'measure', surface, reference: meshLike(b, 'b', 3), control: undefined, how };
  const reference = meshLike(o.limitOf, 'limitOf', faceSizeOf(o));
  tag(reference, o);
  return { kind: 'measure', surface, reference, control: controlOf(o), how };
}

function meshLike(mesh: unknown, name: string, faceSize: number) {
  if (typeof mesh !== 'object' || mesh === null) {
    throw new LimitmeshError('mesh', name, `${name} is ${shown(mesh)}, expected { positions, index }`);
  }
  const { positions, index } = mesh as MeshLike;
  return trianglesOf(positions, index, faceSize, `${name}.`);
}

/** Whether positions of a result are of 32 bits: as was asked for, or as those that were given. */
function isSingle(positions: Numbers, o: SurfaceOptions): boolean {
  if (o.precision !== undefined) return oneOf(o.precision, 'precision', ['f32', 'f64']) === 'f32';
  return positions instanceof Float32Array;
}

/** Whoever hears of progress. */
type Heard = Pick<SurfaceOptions, 'onProgress'>;

/** Does a job here. */
function now<J extends Job>(job: J, o: Heard): Done[J['kind']] {
  const caught = new Caught();
  const listener = caught.listener(checkedProgress(o));
  try {
    return started().call(glue => perform(glue, job, listener));
  } catch (thrown) {
    caught.rethrow();
    throw thrown;
  }
}

const pool = new Pool(() => workerText);

/** Has a job done in a worker. */
async function later<J extends Job>(job: J, o: Heard & WorkerOptions): Promise<Done[J['kind']]> {
  const wishes = wishesOf(o);
  wishes.signal?.throwIfAborted();
  const module = await compiling;
  return (await pool.run(module, job, buffersOf(job), wishes)) as Done[J['kind']];
}

function wishesOf(o: Heard & WorkerOptions): Wishes {
  const { signal, worker } = o;
  if (isGiven(signal) && !(signal instanceof AbortSignal)) {
    throw new LimitmeshError('option', 'signal', `signal is ${shown(signal)}, expected an AbortSignal`);
  }
  if (isGiven(worker) && !(typeof Worker === 'function' && worker instanceof Worker)) {
    throw new LimitmeshError('option', 'worker', `worker is ${shown(worker)}, expected a Worker of a browser`);
  }
  return { signal: signal ?? undefined, onProgress: checkedProgress(o) ?? undefined, worker: worker ?? undefined };
}

function checkedProgress(o: Heard): Heard['onProgress'] {
  const told = o.onProgress;
  if (!isGiven(told) || typeof told === 'function') return told;
  throw new LimitmeshError('option', 'onProgress', `onProgress is ${shown(told)}, expected a function`);
}
