/** A refined geometry of three.js: the attributes of the one that was given, in their types, over the refined triangles. */

import { BufferAttribute, BufferGeometry, Float16BufferAttribute, InstancedBufferGeometry } from 'three';
import { grown, skinAt, surfaceOf, turnedBack, valuesAt, type Carried, type Grown, type Surface } from './carry.js';
import type { Request } from './adapter.js';
import { addedNormals } from './moved-normals.js';
import { isInstanced, type Attribute, type Group, type Read } from './three-read.js';
import type { Refined } from './types.js';

export function writeGeometry(from: BufferGeometry, read: Read, request: Request, refined: Refined): BufferGeometry {
  const { carried } = request;
  const geometry = emptyLike(from);
  const surface = surfaceOf(request.joined, refined);
  const decisive = refined.channels.filter((_, i) => carried.names[i] !== undefined);
  const all = { first: 0, end: read.stretches.length };
  const own = grown(refined, surface, decisive, all, face => read.hands?.[face] ?? 0);
  const { vertices, normals } = own;
  writeTriangles(geometry, read, own);
  geometry.setAttribute('position', plain(rows(vertices, refined.positions), 3));
  geometry.setAttribute('normal', plain(normals, 3));
  writeValues(geometry, read, carried, refined, own);
  writeSkin(geometry, from, carried, refined, own);
  writeMorphs(geometry, from, carried, refined, { surface, own });
  if (read.hands !== null) geometry.computeTangents();
  return geometry;
}

/** A geometry without vertices; what it has for each instance stays. */
function emptyLike(from: BufferGeometry): BufferGeometry {
  const geometry = 'isInstancedBufferGeometry' in from ? new InstancedBufferGeometry() : new BufferGeometry();
  if (geometry instanceof InstancedBufferGeometry) {
    geometry.instanceCount = (from as InstancedBufferGeometry).instanceCount;
    for (const [name, attribute] of Object.entries(from.attributes)) {
      if (isInstanced(attribute)) geometry.setAttribute(name, attribute);
    }
  }
  geometry.name = from.name;
  geometry.morphTargetsRelative = from.morphTargetsRelative;
  return geometry;
}

function plain(numbers: ArrayLike<number>, itemSize: number): BufferAttribute {
  return new BufferAttribute(numbers instanceof Float32Array ? numbers : new Float32Array(numbers), itemSize);
}

/** Three numbers for each vertex. */
function rows(vertices: Uint32Array, numbers: ArrayLike<number>): Float32Array {
  const found = new Float32Array(3 * vertices.length);
  vertices.forEach((from, v) => {
    for (let i = 0; i < 3; i++) found[3 * v + i] = numbers[3 * from + i]!;
  });
  return found;
}

/** Triangles in the order of the stretches that they are in, so that each group draws one range of them. */
function writeTriangles(geometry: BufferGeometry, { stretches, groups }: Read, own: Grown): void {
  const counts = new Array<number>(Math.max(0, ...groups.map(group => group.end), stretches.at(-1)! + 1)).fill(0);
  for (const parent of own.parents) counts[stretches[parent]!]!++;
  const first = counts.map(() => 0);
  counts.forEach((count, stretch) => (first[stretch + 1] = first[stretch]! + count));
  const next = first.slice();
  const sorted = own.vertices.length > 65_535 ? new Uint32Array(own.index.length) : new Uint16Array(own.index.length);
  own.parents.forEach((parent, triangle) => {
    const place = next[stretches[parent]!]!++;
    sorted.set(own.index.subarray(3 * triangle, 3 * triangle + 3), 3 * place);
  });
  geometry.setIndex(new BufferAttribute(sorted, 1));
  const add = (group: Group) => geometry.addGroup(3 * first[group.first]!, 3 * (first[group.end]! - first[group.first]!), group.materialIndex);
  groups.forEach(add);
}

function writeValues(geometry: BufferGeometry, read: Read, carried: Carried, refined: Refined, own: Grown): void {
  for (const { key, name, target, attribute } of read.carried) {
    const values = valuesAt(own.corners, refined.channels[carried.names.indexOf(key)]!);
    if (target < 0) {
      geometry.setAttribute(name, typed(values, attribute));
      continue;
    }
    const base = geometry.attributes[name];
    const isAdded = geometry.morphTargetsRelative || base === undefined;
    const all = isAdded ? values : values.map((x, i) => x + component(base as Attribute, i));
    targets(geometry, name)[target] = typed(all, attribute);
  }
}

