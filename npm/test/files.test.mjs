/** Files of all formats: read, refined, written, and read again; assets keep what they show. */

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { ready, refine, refineFile } from 'limitmesh';
import { modelOf } from './models.mjs';

await ready;

const head = modelOf('head');
const obj = Buffer.from(objOf(head));

function objOf({ positions, index }) {
  const rows = (letter, values) => Array.from({ length: values.length / 3 }, (_, i) => `${letter} ${values.slice(3 * i, 3 * i + 3).join(' ')}\n`).join('');
  return rows('v', positions) + rows('f', Uint32Array.from(index, v => v + 1));
}

test('an OBJ file becomes the same mesh as its arrays', async () => {
  const { bytes, report } = await refineFile(obj, 'obj', 'obj', { tolerance: '1%', creases: 'none' });
  const lines = Buffer.from(bytes).toString().split('\n').map(line => line.split(' '));
  const positions = Float64Array.from(lines.filter(([kind]) => kind === 'v').flatMap(([, ...xyz]) => xyz.slice(0, 3).map(Number)));
  const own = refine(head.positions, head.index, { tolerance: '1%', precision: 'f64' });
  assert.deepEqual(positions, own.positions);
  assert.equal(report.meshes.length, 1);
  assert.equal(report.meshes[0].triangles, own.index.length / 3);
  assert.deepEqual(report.meshes[0].error, own.error);
});

test('every format is written and read again', async () => {
  for (const format of ['obj', 'ply', 'stl', 'off', 'gltf', 'glb', '3mf']) {
    const { bytes, report } = await refineFile(obj, 'obj', format, { tolerance: '2%' });
    assert.equal(report.meshes[0].stop, 'met');
    const again = await refineFile(bytes, format, 'ply', { tolerance: '5%' });
    assert.ok(again.report.meshes[0].triangles >= report.meshes[0].triangles / 2, format);
  }
});

/** A box of 3 × 2 × 1 around the origin as a binary STL file: twelve triangles, each with corners of its own. */
function stlOfBox() {
  const sides = [0, 1, 2].flatMap(axis => [-1, 1].map(sign => ({ axis, sign })));
  const corner = ({ axis, sign }, a, b) => {
    const [u, v] = sign > 0 ? [a, b] : [b, a];
    const point = [];
    [point[axis], point[(axis + 1) % 3], point[(axis + 2) % 3]] = [sign, u, v];
    return point.map((x, i) => x * [1.5, 1, 0.5][i]);
  };
  const triangles = sides.flatMap(side => [[[-1, -1], [1, -1], [1, 1]], [[-1, -1], [1, 1], [-1, 1]]].map(all => all.map(at => corner(side, ...at))));
  const bytes = Buffer.alloc(84 + 50 * triangles.length);
  bytes.writeUInt32LE(triangles.length, 80);
  triangles.forEach((all, t) => all.flat().forEach((x, i) => bytes.writeFloatLE(x, 84 + 50 * t + 12 + 4 * i)));
  return bytes;
}

/** Document and numbers of a GLB file. */
function openGlb(bytes) {
  const view = new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);
  const length = view.getUint32(12, true);
  const document = JSON.parse(Buffer.from(bytes.subarray(20, 20 + length)).toString());
  const floats = accessor => {
    const { bufferView, byteOffset = 0, count } = document.accessors[accessor];
    const { byteOffset: start = 0, byteStride = 12 } = document.bufferViews[bufferView];
    const at = 28 + length + start + byteOffset;
    return Array.from({ length: count }, (_, v) => [0, 4, 8].map(i => view.getFloat32(at + v * byteStride + i, true)));
  };
  return { document, floats };
}

test('normals of a sharp box are those of its six sides, in glTF and PLY with vertices for each', async () => {
  const { bytes, report } = await refineFile(stlOfBox(), 'stl', 'glb', { tolerance: '1%' });
  assert.deepEqual(report.leftOut, []);
  const { document, floats } = openGlb(bytes);
  const { POSITION, NORMAL } = document.meshes[0].primitives[0].attributes;
  const [positions, normals] = [floats(POSITION), floats(NORMAL)];
  assert.equal(normals.length, positions.length);
  const seen = new Map();
  positions.forEach((at, v) => {
    const axis = normals[v].findIndex(x => Math.abs(x) > 0.99999);
    assert.ok(axis >= 0, `normal ${normals[v]} at ${at}`);
    // The vertex is on the side that the normal is of.
    assert.ok(Math.abs(at[axis] - Math.sign(normals[v][axis]) * [1.5, 1, 0.5][axis]) < 1e-6, `normal ${normals[v]} at ${at}`);
    seen.set(String(at), (seen.get(String(at)) ?? 0) + 1);
  });
  const isCorner = at => at.every((x, i) => Math.abs(x) === [1.5, 1, 0.5][i]);
  const corners = [...seen].filter(([at]) => isCorner(at.split(',').map(Number)));
  assert.deepEqual(corners.map(([, count]) => count), Array(8).fill(3), 'three sides meet at each of eight corners');
  const ply = (await refineFile(stlOfBox(), 'stl', 'ply', { tolerance: '1%' })).bytes;
  const header = Buffer.from(ply).toString('latin1').split('end_header')[0];
  assert.match(header, new RegExp(`element vertex ${positions.length}\\n`));
  assert.match(header, /property \w+ nx\n/);
});

