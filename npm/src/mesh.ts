/** Meshes from outside, checked and completed for the engine. */

import { floats, wholes } from './arrays.js';
import { bad, isGiven, known, number, oneOf, shown, whole } from './check.js';
import { LimitmeshError } from './error.js';
import { faceSizeOf } from './options.js';
import type { Channel, Domain, Interpolation, Numbers, Options, Semantic, SurfaceOptions } from './types.js';

/** A mesh, complete. */
export interface MeshIn {
  positions: Float64Array;
  corners: Uint32Array;
  faceSize: number;
  creaseEdges: Uint32Array;
  creaseSharpness: Float64Array;
  cornerVertices: Uint32Array;
  cornerSharpness: Float64Array;
  channels: ChannelIn[];
}

interface ChannelIn {
  name: string;
  semantic: Semantic;
  domain: Domain;
  interpolation: Interpolation;
  components: number;
  data: Float64Array;
  index: Uint32Array;
}

/** What can be given to `refine`. */
export function meshOf(positions: Numbers, index: Numbers | null | undefined, o: Options): MeshIn {
  const mesh = trianglesOf(positions, index, faceSizeOf(o));
  tag(mesh, o);
  if (isGiven(o.channels)) {
    if (!Array.isArray(o.channels)) throw bad('channels', o.channels, 'an array of channels');
    mesh.channels = o.channels.map((own, row) => channelOf(own, row, mesh));
  }
  return mesh;
}

/** A mesh without tags and channels. Without an index each three positions are a triangle. */
export function trianglesOf(positions: unknown, index: unknown, faceSize: number, prefix = ''): MeshIn {
  const points = floats(positions, `${prefix}positions`, 'mesh');
  if (!isGiven(index) && points.length % (3 * faceSize) !== 0) {
    const place = `${prefix}positions`;
    throw new LimitmeshError('mesh', place, `${place} has ${points.length} numbers, expected ${3 * faceSize} a face without an index`);
  }
  const corners = isGiven(index)
    ? wholes(index, `${prefix}index`, 'mesh')
    : Uint32Array.from({ length: points.length / 3 }, (_, corner) => corner);
  return {
    positions: points,
    corners,
    faceSize,
    creaseEdges: new Uint32Array(),
    creaseSharpness: new Float64Array(),
    cornerVertices: new Uint32Array(),
    cornerSharpness: new Float64Array(),
    channels: [],
  };
}

/** Puts sharp edges and vertices on a mesh. */
export function tag(mesh: MeshIn, o: SurfaceOptions): void {
  const count = mesh.positions.length / 3;
  if (isGiven(o.creases) && o.creases !== 'auto') {
    const rows = rowsOf(o.creases, 'creases', "edges such as [0, 1], or 'auto'", 2, 3);
    mesh.creaseEdges = Uint32Array.from(rows.flatMap((row, i) => [0, 1].map(end => vertexOf(row[end], `creases[${i}]`, count))));
    mesh.creaseSharpness = Float64Array.from(rows, (row, i) => sharpnessOf(row[2], `creases[${i}]`));
  }
  if (isGiven(o.corners)) {
    const lists = Array.isArray(o.corners) ? o.corners.map(own => (typeof own === 'number' ? [own] : own)) : o.corners;
    const rows = rowsOf(lists, 'corners', 'vertices, or pairs of a vertex and its sharpness', 1, 2);
    mesh.cornerVertices = Uint32Array.from(rows, (row, i) => vertexOf(row[0], `corners[${i}]`, count));
    mesh.cornerSharpness = Float64Array.from(rows, (row, i) => sharpnessOf(row[1], `corners[${i}]`));
  }
}

function rowsOf(value: unknown, place: string, expected: string, least: number, most: number): ArrayLike<unknown>[] {
  if (!Array.isArray(value)) throw bad(place, value, expected);
  return value.map((row, i) => {
    const isRow = (Array.isArray(row) || ArrayBuffer.isView(row)) && !(row instanceof DataView);
    const list = row as ArrayLike<unknown>;
    if (!isRow || list.length < least || list.length > most) throw bad(`${place}[${i}]`, row, expected);
    return list;
  });
}

function vertexOf(value: unknown, place: string, count: number): number {
  return whole(value, place, 0, Math.max(count - 1, 0));
}

function sharpnessOf(value: unknown, place: string): number {
  return value === undefined ? Infinity : number(value, place, 'a sharpness of at least 0', x => x >= 0);
}

const USUAL: Record<Semantic, Interpolation> = {
  'texture': 'smooth-boundaries',
  'colour': 'linear',
  'skin-weight': 'smooth-none',
  'displacement': 'smooth-none',
  'label': 'nearest',
  'other': 'linear',
};

const INTERPOLATIONS: readonly Interpolation[] = [
  'linear', 'nearest', 'smooth-none', 'smooth-corners-only', 'smooth-corners-plus1', 'smooth-corners-plus2', 'smooth-boundaries',
];

const FIELDS: readonly (keyof Channel)[] = ['name', 'data', 'components', 'index', 'domain', 'semantic', 'interpolation'];

function channelOf(channel: Channel, row: number, mesh: MeshIn): ChannelIn {
  const at = `channels[${row}]`;
  if (typeof channel !== 'object' || channel === null) throw bad(at, channel, '{ name, data, components }');
  known(channel, FIELDS);
  const name = String(channel.name ?? row);
  const components = whole(channel.components, `${at}.components`, 1, 65_535);
  const data = floats(channel.data, `${at}.data`, 'option');
  const count = data.length / components;
  if (!Number.isInteger(count)) throw bad(`${at}.data`, `${data.length} numbers`, `${components} a value`);
  const domain = oneOf(channel.domain ?? 'vertex', `${at}.domain`, ['vertex', 'corner', 'face']);
  const semantic = oneOf(channel.semantic ?? 'other', `${at}.semantic`, Object.keys(USUAL) as Semantic[]);
  const index = isGiven(channel.index)
    ? wholes(channel.index, `${at}.index`, 'option')
    : Uint32Array.from({ length: count }, (_, element) => element);
  const corners = mesh.corners.length;
  const expected = { vertex: mesh.positions.length / 3, corner: corners, face: corners / mesh.faceSize }[domain];
  if (index.length !== expected) {
    const [what, place] = isGiven(channel.index) ? ['rows', `${at}.index`] : ['values', `${at}.data`];
    const message = `${place} has ${index.length} ${what}, expected one for each of ${expected} elements of the domain ${shown(domain)}`;
    throw new LimitmeshError('option', place, message);
  }
  const interpolation = oneOf(channel.interpolation ?? USUAL[semantic], `${at}.interpolation`, INTERPOLATIONS);
  return { name, semantic, domain, interpolation, components, data, index };
}
