/** Refined triangles back into the primitives of a document, which keep their materials, extras and names. */

import type { Accessor, Buffer, Document, Primitive, PrimitiveTarget, TypedArray } from '@gltf-transform/core';
import { grown, skinAt, surfaceOf, turnedBack, valuesAt, type Carried, type Grown, type Surface } from './carry.js';
import { addedNormals } from './moved-normals.js';
import type { ReadPrimitive } from './gltf-read.js';
import type { Joined } from './join.js';
import type { Refined } from './types.js';

/** A mesh that was refined at `scale` times its size, and what it is put together from. */
export interface RefinedMesh {
  primitives: ReadPrimitive[];
  joined: Joined;
  carried: Carried;
  refined: Refined;
  scale: number;
}

/** Puts a refined mesh back. A primitive of which nothing is left, as it had no area, stays as it is. */
export function writeMesh(document: Document, own: RefinedMesh): void {
  const { primitives, joined, carried, refined, scale } = own;
  const surface = surfaceOf(joined, refined);
  const positions = Float64Array.from(refined.positions, x => x / scale);
  const moved = carried.displacements.map(channel => {
    return channel < 0 ? null : addedNormals(refined.index, surface, positions, refined.channels[channel]!);
  });
  primitives.forEach((read, i) => {
    const decisive = refined.channels.filter((_, channel) => read.carried.has(carried.names[channel] ?? ''));
    const part = grown(refined, surface, decisive, { first: joined.firstFace[i]!, end: joined.firstFace[i + 1]! }, () => 0);
    if (part.index.length > 0) new Writer(document, own, read, { surface, positions, moved, part }).write();
  });
}

interface Found {
  surface: Surface;
  /** In the mesh's own unit. */
  positions: Float64Array;
  /** By target, what it adds to normals. */
  moved: (Float32Array | null)[];
  part: Grown;
}

const WIDTHS = ['SCALAR', 'VEC2', 'VEC3', 'VEC4'] as const;

/** Writes one primitive. */
class Writer {
  readonly #document: Document;
  readonly #mesh: RefinedMesh;
  readonly #read: ReadPrimitive;
  readonly #found: Found;
  readonly #buffer: Buffer | null;
  readonly #old = new Set<Accessor>();

  constructor(document: Document, mesh: RefinedMesh, read: ReadPrimitive, found: Found) {
    this.#document = document;
    this.#mesh = mesh;
    this.#read = read;
    this.#found = found;
    this.#buffer = read.primitive.getAttribute('POSITION')!.getBuffer();
  }

  write(): void {
    const { primitive, carried } = this.#read;
    const { part, positions } = this.#found;
    const targets = primitive.listTargets();
    const hadNormals = targets.map(own => own.getAttribute('NORMAL') !== null);
    const hadPositions = targets.map(own => own.getAttribute('POSITION') !== null);
    for (const own of [primitive, ...targets]) this.#clear(own);
    this.#set(primitive, 'POSITION', rows(part.vertices, positions), 3);
    this.#set(primitive, 'NORMAL', part.normals, 3);
    for (const [key, { name, target }] of carried) {
      const channel = this.#mesh.refined.channels[this.#mesh.carried.names.indexOf(key)]!;
      const values = valuesAt(part.corners, channel);
      const isWhole = this.#read.part.values.find(own => own.name === key)!.semantic === 'label';
      this.#set(target < 0 ? primitive : targets[target]!, name, isWhole ? wholes(values) : Float32Array.from(values), channel.components);
    }
    this.#writeSkin();
    targets.forEach((own, target) => this.#writeTarget(own, target, hadPositions[target]!, hadNormals[target]!));
    this.#writeIndices();
    // What nothing else uses.
    for (const own of this.#old) if (own.listParents().every(parent => parent.propertyType === 'Root')) own.dispose();
  }

  #clear(own: Primitive | PrimitiveTarget): void {
    for (const name of own.listSemantics()) {
      this.#old.add(own.getAttribute(name)!);
      own.setAttribute(name, null);
    }
  }

  #accessor(numbers: TypedArray, components: number): Accessor {
    return this.#document.createAccessor().setType(WIDTHS[components - 1]!).setArray(numbers).setBuffer(this.#buffer);
  }

  #set(own: Primitive | PrimitiveTarget, name: string, numbers: TypedArray, components: number): void {
    own.setAttribute(name, this.#accessor(numbers, components));
  }

  #writeIndices(): void {
    const { primitive } = this.#read;
    const { part } = this.#found;
    const old = primitive.getIndices();
    if (old !== null) this.#old.add(old);
    // The highest number of each size is reserved.
    const isShort = part.vertices.length <= 65_535;
    primitive.setIndices(this.#accessor(isShort ? Uint16Array.from(part.index) : part.index, 1)).setMode(4);
  }

  #writeSkin(): void {
    const { primitive, part } = this.#read;
    const skin = part.influences === null ? null : skinAt(this.#found.part.corners, this.#mesh.carried, this.#mesh.refined);
    if (skin === null) return;
    this.#set(primitive, 'JOINTS_0', wholes(skin.joints), 4);
    this.#set(primitive, 'WEIGHTS_0', Float32Array.from(skin.weights), 4);
  }

  /** Targets that move vertices say how these change normals, which do not follow by themselves. */
  #writeTarget(own: PrimitiveTarget, target: number, hadPositions: boolean, hadNormals: boolean): void {
    const { part, surface, moved } = this.#found;
    const none = () => new Float32Array(3 * part.vertices.length);
    const channel = this.#mesh.refined.channels[this.#mesh.carried.displacements[target]!];
    const added = moved[target] ?? null;
    if (hadPositions) this.#set(own, 'POSITION', channel === undefined ? none() : Float32Array.from(valuesAt(part.corners, channel)), 3);
    if (hadNormals || (hadPositions && added !== null)) {
      this.#set(own, 'NORMAL', added === null ? none() : turnedBack(part, surface, added), 3);
    }
    // Targets are counted, and each has to add something.
    if (own.listSemantics().length === 0) this.#set(own, 'POSITION', none(), 3);
  }
}

function rows(vertices: Uint32Array, numbers: ArrayLike<number>): Float32Array {
  return Float32Array.from({ length: 3 * vertices.length }, (_, i) => numbers[3 * vertices[Math.floor(i / 3)]! + (i % 3)]!);
}

/** Whole numbers in as few bytes as a file can hold them in. */
function wholes(values: ArrayLike<number>): TypedArray {
  let [least, most] = [0, 0];
  for (let i = 0; i < values.length; i++) [least, most] = [Math.min(least, values[i]!), Math.max(most, values[i]!)];
  if (least < 0 || most > 65_535) return new Float32Array(values);
  return most <= 255 ? new Uint8Array(values) : new Uint16Array(values);
}
