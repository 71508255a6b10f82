// A mesh as a binary PLY file: positions, normals, triangles.

import { Matrix4, Vector3 } from 'three';
import { triangles } from './model.js';

/** The bytes of the file: meshes as they stand now. Vertices at one place with one normal are one vertex. */
export function plyFile(meshes) {
  // Normals of meshes that are bent by their skins or shapes are known to the graphics card alone.
  const hasNormals = !meshes.some((mesh) => mesh.isSkinnedMesh || mesh.morphTargetInfluences);
  const vertices = [];
  const corners = [];
  const known = new Map();
  for (const mesh of meshes) {
    for (const placement of placements(mesh)) {
      for (let corner = 0; corner < 3 * triangles(mesh); corner++) {
        const vertex = vertexOf(mesh, placement, corner, hasNormals);
        const key = vertex.join();
        if (!known.has(key)) {
          known.set(key, vertices.length);
          vertices.push(vertex);
        }
        corners.push(known.get(key));
      }
    }
  }
  return written(vertices, corners, hasNormals);
}

/** Where a mesh stands: once, or as often as it has instances. */
function placements(mesh) {
  mesh.updateWorldMatrix(true, false);
  if (!mesh.isInstancedMesh) {
    return [mesh.matrixWorld];
  }
  return Array.from({ length: mesh.count }, (_, i) => {
    const own = new Matrix4();
    mesh.getMatrixAt(i, own);
    return own.premultiply(mesh.matrixWorld);
  });
}

function vertexOf(mesh, placement, corner, hasNormals) {
  const numbers = [...mesh.getVertexPosition(corner, new Vector3()).applyMatrix4(placement)];
  if (hasNormals) {
    const normal = new Vector3().fromBufferAttribute(mesh.geometry.attributes.normal, corner);
    numbers.push(...normal.transformDirection(placement));
  }
  return Array.from(new Float32Array(numbers));
}

function written(vertices, corners, hasNormals) {
  const names = ['x', 'y', 'z', ...(hasNormals ? ['nx', 'ny', 'nz'] : [])];
  const head = new TextEncoder().encode(
    [
      'ply',
      'format binary_little_endian 1.0',
      `element vertex ${vertices.length}`,
      ...names.map((name) => `property float ${name}`),
      `element face ${corners.length / 3}`,
      'property list uchar int vertex_indices',
      'end_header\n',
    ].join('\n'),
  );
  const [vertexBytes, triangleBytes] = [4 * names.length, 13];
  const facesAt = head.length + vertexBytes * vertices.length;
  const bytes = new Uint8Array(facesAt + (triangleBytes * corners.length) / 3);
  bytes.set(head);
  const view = new DataView(bytes.buffer);
  vertices.forEach((vertex, v) => {
    vertex.forEach((x, i) => view.setFloat32(head.length + vertexBytes * v + 4 * i, x, true));
  });
  for (let face = 0; face < corners.length / 3; face++) {
    const at = facesAt + triangleBytes * face;
    view.setUint8(at, 3);
    [0, 1, 2].forEach((i) => view.setInt32(at + 1 + 4 * i, corners[3 * face + i], true));
  }
  return bytes;
}
