/**
 * How large a document's scene shows its meshes: a length in the scene, divided by the greatest stretch of a mesh's matrices, holds for the
 * mesh. The vertices of a skin go where a mixture of its joints' matrices puts them, and a mixture stretches no more than the worst of them.
 */

import type { Accessor, Document, Mesh, Node, Skin } from '@gltf-transform/core';
import type { ReadPrimitive } from './gltf-read.js';

/** A matrix by columns of four. */
type Matrix = ArrayLike<number>;

/** How a node puts a mesh into the scene: by one matrix, or by a mixture of those of joints. */
interface Placement {
  matrices: Matrix[];
  isSkin: boolean;
  /** Whether the node is in the scene that is shown. */
  isShown: boolean;
}

const IDENTITY: Matrix = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1];

/** Where all meshes stand. */
export class Placements {
  readonly #all = new Map<Mesh, Placement[]>();

  constructor(document: Document) {
    const root = document.getRoot();
    if (root.listNodes().length === 0) {
      for (const mesh of root.listMeshes()) this.#all.set(mesh, [{ matrices: [IDENTITY], isSkin: false, isShown: true }]);
    }
    const scene = root.getDefaultScene() ?? root.listScenes()[0];
    const shown = new Set<Node>(scene === undefined ? root.listNodes() : []);
    scene?.traverse(node => void shown.add(node));
    for (const node of root.listNodes()) {
      const mesh = node.getMesh();
      if (mesh === null) continue;
      const found = this.#all.get(mesh) ?? [];
      this.#all.set(mesh, [...found, ...placementsOf(node, shown.has(node))]);
    }
  }

  /** How many times longer the scene shows a vector of a mesh at most; 1 where nothing shows it. */
  stretch(mesh: Mesh): number {
    const all = this.#all.get(mesh) ?? [];
    const stretch = all.reduce((most, own) => own.matrices.reduce((most, matrix) => Math.max(most, greatestStretch(matrix)), most), 0);
    return stretch > 0 && stretch < Infinity ? stretch : 1;
  }