test('files of materials that a format does not name are left out, and told', async () => {
  const named = Buffer.concat([Buffer.from('mtllib looks.mtl\nusemtl skin\n'), obj]);
  const { bytes, report } = await refineFile(named, 'obj', 'glb', { tolerance: '5%' });
  assert.ok(report.leftOut.includes('looks.mtl'), String(report.leftOut));
  assert.equal(openGlb(bytes).document.materials[0].name, 'skin');
  const again = await refineFile(named, 'obj', 'obj', { tolerance: '5%' });
  assert.deepEqual(again.report.leftOut, []);
  assert.match(Buffer.from(again.bytes).toString(), /^mtllib looks\.mtl$/m);
});

/** An asset of one quad with a texture, in JSON, with its buffer as text. */
function assetOf({ hasSkin = false } = {}) {
  const floats = new Float32Array([0, 0, 0, 1, 0, 0, 1, 1, 1, 0, 1, 0, /* uv */ 0, 0, 1, 0, 1, 1, 0, 1]);
  const data = Buffer.concat([Buffer.from(floats.buffer), Buffer.from(new Uint16Array([0, 1, 2, 0, 2, 3]).buffer)]);
  const attributes = { POSITION: 0, TEXCOORD_0: 1 };
  return {
    asset: { version: '2.0', extras: { kept: 'yes' } },
    scene: 0,
    scenes: [{ nodes: [0] }],
    nodes: [{ mesh: 0, name: 'sail', scale: [2, 2, 2] }],
    materials: [{ name: 'cloth', pbrMetallicRoughness: { baseColorTexture: { index: 0 } } }],
    textures: [{ source: 0 }],
    images: [{ uri: 'data:image/png;base64,iVBORw0KGgo=' }],
    meshes: [{ name: 'sail', primitives: [{ attributes, indices: 2, material: 0, ...(hasSkin ? { targets: [{ POSITION: 0 }] } : {}) }] }],
    accessors: [
      { bufferView: 0, componentType: 5126, count: 4, type: 'VEC3', min: [0, 0, 0], max: [1, 1, 1] },
      { bufferView: 1, componentType: 5126, count: 4, type: 'VEC2' },
      { bufferView: 2, componentType: 5123, count: 6, type: 'SCALAR' },
    ],
    bufferViews: [{ buffer: 0, byteLength: 48 }, { buffer: 0, byteOffset: 48, byteLength: 32 }, { buffer: 0, byteOffset: 80, byteLength: 12 }],
    buffers: [{ byteLength: 92, uri: `data:application/octet-stream;base64,${data.toString('base64')}` }],
  };
}

test('from glTF to glTF the asset is edited: material, texture, names and extras stay', async () => {
  const asset = Buffer.from(JSON.stringify(assetOf()));
  const { bytes, report } = await refineFile(asset, 'gltf', 'glb', { tolerance: '0.5%' });
  const length = new DataView(bytes.buffer, bytes.byteOffset).getUint32(12, true);
  const document = JSON.parse(Buffer.from(bytes.subarray(20, 20 + length)).toString());
  assert.equal(report.meshes[0].name.includes('sail'), true);
  assert.deepEqual(document.asset.extras, { kept: 'yes' });
  assert.deepEqual([document.nodes[0].scale, document.materials[0].name], [[2, 2, 2], 'cloth']);
  assert.ok(document.materials[0].pbrMetallicRoughness.baseColorTexture && document.textures.length === 1);
  const { attributes, indices, material } = document.meshes[0].primitives[0];
  assert.equal(material, 0);
  assert.equal(document.accessors[indices].count, 3 * report.meshes[0].triangles);
  assert.ok('TEXCOORD_0' in attributes && 'NORMAL' in attributes);
  assert.equal(document.accessors[attributes.TEXCOORD_0].count, document.accessors[attributes.POSITION].count);
});

test('what cannot be kept is refused, and errors name their place', async () => {
  const moving = Buffer.from(JSON.stringify(assetOf({ hasSkin: true })));
  await assert.rejects(refineFile(moving, 'gltf', 'glb'), { code: 'read', place: 'meshes[0]' });
  await assert.rejects(refineFile(Buffer.from('v 0 0 0\nv 1 x 0\n'), 'obj', 'ply'), { code: 'read', place: 'line 2' });
  await assert.rejects(refineFile(Buffer.alloc(0), 'ply', 'ply'), { code: 'read', place: 'bytes' });
  await assert.rejects(refineFile(obj, 'glb', 'glb'), { code: 'read', place: 'bytes', message: /looks like/ });
  await assert.rejects(refineFile(obj, 'doc', 'ply'), { code: 'option', place: 'from' });
  await assert.rejects(refineFile(obj, 'obj', 'exe'), { code: 'option', place: 'to' });
  await assert.rejects(refineFile('text', 'obj', 'ply'), { code: 'read', place: 'bytes' });
  await assert.rejects(refineFile(obj, 'obj', 'ply', { precision: 'f32' }), { code: 'option', place: 'precision' });
  const reason = new Error('gone');
  const signal = AbortSignal.abort(reason);
  await assert.rejects(refineFile(obj, 'obj', 'ply', { signal }), error => error === reason);
  assert.equal((await refineFile(obj, 'obj', 'ply')).report.meshes[0].stop, 'met');
});
