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
  await assert.rejects(refineFile(obj, 'doc', 'ply'), { code: 'option', place: 'from' });
  await assert.rejects(refineFile(obj, 'obj', 'exe'), { code: 'option', place: 'to' });
  await assert.rejects(refineFile('text', 'obj', 'ply'), { code: 'read', place: 'bytes' });
  await assert.rejects(refineFile(obj, 'obj', 'ply', { precision: 'f32' }), { code: 'option', place: 'precision' });
  const reason = new Error('gone');
  const signal = AbortSignal.abort(reason);
  await assert.rejects(refineFile(obj, 'obj', 'ply', { signal }), error => error === reason);
  assert.equal((await refineFile(obj, 'obj', 'ply')).report.meshes[0].stop, 'met');
});
