/**
 * Documents of glTF Transform, against the Khronos validator, the native program (in the variable LIMITMESH) and, for what is to stay, the
 * documents themselves. Assets are in the folder that the variable LIMITMESH_MODELS names.
 */

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, rmSync } from 'node:fs';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import test from 'node:test';
import { Document, Logger, NodeIO } from '@gltf-transform/core';
import { ALL_EXTENSIONS, EXTMeshGPUInstancing } from '@gltf-transform/extensions';
import validator from 'gltf-validator';
import * as THREE from 'three';
import { LimitmeshError } from 'limitmesh';
import { limitmesh } from 'limitmesh/gltf-transform';

const { LIMITMESH: program, LIMITMESH_MODELS: models } = process.env;
const io = new NodeIO().registerExtensions(ALL_EXTENSIONS);
const quiet = new Logger(Logger.Verbosity.SILENT);

/** Those that are whole in the folder and need no decoder. */
const ASSETS = [
  'duck.glb', 'rgb_cube.gltf', 'assets/AnimatedMorphCube.gltf', 'assets/MorphStressTest.gltf', 'assets/TextureTransformTest.gltf',
  'assets/FeatureIdAttribute.gltf', 'assets/simple_skin.gltf', 'assets/quad_skin.glb', 'assets/BoxInterleaved.glb', 'assets/BoxVertexColors.glb',
  'assets/ShapeCollection.glb', 'assets/TwoCubes.glb', 'assets/cubevc.glb', 'assets/monkey.glb', 'assets/nested.glb', 'assets/BoxTextured.glb',
];

const folder = mkdtempSync(join(tmpdir(), 'limitmesh-'));
test.after(() => rmSync(folder, { recursive: true, force: true }));

function inOneBuffer(document) {
  const [first, ...others] = document.getRoot().listBuffers();
  for (const own of document.getRoot().listAccessors()) own.setBuffer(first);
  for (const own of others) own.dispose();
  return document;
}

const primitivesOf = document => document.getRoot().listMeshes().flatMap(mesh => mesh.listPrimitives());

async function errorsOf(document) {
  const { issues } = await validator.validateBytes(await io.writeBinary(inOneBuffer(document)));
  return issues.messages.filter(own => own.severity === 0).map(own => `${own.code} ${own.pointer}`);
}

/** All of a document but for geometry and the numbers of accessors. */
async function restOf(document) {
  const { json } = await io.writeJSON(document);
  const withoutNumbers = (key, value) => (['bufferView', 'inverseBindMatrices', 'input', 'output'].includes(key) ? undefined : value);
  const { accessors: _, bufferViews: __, buffers: ___, asset: ____, meshes, ...rest } = JSON.parse(JSON.stringify(json, withoutNumbers));
  const shown = meshes.map(mesh => ({
    ...mesh,
    primitives: mesh.primitives.map(({ material, extras, extensions, targets }) => ({ material, extras, extensions, targets: targets?.length })),
  }));
  return { ...rest, meshes: shown };
}

for (const name of ASSETS) {
  const file = models && join(models, name);
  const skip = models ? !existsSync(file) && 'there is no such file' : 'LIMITMESH_MODELS names no folder';
  test(`${name} is valid, and all but its geometry stays`, { skip }, async () => {
    const before = await io.read(file);
    const [errors, rest] = [await errorsOf(before), await restOf(before)];
    const document = (await io.read(file)).setLogger(quiet);
    await document.transform(limitmesh({ tolerance: '0.1%' }));
    inOneBuffer(document);
    assert.deepEqual(await restOf(document), rest);
    assert.deepEqual(await errorsOf(document), errors);
    for (const own of document.getRoot().listAccessors()) {
      assert.ok(own.listParents().some(parent => parent.propertyType !== 'Root'), 'no accessor is left that nothing uses');
    }
  });
}

function native(file, words) {
  const out = join(folder, 'out.glb');
  // Sharp edges are found where that is asked for, and targets are no goals, as here.
  execFileSync(program, ['refine', file, '-o', out, '--crease-angle', 'none', '--morph-tolerance', 'none', ...words], { stdio: 'pipe' });
  return io.read(out);
}

