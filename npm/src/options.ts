/** Options, checked and completed for the engine, as the Python package does it. */

import { bad, boolean, degrees, extent, isGiven, known, memory, number, oneOf, whole, type Extent } from './check.js';
import { LimitmeshError } from './error.js';
import type { FileOptions, MeasureOptions, Options, SurfaceOptions } from './types.js';

/** How a control mesh comes of a mesh, complete. */
export interface ControlIn {
  weld: number;
  repair: boolean;
  boundary: string;
  creaseAngle: number | undefined;
  autoCreases: boolean;
  leadsParts: boolean;
  dividesConcaveCorners: boolean;
  interpolate: Extent | undefined;
  /** None for that of the faces. */
  scheme: string | undefined;
  smoothTriangles: boolean;
}

/** Goals and caps, complete. */
export interface GoalsIn {
  tolerance: Extent | undefined;
  triangles: number | undefined;
  angle: number | undefined;
  optimize: boolean;
  balance: boolean;
  flatRegions: boolean;
  maxTriangles: number | undefined;
  maxLevels: number | undefined;
  maxMemory: number;
  isSingle: boolean;
}

/** How a distance is found, complete. */
export interface HowIn {
  certified: boolean;
  samples: number;
  gap: Extent | undefined;
  maxWork: number | undefined;
  levels: number | undefined;
}

export const SURFACE_OPTIONS = [
  'faceSize', 'interpolate', 'creaseAngle', 'creases', 'corners', 'boundary', 'concaveCorners', 'scheme', 'smoothTriangles', 'weld', 'repair',
  'precision', 'onProgress',
] as const satisfies readonly (keyof SurfaceOptions)[];

export const REFINE_OPTIONS = [
  'tolerance', 'triangles', 'angle', 'optimize', 'balance', 'flatRegions', 'channels', 'maxTriangles', 'maxLevels', 'maxMemory',
  ...SURFACE_OPTIONS,
] as const satisfies readonly (keyof Options)[];

export const MEASURE_OPTIONS = [
  'limitOf', 'certified', 'samples', 'gap', 'maxWork', 'levels', ...SURFACE_OPTIONS.filter(name => name !== 'precision'),
] as const;

export const FILE_OPTIONS = REFINE_OPTIONS.filter(name => !['faceSize', 'channels', 'precision', 'corners'].includes(name));

const WORKER_OPTIONS = ['signal', 'worker'] as const;

/** Options as an object; refuses names that there are not. */
export function named<T extends object>(options: T | null | undefined, names: readonly string[], inWorker: boolean): T {
  if (!isGiven(options)) return {} as T;
  if (typeof options !== 'object' || Array.isArray(options)) {
    throw new LimitmeshError('option', 'options', 'options are an object, such as { tolerance: "0.1%" }');
  }
  const ofWorkers = WORKER_OPTIONS.find(name => Object.hasOwn(options, name));
  if (ofWorkers !== undefined && !inWorker) {
    throw new LimitmeshError('option', ofWorkers, `${ofWorkers} is for calls in a worker: refineAsync, measureAsync, refineGeometryAsync`);
  }
  known(options, inWorker ? [...names, ...WORKER_OPTIONS] : names);
  return options;
}

function given<T, U>(value: T | null | undefined, make: (value: T) => U): U | undefined {
  return isGiven(value) ? make(value) : undefined;
}

/** Corners of a face. */
export function faceSizeOf(o: SurfaceOptions): number {
  return o.faceSize === undefined ? 3 : whole(o.faceSize, 'faceSize', 3, 4);
}

