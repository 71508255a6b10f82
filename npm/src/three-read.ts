/** Out of a geometry of three.js: its triangles with all that they carry, and which of them its groups draw. */

import type { BufferAttribute, BufferGeometry, GLBufferAttribute, InterleavedBufferAttribute } from 'three';
import { shown } from './check.js';
import { LimitmeshError } from './error.js';
import { checkFinite, influencesOf, type Influence, type Part, type PartValues } from './parts.js';
import type { Semantic } from './types.js';

export type Attribute = BufferAttribute | InterleavedBufferAttribute;

/** A geometry as a part, and what is known of its triangles. */
export interface Read {
  part: Part;
  /** Attributes with their values, and those of morph targets. */
  carried: CarriedAttribute[];
  /** By triangle the stretch that it is in, between places where groups begin or end. */
  stretches: Uint32Array;
  groups: Group[];
  /** By triangle, which way its texture lies, where tangents are to be found anew. */
  hands: Int8Array | null;
}

/** An attribute, or what a morph target adds to it; by its own name in the part. */
export interface CarriedAttribute {
  key: string;
  name: string;
  /** -1 for the attribute itself. */
  target: number;
  attribute: Attribute;
}

/** A group as stretches of triangles. */
export interface Group {
  first: number;
  end: number;
  materialIndex: number | undefined;
}

/** What follows from the surface, and what moves it. */
const NOT_CARRIED = ['position', 'normal', 'tangent', 'skinIndex', 'skinWeight'];

const LINES = ['EdgesGeometry', 'WireframeGeometry', 'LineGeometry', 'LineSegmentsGeometry'];

export function readGeometry(geometry: BufferGeometry): Read {
  checkKind(geometry);
  const position = positionOf(geometry);
  const range = rangeOf(geometry, position);
  const corners = cornersOf(geometry, range, position.count);
  const carried = carriedAttributes(geometry, position.count);
  const part: Part = {
    positions: numbersOf(position, 'attributes.position', 3),
    corners,
    displacements: displacementsOf(geometry, position),
    influences: skinOf(geometry),
    values: carried.map(own => valuesOf(own, geometry)),
  };
  checkFinite(part.positions, 'attributes.position');
  return { part, carried, ...stretchesOf(geometry, range), hands: handsOf(geometry, corners) };
}

function fault(place: string, message: string): LimitmeshError {
  return new LimitmeshError('mesh', place, message);
}

function checkKind(geometry: BufferGeometry): void {
  const given = geometry as unknown as Record<string, unknown> | null | undefined;
  if (given?.['isBufferGeometry'] !== true) {
    const isObject = given?.['isObject3D'] === true;
    const what = isObject ? `${String(given['type'])}: it is its geometry that is refined` : `${shown(given)}, expected a BufferGeometry`;
    throw fault('geometry', `geometry is ${what}`);
  }
  if (LINES.includes(geometry.type)) throw fault('geometry', `geometry is of lines (${geometry.type}), which have no surface`);
}

function positionOf(geometry: BufferGeometry): Attribute {
  const found = geometry.attributes['position'];
  if (found === undefined) throw fault('attributes.position', 'geometry has no attribute position');
  if (found.itemSize !== 3) throw fault('attributes.position', `attributes.position has ${found.itemSize} numbers a vertex, expected 3`);
  return checked(found, 'attributes.position', found.count);
}

/** An attribute whose numbers are here, one for each vertex. */
function checked(attribute: Attribute | GLBufferAttribute, place: string, count: number): Attribute {
  if ('isGLBufferAttribute' in attribute) throw fault(place, `${place} is in the memory of the graphics card alone`);
  if (attribute.count < count) throw fault(place, `${place} has ${attribute.count} values, expected ${count}: one a vertex`);
  return attribute;
}

/** Whether values are of instances, not of vertices. */
export function isInstanced(attribute: object): boolean {
  return 'isInstancedBufferAttribute' in attribute || ('data' in attribute && 'isInstancedInterleavedBuffer' in (attribute.data as object));
}

/** Where the geometry's corners begin and end that are drawn. */
interface Range {
  start: number;
  end: number;
}

function rangeOf({ index, drawRange }: BufferGeometry, position: Attribute): Range {
  const all = index?.count ?? position.count;
  const { start, count } = drawRange;
  const end = Math.min(all, start + count);
  const isTold = start > 0 || end < all;
  if (start >= 0 && end > start && (end - start) % 3 === 0) return { start, end };
  const place = isTold ? 'drawRange' : index === null ? 'attributes.position' : 'index';
  throw fault(place, `${place} has ${end - start} corners, expected three a triangle; points and lines have no surface`);
}

function cornersOf({ index }: BufferGeometry, { start, end }: Range, vertices: number): Uint32Array {
  const corners = new Uint32Array(end - start);
  for (let i = start; i < end; i++) {
    const v = index === null ? i : index.getX(i);
    if (!(v < vertices)) throw fault(`index[${i}]`, `index[${i}] names vertex ${v}, expected 0 to ${vertices - 1}`);
    corners[i - start] = v;
  }
  return corners;
}

const GETTERS = ['getX', 'getY', 'getZ', 'getW'] as const;

/** All values of an attribute; integers that stand for fractions are these. */
function numbersOf(attribute: Attribute, place: string, expected?: number): Float64Array {
  const { count, itemSize } = attribute;
  if (expected !== undefined && itemSize !== expected) throw fault(place, `${place} has ${itemSize} numbers a value, expected ${expected}`);
  const numbers = new Float64Array(count * itemSize);
  for (let v = 0; v < count; v++) {
    for (let i = 0; i < itemSize; i++) {
      const getter = GETTERS[i];
      numbers[v * itemSize + i] = getter === undefined ? attribute.getComponent(v, i) : attribute[getter](v);
    }
  }
  return numbers;
}