/** The greatest difference of two accessors. */
function difference(a, b) {
  assert.equal(a.getArray().length, b.getArray().length);
  return a.getArray().reduce((most, x, i) => Math.max(most, Math.abs(x - b.getArray()[i])), 0);
}

for (const name of ASSETS) {
  const file = models && join(models, name);
  const skip = !models || !program ? 'LIMITMESH and LIMITMESH_MODELS name a program and a folder' : !existsSync(file) && 'there is no such file';
  test(`${name} is as the native program has it`, { skip }, async () => {
    const document = (await io.read(file)).setLogger(quiet);
    await document.transform(limitmesh({ tolerance: '0.1%' }));
    const [own, others] = [document, await native(file, ['--tolerance', '0.1%'])].map(primitivesOf);
    assert.equal(own.length, others.length);
    own.forEach((primitive, i) => assertSame(primitive, others[i]));
  });
}

function assertSame(own, other) {
  assert.deepEqual(own.getIndices().getArray(), other.getIndices().getArray());
  // Tangents are left to viewers here.
  const names = other.listSemantics().filter(name => name !== 'TANGENT');
  assert.deepEqual(own.listSemantics().sort(), names.sort());
  for (const name of names) assert.ok(difference(own.getAttribute(name), other.getAttribute(name)) < 1e-7, name);
  own.listTargets().forEach((target, i) => {
    const theirs = other.listTargets()[i];
    const all = theirs.listSemantics().filter(name => name !== 'TANGENT');
    assert.deepEqual(target.listSemantics().sort(), all.sort());
    // Normals of targets are estimates.
    for (const name of all.filter(name => name !== 'NORMAL')) assert.equal(difference(target.getAttribute(name), theirs.getAttribute(name)), 0, name);
  });
}

/** A document with a ball of two primitives, the upper half and the lower one, that share no vertices. */
function halves() {
  const ball = new THREE.SphereGeometry(1, 16, 12);
  const document = new Document().setLogger(quiet);
  const buffer = document.createBuffer();
  const mesh = document.createMesh('ball').setExtras({ of: 'halves' });
  const { position, uv } = ball.attributes;
  const triangles = Array.from({ length: ball.index.count / 3 }, (_, t) => [0, 1, 2].map(i => ball.index.getX(3 * t + i)));
  const isUpper = own => own.reduce((sum, v) => sum + position.getY(v), 0) > 0;
  for (const upper of [true, false]) {
    const corners = triangles.filter(own => isUpper(own) === upper).flat();
    const numbers = [...new Set(corners)];
    // Three.js' own seams are off by roundings.
    const places = numbers.flatMap(v => [position.getX(v), position.getY(v), position.getZ(v)]).map(x => Math.round(x * 1e6) / 1e6);
    const accessor = (type, array) => document.createAccessor().setType(type).setArray(array).setBuffer(buffer);
    mesh.addPrimitive(document.createPrimitive()
      .setMaterial(document.createMaterial(upper ? 'upper' : 'lower'))
      .setAttribute('POSITION', accessor('VEC3', Float32Array.from(places)))
      .setAttribute('TEXCOORD_0', accessor('VEC2', Float32Array.from(numbers.flatMap(v => [uv.getX(v), uv.getY(v)]))))
      .setIndices(accessor('SCALAR', Uint16Array.from(corners.map(v => numbers.indexOf(v))))));
  }
  const node = document.createNode().setMesh(mesh);
  document.createScene().addChild(node);
  return { document, mesh, node, buffer };
}

/** By edge, as a text of its ends' places, how often triangles run along it. */
function usesOfEdges(primitives) {
  const uses = new Map();
  for (const primitive of primitives) {
    const [position, indices] = [primitive.getAttribute('POSITION'), primitive.getIndices().getArray()];
    const names = Array.from(indices, v => position.getElement(v, []).map(x => x + 0).join(' '));
    names.forEach((name, corner) => {
      const next = names[corner % 3 === 2 ? corner - 2 : corner + 1];
      const key = [name, next].sort().join('|');
      uses.set(key, (uses.get(key) ?? 0) + 1);
    });
  }
  return uses;
}