/** How the control mesh comes about. */
export function controlOf(o: SurfaceOptions): ControlIn {
  const smoothTriangles = boolean(o.smoothTriangles, 'smoothTriangles', false);
  const needsQuads = smoothTriangles || faceSizeOf(o) === 4;
  const scheme = isGiven(o.scheme)
    ? oneOf(o.scheme, 'scheme', ['loop', 'loop-warren', 'butterfly', 'catmull-clark'])
    : needsQuads ? 'catmull-clark' : 'loop';
  if (smoothTriangles && scheme !== 'catmull-clark') {
    throw bad('smoothTriangles', true, `false with scheme '${scheme}': it is a rule of 'catmull-clark'`);
  }
  const creaseAngle = given(o.creaseAngle, value => degrees(value, 'creaseAngle'));
  const autoCreases = o.creases === 'auto';
  if (autoCreases && creaseAngle !== undefined) {
    throw bad('creaseAngle', creaseAngle, "nothing with creases: 'auto', which finds an angle");
  }
  const boundary = o.boundary === undefined ? 'smooth' : oneOf(o.boundary, 'boundary', ['smooth', 'corners', 'fixed']);
  const usual = autoCreases || creaseAngle !== undefined || boundary !== 'smooth' ? 'divided' : 'as-tagged';
  const concave = given(o.concaveCorners, value => oneOf(value, 'concaveCorners', ['divided', 'as-tagged'])) ?? usual;
  return {
    weld: o.weld === null ? -1 : o.weld === undefined ? 0
      : number(o.weld, 'weld', 'a distance of at least 0, or null', x => x >= 0 && x < Infinity),
    repair: boolean(o.repair, 'repair', true),
    boundary,
    creaseAngle,
    autoCreases: autoCreases && !(o.corners?.length),
    leadsParts: autoCreases && !isGiven(o.interpolate),
    dividesConcaveCorners: concave === 'divided',
    interpolate: interpolateOf(o.interpolate),
    scheme,
    smoothTriangles,
  };
}

function interpolateOf(value: SurfaceOptions['interpolate']): Extent | undefined {
  if (!isGiven(value) || value === false) return undefined;
  return value === true ? { amount: 0, isPart: false } : extent(value, 'interpolate', 'of at least');
}

/** Goals and caps; the tolerance is 0.1 % of the diagonal where there is no goal. */
export function goalsOf(o: Omit<Options, 'creases'>, isSingle: boolean, control: ControlIn): GoalsIn {
  const hasGoal = isGiven(o.tolerance) || isGiven(o.triangles) || isGiven(o.angle);
  const optimize = boolean(o.optimize, 'optimize', false);
  const balance = boolean(o.balance, 'balance', false);
  if (optimize && balance) throw bad('balance', true, 'false with optimize, whose vertices stay on the limit surface');
  if (optimize && isGiven(o.angle)) throw bad('angle', o.angle, 'nothing with optimize, which keeps distances');
  if (optimize && control.scheme === 'catmull-clark') throw bad('optimize', true, "false with scheme 'catmull-clark': it is for triangles");
  return {
    tolerance: given(o.tolerance ?? (hasGoal ? undefined : '0.1%'), value => extent(value, 'tolerance')),
    triangles: given(o.triangles, value => whole(value, 'triangles', 1)),
    angle: given(o.angle, value => degrees(value, 'angle')),
    optimize,
    balance,
    flatRegions: boolean(o.flatRegions, 'flatRegions', true),
    maxTriangles: given(o.maxTriangles, value => whole(value, 'maxTriangles', 1)),
    maxLevels: given(o.maxLevels, value => whole(value, 'maxLevels', 1, 30)),
    maxMemory: memory(o.maxMemory === null ? '3.5GB' : o.maxMemory ?? '1GB', 'maxMemory'),
    isSingle,
  };
}

/** How the control mesh of a file comes about: its faces decide the scheme, and sharp edges are found where it tags none. */
export function controlOfFile(o: FileOptions): ControlIn {
  const { creases, ...rest } = o;
  const usual = isGiven(o.creaseAngle) ? 'none' : 'auto';
  const isFound = oneOf(creases ?? usual, 'creases', ['auto', 'none']) === 'auto';
  const control = controlOf({ ...rest, ...(isFound ? { creases: 'auto' } : {}) });
  return { ...control, scheme: isGiven(o.scheme) ? control.scheme : undefined };
}

/** How a distance is found. */
export function howOf(o: MeasureOptions): HowIn {
  const certified = boolean(o.certified, 'certified', false);
  for (const name of ['gap', 'maxWork'] as const) {
    if (!certified && isGiven(o[name])) throw bad(name, o[name], 'nothing without certified: true');
  }
  return {
    certified,
    samples: whole(o.samples ?? 100_000, 'samples', 1, 1e9),
    gap: given(o.gap, value => extent(value, 'gap', 'of at least')),
    maxWork: given(o.maxWork, value => whole(value, 'maxWork', 0)),
    levels: given(o.levels, value => Math.min(whole(value, 'levels', 1), 12)),
  };
}