function targets(geometry: BufferGeometry, name: string): Attribute[] {
  return ((geometry.morphAttributes as Record<string, Attribute[]>)[name] ??= []);
}

function component(attribute: Attribute, i: number): number {
  return attribute.getComponent(Math.floor(i / attribute.itemSize), i % attribute.itemSize);
}

/** An attribute with numbers of the type that another one has. */
function typed(values: ArrayLike<number>, like: Attribute): BufferAttribute {
  const { itemSize, normalized, array } = like;
  const room = new (array.constructor as Float32ArrayConstructor)(values.length);
  const isHalf = 'isFloat16BufferAttribute' in like;
  const attribute = isHalf
    ? new Float16BufferAttribute(room as unknown as Uint16Array, itemSize, normalized)
    : new BufferAttribute(room, itemSize, normalized);
  if (isHalf) fillHalf(attribute, values);
  else attribute.array.set(Array.from(values, x => stored(x, like)));
  attribute.name = like.name;
  if ('usage' in like) attribute.usage = like.usage;
  if ('gpuType' in like) attribute.gpuType = like.gpuType;
  return attribute;
}

const SETTERS = ['setX', 'setY', 'setZ', 'setW'] as const;

function fillHalf(attribute: BufferAttribute, values: ArrayLike<number>): void {
  for (let i = 0; i < values.length; i++) attribute[SETTERS[i % attribute.itemSize]!](Math.floor(i / attribute.itemSize), values[i]!);
}

/** A number as an array of this kind holds it. */
function stored(x: number, { array, normalized }: Attribute): number {
  if (array instanceof Float32Array || array instanceof Float64Array) return x;
  const bits = 8 * array.BYTES_PER_ELEMENT;
  const isSigned = array instanceof Int8Array || array instanceof Int16Array || array instanceof Int32Array;
  const most = 2 ** (isSigned ? bits - 1 : bits) - 1;
  const least = isSigned ? (normalized ? -most : -most - 1) : 0;
  return Math.min(Math.max(Math.round(normalized ? x * most : x), least), most);
}

function writeSkin(geometry: BufferGeometry, from: BufferGeometry, carried: Carried, refined: Refined, own: Grown): void {
  const { skinIndex, skinWeight } = from.attributes as Record<string, Attribute>;
  const skin = skinAt(own.corners, carried, refined);
  if (skin === null || skinIndex === undefined || skinWeight === undefined) return;
  // Four a vertex, whatever the geometry had.
  const joints = new (skinIndex.array.constructor as Uint16ArrayConstructor)(skin.joints);
  geometry.setAttribute('skinIndex', new BufferAttribute(joints, 4));
  geometry.setAttribute('skinWeight', plain(skin.weights, 4));
}

/** Where targets move vertices and, as then their normals do not follow by themselves, how they change these. */
function writeMorphs(
  geometry: BufferGeometry, from: BufferGeometry, { displacements }: Carried, refined: Refined, { surface, own }: { surface: Surface; own: Grown },
): void {
  const isRelative = geometry.morphTargetsRelative;
  const base = geometry.attributes as Record<string, Attribute>;
  const onBase = (numbers: Float32Array | Float64Array, name: string) => {
    return isRelative ? numbers : numbers.map((x, i) => x + component(base[name]!, i));
  };
  const names = (from.morphAttributes.position ?? []).map(own => own.name);
  displacements.forEach((channel, target) => {
    const none = new Float64Array(3 * own.vertices.length);
    const moved = refined.channels[channel];
    const position = plain(onBase(moved === undefined ? none : valuesAt(own.corners, moved), 'position'), 3);
    position.name = names[target]!;
    targets(geometry, 'position')[target] = position;
    if (displacements.every(own => own < 0)) return;
    const change = moved === undefined ? none : turnedBack(own, surface, addedNormals(refined.index, surface, refined.positions, moved));
    targets(geometry, 'normal')[target] = plain(onBase(change, 'normal'), 3);
  });
}