/** Makes triangles run the other way. */
function turn(primitive) {
  const indices = primitive.getIndices().getArray();
  for (let i = 0; i < indices.length; i += 3) [indices[i], indices[i + 1]] = [indices[i + 1], indices[i]];
}

const MADE = {
  'two primitives': () => {},
  'a sky': ({ mesh }) => mesh.listPrimitives().forEach(turn),
  'fronts and backs': ({ mesh, document }) => {
    const [upper, lower] = mesh.listPrimitives();
    lower.dispose();
    const back = document.createPrimitive().setMaterial(lower.getMaterial()).setIndices(upper.getIndices().clone());
    for (const name of upper.listSemantics()) back.setAttribute(name, upper.getAttribute(name).clone());
    turn(back);
    mesh.addPrimitive(back);
  },
  'a large node': ({ node }) => node.setScale([4, 8, 2]),
};

for (const [name, change] of Object.entries(MADE)) {
  test(`${name}: as the native program has it`, { skip: !program && 'LIMITMESH names no program' }, async () => {
    const made = halves();
    change(made);
    const file = join(folder, 'in.glb');
    await io.write(file, made.document);
    await made.document.transform(limitmesh({ tolerance: '0.3%' }));
    const [own, others] = [made.document, await native(file, ['--tolerance', '0.3%'])].map(primitivesOf);
    // A sky is turned, and turned back: its triangles stand in another order.
    if (name === 'a sky') own.forEach((primitive, i) => assert.deepEqual(placesOf(primitive), placesOf(others[i])));
    else own.forEach((primitive, i) => assertSame(primitive, others[i]));
  });
}

/** Triangles by the places of their corners and the normals there, the way they run, in the order of the texts. */
function placesOf(primitive) {
  const [position, normal] = ['POSITION', 'NORMAL'].map(name => primitive.getAttribute(name));
  const text = v => [...position.getElement(v, []), ...normal.getElement(v, [])].map(x => (Math.round(x * 1e5) + 0) / 1e5).join(' ');
  const corners = Array.from(primitive.getIndices().getArray(), text);
  const triangles = Array.from({ length: corners.length / 3 }, (_, t) => corners.slice(3 * t, 3 * t + 3));
  return triangles.map(([a, b, c]) => [[a, b, c], [b, c, a], [c, a, b]].map(own => own.join(' | ')).sort()[0]).sort();
}

test('primitives that share edges stay without cracks', async () => {
  const { document, mesh } = halves();
  await document.transform(limitmesh({ tolerance: '0.2%' }));
  assert.ok([...usesOfEdges(mesh.listPrimitives()).values()].every(count => count === 2));
  assert.deepEqual(mesh.listPrimitives().map(own => own.getMaterial().getName()), ['upper', 'lower']);
  assert.deepEqual(mesh.getExtras(), { of: 'halves' });
  for (const [i, own] of mesh.listPrimitives().entries()) {
    const position = own.getAttribute('POSITION');
    assert.ok(position.getMin([])[1] > (i === 0 ? -0.05 : -1) && position.getMax([])[1] < (i === 0 ? 1 : 0.05));
  }
  assert.deepEqual(await errorsOf(document), []);
});