  /** The diagonal of the box around all that the scene shows; 0 where it shows nothing. */
  diagonal(meshes: Map<Mesh, ReadPrimitive[]>): number {
    const low = [Infinity, Infinity, Infinity];
    const high = [-Infinity, -Infinity, -Infinity];
    for (const [mesh, primitives] of meshes) {
      for (const placement of (this.#all.get(mesh) ?? []).filter(own => own.isShown)) {
        for (const { part } of primitives) {
          for (const v of new Set(part.corners)) {
            placed(placement, part, v).forEach((x, i) => {
              low[i] = Math.min(low[i]!, x);
              high[i] = Math.max(high[i]!, x);
            });
          }
        }
      }
    }
    const diagonal = Math.hypot(high[0]! - low[0]!, high[1]! - low[1]!, high[2]! - low[2]!);
    return high[0]! >= low[0]! ? diagonal : 0;
  }
}

function placementsOf(node: Node, isShown: boolean): Placement[] {
  const skin = node.getSkin();
  if (skin !== null) return [{ matrices: jointsOf(skin), isSkin: true, isShown }];
  const world = node.getWorldMatrix();
  return instancesOf(node).map(own => ({ matrices: [product(world, own)], isSkin: false, isShown }));
}

/** The matrices of a skin's joints, from the mesh to the scene. */
function jointsOf(skin: Skin): Matrix[] {
  const inverse = skin.getInverseBindMatrices();
  return skin.listJoints().map((joint, i) => {
    const own = inverse !== null && i < inverse.getCount() ? inverse.getElement(i, []) : IDENTITY;
    return product(joint.getWorldMatrix(), own);
  });
}

/** The matrices of a node's instances. */
function instancesOf(node: Node): Matrix[] {
  const found = node.getExtension<never>('EXT_mesh_gpu_instancing') as { getAttribute?(name: string): Accessor | null } | null;
  if (found?.getAttribute === undefined) return [IDENTITY];
  const [moved, turned, scaled] = ['TRANSLATION', 'ROTATION', 'SCALE'].map(name => found.getAttribute!(name));
  const count = (moved ?? turned ?? scaled)?.getCount() ?? 0;
  return Array.from({ length: count }, (_, i) => {
    return matrixOf(moved?.getElement(i, []) ?? [0, 0, 0], turned?.getElement(i, []) ?? [0, 0, 0, 1], scaled?.getElement(i, []) ?? [1, 1, 1]);
  });
}

function matrixOf(moved: number[], turned: number[], scaled: number[]): Matrix {
  const length = Math.hypot(...turned);
  const [x, y, z, w] = (length > 0 ? turned.map(own => own / length) : [0, 0, 0, 1]) as [number, number, number, number];
  const columns = [
    [1 - 2 * (y * y + z * z), 2 * (x * y + z * w), 2 * (x * z - y * w)],
    [2 * (x * y - z * w), 1 - 2 * (x * x + z * z), 2 * (y * z + x * w)],
    [2 * (x * z + y * w), 2 * (y * z - x * w), 1 - 2 * (x * x + y * y)],
  ];
  return [...columns.flatMap((column, i) => [...column.map(own => own * scaled[i]!), 0]), ...moved, 1];
}

function product(a: Matrix, b: Matrix): Matrix {
  return Array.from({ length: 16 }, (_, at) => {
    const row = at % 4;
    const column = at - row;
    return [0, 1, 2, 3].reduce((sum, k) => sum + a[4 * k + row]! * b[column + k]!, 0);
  });
}

function applied(m: Matrix, p: ArrayLike<number>): number[] {
  return [0, 1, 2].map(i => m[i]! * p[0]! + m[4 + i]! * p[1]! + m[8 + i]! * p[2]! + m[12 + i]!);
}

/** Where a vertex goes. */
function placed({ matrices, isSkin }: Placement, { positions, influences }: ReadPrimitive['part'], v: number): number[] {
  const point = Array.from(positions.subarray(3 * v, 3 * v + 3));
  if (!isSkin) return applied(matrices[0]!, point);
  const own = (influences?.[v] ?? []).filter(({ joint }) => joint < matrices.length);
  const total = own.reduce((sum, { weight }) => sum + weight, 0);
  if (!(total > 0)) return point;
  const moved = [0, 0, 0];
  for (const { joint, weight } of own) applied(matrices[joint]!, point).forEach((x, i) => (moved[i]! += (weight / total) * x));
  return moved;
}

/** The greatest singular value of a matrix's linear part, by the closed form for the eigenvalues of a symmetric matrix. */
function greatestStretch(matrix: Matrix): number {
  const size = Math.max(...[0, 1, 2, 4, 5, 6, 8, 9, 10].map(at => Math.abs(matrix[at]!)));
  if (size === 0 || !Number.isFinite(size)) return size;
  const m = [0, 4, 8].map(first => [0, 1, 2].map(i => matrix[first + i]! / size));
  const a = m.map(u => m.map(v => u[0]! * v[0]! + u[1]! * v[1]! + u[2]! * v[2]!)) as Symmetric;
  const mean = (a[0][0] + a[1][1] + a[2][2]) / 3;
  const off = a[0][1] ** 2 + a[0][2] ** 2 + a[1][2] ** 2;
  const spread = [a[0][0], a[1][1], a[2][2]].reduce((sum, x) => sum + (x - mean) ** 2, 0) + 2 * off;
  const p = Math.sqrt(spread / 6);
  if (p === 0) return size * Math.sqrt(mean);
  const b = a.map((row, i) => row.map((x, j) => (i === j ? x - mean : x) / p)) as Symmetric;
  const half = Math.min(Math.max(0.5 * determinant(b), -1), 1);
  return size * Math.sqrt(Math.max(mean + 2 * p * Math.cos(Math.acos(half) / 3), 0));
}

type Symmetric = [[number, number, number], [number, number, number], [number, number, number]];

function determinant([a, b, c]: Symmetric): number {
  return a[0] * (b[1] * c[2] - b[2] * c[1]) - a[1] * (b[0] * c[2] - b[2] * c[0]) + a[2] * (b[0] * c[1] - b[1] * c[0]);
}
