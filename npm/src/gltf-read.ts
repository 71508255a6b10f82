/** Out of a document of glTF Transform: the primitives of a mesh as parts, with all that they carry. */

import type { Accessor, Mesh, Primitive, PrimitiveTarget } from '@gltf-transform/core';
import { LimitmeshError } from './error.js';
import { checkFinite, influencesOf, type Influence, type Part, type PartValues } from './parts.js';
import type { Semantic } from './types.js';

/** A primitive that is refined, and its part. */
export interface ReadPrimitive {
  primitive: Primitive;
  part: Part;
  /** The keys of its own attributes, and by target of those that it adds to. */
  carried: Map<string, CarriedName>;
}

/** The attribute that values are of: a primitive's own, or what a morph target adds to it. */
export interface CarriedName {
  name: string;
  /** -1 for the primitive's own. */
  target: number;
}

/** Numbers of a value at most that vertices of a file can have. */
const MOST_WIDE = 4;

/** The primitives of a mesh that have triangles; `name` names it in errors. */
export function readMesh(mesh: Mesh, name: string): ReadPrimitive[] {
  const all = mesh.listPrimitives().map((primitive, i) => readPrimitive(primitive, `${name}.primitives[${i}]`));
  const found = all.filter(own => own !== null);
  for (const { part, carried } of found) {
    for (const values of part.values) values.semantic = semanticOf(carried.get(values.name)!, found.map(own => own.primitive));
  }
  return found;
}

function readPrimitive(primitive: Primitive, place: string): ReadPrimitive | null {
  const position = primitive.getAttribute('POSITION');
  if (position === null || primitive.getMode() < 4) return null;
  const count = position.getCount();
  const corners = trianglesOf(primitive, count, place);
  if (corners.length === 0) return null;
  const targets = primitive.listTargets();
  const checked = (accessor: Accessor, name: string) => numbersOf(accessor, count, `${place}.${name}`);
  const carried = carriedNames(primitive, targets);
  const values = [...carried].map(([key, { name, target }]): PartValues => {
    const accessor = (target < 0 ? primitive : targets[target]!).getAttribute(name)!;
    // Colours without alpha are opaque; what is added to them is not.
    return { name: key, components: accessor.getElementSize(), data: checked(accessor, key), semantic: 'other', filler: target < 0 ? 1 : 0 };
  });
  const displacements = targets.map((own, target) => {
    const accessor = own.getAttribute('POSITION');
    return accessor === null ? null : checked(accessor, `targets[${target}].POSITION`);
  });
  const part = { positions: checked(position, 'POSITION'), corners, displacements, influences: skinOf(primitive, count, checked), values };
  checkFinite(part.positions, `${place}.POSITION`);
  return { primitive, part, carried };
}

function numbersOf(accessor: Accessor, count: number, place: string): Float64Array {
  if (accessor.getCount() !== count) {
    throw new LimitmeshError('mesh', place, `${place} has ${accessor.getCount()} values, expected ${count}: one a vertex`);
  }
  const size = accessor.getElementSize();
  const numbers = new Float64Array(count * size);
  const element: number[] = [];
  for (let v = 0; v < count; v++) numbers.set(accessor.getElement(v, element), v * size);
  return numbers;
}

/** Triangles, also of strips and fans, as the specification winds them. */
function trianglesOf(primitive: Primitive, count: number, place: string): Uint32Array {
  const indices = primitive.getIndices();
  const all = Uint32Array.from({ length: indices?.getCount() ?? count }, (_, i) => indices?.getScalar(i) ?? i);
  const at = all.findIndex(v => v >= count);
  if (at >= 0) {
    const where = `${place}.indices[${at}]`;
    throw new LimitmeshError('mesh', where, `${where} names vertex ${all[at]}, expected 0 to ${count - 1}`);
  }
  if (primitive.getMode() === 4) return all.subarray(0, all.length - (all.length % 3));
  const isFan = primitive.getMode() === 6;
  const found: number[] = [];
  for (let i = 0; i + 2 < all.length; i++) {
    const [a, b, c] = (isFan ? [i + 1, i + 2, 0] : [i, i + 1 + (i % 2), i + 2 - (i % 2)]).map(corner => all[corner]!) as [number, number, number];
    // Strips repeat vertices on purpose, to go on elsewhere.
    if (a !== b && b !== c && c !== a) found.push(a, b, c);
  }
  return Uint32Array.from(found);
}

function carriedNames(primitive: Primitive, targets: PrimitiveTarget[]): Map<string, CarriedName> {
  const found = new Map<string, CarriedName>();
  const add = (own: Primitive | PrimitiveTarget, target: number) => {
    for (const name of own.listSemantics()) {
      if (!isCarried(name) || own.getAttribute(name)!.getElementSize() > MOST_WIDE) continue;
      found.set(target < 0 ? name : `targets[${target}].${name}`, { name, target });
    }
  };
  add(primitive, -1);
  targets.forEach(add);
  return found;
}

/** Whether an attribute is a value of its own: normals and tangents follow from the surface, joints and weights move it. */
function isCarried(name: string): boolean {
  return !/^(POSITION|NORMAL|TANGENT|JOINTS|WEIGHTS)(_|$)/.test(name);
}

function semanticOf({ name, target }: CarriedName, primitives: Primitive[]): Semantic {
  if (name.startsWith('TEXCOORD_')) return 'texture';
  if (name.startsWith('COLOR_')) return 'colour';
  const all = primitives.map(own => (target < 0 ? own : own.listTargets()[target])?.getAttribute(name) ?? null);
  return name.startsWith('_') && all.every(own => own === null || isWhole(own)) ? 'label' : 'other';
}

/** Whether values are whole numbers that name something, so that nothing lies between them. */
function isWhole(accessor: Accessor): boolean {
  return !accessor.getNormalized() && !(accessor.getArray() instanceof Float32Array);
}

function skinOf(primitive: Primitive, count: number, checked: (accessor: Accessor, name: string) => Float64Array): Influence[][] | null {
  const sets: { joints: Float64Array; weights: Float64Array; size: number }[] = [];
  for (let set = 0; ; set++) {
    const [joints, weights] = [primitive.getAttribute(`JOINTS_${set}`), primitive.getAttribute(`WEIGHTS_${set}`)];
    if (joints === null || weights === null) break;
    const size = Math.min(joints.getElementSize(), weights.getElementSize());
    sets.push({ joints: checked(joints, `JOINTS_${set}`), weights: checked(weights, `WEIGHTS_${set}`), size });
  }
  if (sets.length === 0) return null;
  return influencesOf(count, vertex => sets.flatMap(({ joints, weights, size }) => Array.from({ length: size }, (_, i) => {
    return { joint: joints[vertex * size + i]!, weight: weights[vertex * size + i]! };
  })));
}