test('lengths are those of the scene', async () => {
  const trianglesOf = async change => {
    const made = halves();
    change(made);
    await made.document.transform(limitmesh({ tolerance: 0.004 }));
    return primitivesOf(made.document).reduce((sum, own) => sum + own.getIndices().getCount() / 3, 0);
  };
  const [small, scaled] = [await trianglesOf(() => {}), await trianglesOf(({ node }) => node.setScale([3, -8, 1]))];
  const instanced = await trianglesOf(({ document, node, buffer }) => {
    const sizes = document.createAccessor().setType('VEC3').setArray(new Float32Array([1, 1, 1, 2, 2, 8])).setBuffer(buffer);
    node.setExtension('EXT_mesh_gpu_instancing', document.createExtension(EXTMeshGPUInstancing).createInstancedMesh().setAttribute('SCALE', sizes));
  });
  const large = await trianglesOf(({ mesh }) => {
    for (const own of mesh.listPrimitives()) own.getAttribute('POSITION').setArray(own.getAttribute('POSITION').getArray().map(x => 8 * x));
  });
  assert.ok(large > 2 * small, `${large} ${small}`);
  assert.deepEqual([scaled, instanced], [large, large]);
});

test('points and lines, and accessors that others use, stay', async () => {
  const { document, mesh, buffer } = halves();
  const [upper] = mesh.listPrimitives();
  const shared = upper.getAttribute('POSITION');
  const points = document.createPrimitive().setMode(0).setAttribute('POSITION', shared);
  const before = shared.getArray().slice();
  mesh.addPrimitive(points);
  const strip = document.createPrimitive().setMode(5).setAttribute('POSITION',
    document.createAccessor().setType('VEC3').setBuffer(buffer).setArray(new Float32Array([5, 0, 0, 6, 0, 0, 5, 1, 0, 6, 1, 0])));
  mesh.addPrimitive(strip);
  await document.transform(limitmesh({ triangles: 2000, boundary: 'fixed' }));
  assert.equal(points.getAttribute('POSITION'), shared);
  assert.deepEqual(shared.getArray(), before);
  assert.notEqual(upper.getAttribute('POSITION'), shared);
  assert.equal(strip.getMode(), 4);
  const corners = Array.from(strip.getIndices().getArray(), v => strip.getAttribute('POSITION').getElement(v, []));
  for (let i = 0; i < corners.length; i += 3) {
    const [a, b, c] = corners.slice(i, i + 3);
    assert.ok((b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]) > 0, 'strips are wound as the specification says');
  }
});

test('one line a mesh is logged, by a transform with a name', async () => {
  const lines = [];
  const { document } = halves();
  document.setLogger({ debug() {}, info: line => lines.push(line), warn() {}, error() {} });
  const transform = limitmesh({ tolerance: '1%' });
  assert.equal(transform.name, 'limitmesh');
  await document.transform(transform);
  assert.equal(lines.length, 1);
  assert.match(lines[0], /^limitmesh: meshes\[0\] 'ball': 352 → [\d,]+ triangles within 0\.0\d+ of the surface$/);
});

test('no creases are found unless asked for, by whatever word', async () => {
  const told = async options => {
    const { document } = halves();
    const lines = [];
    document.setLogger({ debug() {}, info: line => lines.push(line), warn() {}, error() {} });
    await document.transform(limitmesh({ tolerance: '1%', ...options }));
    return lines;
  };
  const usual = await told({});
  for (const creases of ['none', null, undefined]) assert.deepEqual(await told({ creases }), usual);
});

test('errors have a code and a place', async () => {
  assert.throws(() => limitmesh({ corners: [] }), { code: 'option', place: 'corners' });
  assert.throws(() => limitmesh({ creases: [[0, 1]] }), { code: 'option', place: 'creases' });
  const rejects = async (change, options, expected) => {
    const made = halves();
    change(made.mesh.listPrimitives()[0], made);
    await assert.rejects(made.document.transform(limitmesh(options)), error => error instanceof LimitmeshError && expected.test(`${error.code} ${error.place}`));
  };
  await rejects(() => {}, { tolerance: -1 }, /^option tolerance$/);
  await rejects(own => own.getIndices().setScalar(4, 9999), {}, /^mesh meshes\[0\] 'ball'\.primitives\[0\]\.indices\[4\]$/);
  await rejects(own => own.getAttribute('TEXCOORD_0').setArray(new Float32Array(2)), {}, /^mesh .*TEXCOORD_0$/);
  await rejects(own => own.getAttribute('POSITION').setElement(0, [NaN, 0, 0]), {}, /^mesh .*POSITION/);
});