function targetsOf(geometry: BufferGeometry, name: string): Attribute[] {
  return (geometry.morphAttributes as Record<string, Attribute[] | undefined>)[name] ?? [];
}

/** How each target moves the vertices, from where they are. */
function displacementsOf(geometry: BufferGeometry, position: Attribute): Part['displacements'] {
  return targetsOf(geometry, 'position').map((own, target) => {
    const place = `morphAttributes.position[${target}]`;
    return added(geometry, numbersOf(checked(own, place, position.count), place, 3), position);
  });
}

/** What a target with these numbers adds to an attribute. */
function added(geometry: BufferGeometry, numbers: Float64Array, base: Attribute | undefined): Float64Array {
  if (geometry.morphTargetsRelative || base === undefined) return numbers;
  const own = numbersOf(base, 'attributes', numbers.length / base.count);
  return numbers.map((x, i) => x - own[i]!);
}

function carriedAttributes(geometry: BufferGeometry, count: number): CarriedAttribute[] {
  const found: CarriedAttribute[] = [];
  for (const [name, attribute] of Object.entries(geometry.attributes)) {
    if (NOT_CARRIED.includes(name) || isInstanced(attribute)) continue;
    found.push({ key: name, name, target: -1, attribute: checked(attribute, `attributes.${name}`, count) });
  }
  for (const name of Object.keys(geometry.morphAttributes)) {
    if (NOT_CARRIED.includes(name)) continue;
    targetsOf(geometry, name).forEach((attribute, target) => {
      const key = `morphAttributes.${name}[${target}]`;
      found.push({ key, name, target, attribute: checked(attribute, key, count) });
    });
  }
  return found;
}

function valuesOf({ key, name, target, attribute }: CarriedAttribute, geometry: BufferGeometry): PartValues {
  const numbers = numbersOf(attribute, key);
  const data = target < 0 ? numbers : added(geometry, numbers, geometry.attributes[name] as Attribute | undefined);
  return { name: key, components: attribute.itemSize, data, semantic: semanticOf(name, attribute), filler: 0 };
}

function semanticOf(name: string, attribute: Attribute): Semantic {
  if (/^uv\d*$/.test(name)) return 'texture';
  if (name === 'color') return 'colour';
  return isWhole(attribute) ? 'label' : 'other';
}

/** Whether values are whole numbers, so that nothing lies between them. */
function isWhole(attribute: Attribute): boolean {
  const isFloat = attribute.array instanceof Float32Array || attribute.array instanceof Float64Array;
  return !isFloat && !attribute.normalized && !('isFloat16BufferAttribute' in attribute);
}

function skinOf({ attributes }: BufferGeometry): Influence[][] | null {
  const { skinIndex, skinWeight, position } = attributes;
  if (skinIndex === undefined || skinWeight === undefined) return null;
  const joints = numbersOf(checked(skinIndex, 'attributes.skinIndex', position!.count), 'attributes.skinIndex');
  const weights = numbersOf(checked(skinWeight, 'attributes.skinWeight', position!.count), 'attributes.skinWeight', skinIndex.itemSize);
  const size = skinIndex.itemSize;
  return influencesOf(position!.count, vertex => Array.from({ length: size }, (_, i) => {
    return { joint: joints[vertex * size + i]!, weight: weights[vertex * size + i]! };
  }));
}

/** Triangles by the groups that they are in. A triangle may be in several groups, or in none. */
function stretchesOf(geometry: BufferGeometry, range: Range): { stretches: Uint32Array; groups: Group[] } {
  const within = (corner: number) => (Math.min(Math.max(corner, range.start), range.end) - range.start) / 3;
  const ends = geometry.groups.map((own, i) => {
    const [first, end] = [within(own.start), within(own.start + own.count)];
    if (Number.isInteger(first) && Number.isInteger(end)) return { first, end, materialIndex: own.materialIndex };
    throw fault(`groups[${i}]`, `groups[${i}] begins or ends within a triangle`);
  });
  const cuts = [...new Set([0, ...ends.flatMap(own => [own.first, own.end])])].sort((a, b) => a - b);
  const stretches = new Uint32Array((range.end - range.start) / 3);
  cuts.forEach((cut, stretch) => stretches.fill(stretch, cut));
  const groups = ends.map(own => ({ ...own, first: cuts.indexOf(own.first), end: cuts.indexOf(own.end) }));
  return { stretches, groups };
}

/** Tangents do not lie across the mirror line of a texture. */
function handsOf({ attributes }: BufferGeometry, corners: Uint32Array): Int8Array | null {
  const { tangent, uv } = attributes;
  if (tangent === undefined || uv === undefined || uv.itemSize < 2) return null;
  const places = numbersOf(uv as Attribute, 'attributes.uv');
  const at = (corner: number, i: number) => places[corners[corner]! * uv.itemSize + i]!;
  return new Int8Array(corners.length / 3).map((_, face) => {
    const [a, b, c] = [3 * face, 3 * face + 1, 3 * face + 2];
    return Math.sign((at(b, 0) - at(a, 0)) * (at(c, 1) - at(a, 1)) - (at(c, 0) - at(a, 0)) * (at(b, 1) - at(a, 1)));
  });
}
