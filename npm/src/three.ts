/**
 * Refines geometries of three.js.
 *
 * Vertices at one place that move together are one, whatever their attributes; these become seams. Normals of a result are limit normals.
 */

import type { BufferGeometry } from 'three';
import { ADAPTER_OPTIONS, onJoined, reportOf, requestOf, type AdapterOptions, type Report, type Request } from './adapter.js';
import { refine, refineAsync } from './index.js';
import { diagonalOf } from './join.js';
import { named } from './options.js';
import { readGeometry, type Read } from './three-read.js';
import { writeGeometry } from './three-write.js';
import type { Options, Refined, WorkerOptions } from './types.js';

/** Options of `refine` but for those that the geometry answers. By default `weld` is a millionth of the diagonal here. */
export type GeometryOptions = AdapterOptions;

/** What `userData.limitmesh` of a refined geometry tells. */
export type GeometryReport = Report;

/** A geometry within a tolerance of the smooth surface of another one. Needs `await ready` once. */
export function refineGeometry(geometry: BufferGeometry, options?: GeometryOptions | null): BufferGeometry {
  const prepared = prepare(geometry, named(options, ADAPTER_OPTIONS, false));
  return written(geometry, prepared, refine(...prepared.mesh, prepared.options));
}

/** The same in a worker, so that the page goes on. */
export async function refineGeometryAsync(geometry: BufferGeometry, options?: (GeometryOptions & WorkerOptions) | null): Promise<BufferGeometry> {
  const prepared = prepare(geometry, named(options, ADAPTER_OPTIONS, true));
  return written(geometry, prepared, await refineAsync(...prepared.mesh, prepared.options));
}

/** The part of the diagonal within which vertices become one unless `weld` says something else. */
const ROUNDING = 1e-6;

interface Prepared {
  read: Read;
  request: Request;
  mesh: [positions: Float64Array, index: Uint32Array];
  options: Options;
}

function prepare(geometry: BufferGeometry, o: GeometryOptions): Prepared {
  const read = readGeometry(geometry);
  // Spheres, tubes and knots of three.js itself do not close exactly.
  const weld = o.weld === undefined ? ROUNDING * diagonalOf([read.part]) : o.weld;
  const request = requestOf([read.part], read.stretches, { ...o, weld });
  const { positions, index } = request.joined;
  const options: Options = { ...request.options, ...onJoined(o, request.joined, read.part.positions.length / 3), precision: 'f32' };
  return { read, request, mesh: [positions, index], options };
}

function written(from: BufferGeometry, { read, request }: Prepared, refined: Refined): BufferGeometry {
  const geometry = writeGeometry(from, read, request, refined);
  geometry.userData = { ...from.userData, limitmesh: reportOf(refined) satisfies GeometryReport };
  return geometry;
}
