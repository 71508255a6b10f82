/** Geometries of three.js, against what three.js itself makes of cages and results, and against `limit`. */

import assert from 'node:assert/strict';
import test from 'node:test';
import * as THREE from 'three';
import { mergeGeometries } from 'three/addons/utils/BufferGeometryUtils.js';
import { limit, LimitmeshError, ready } from 'limitmesh';
import { refineGeometry, refineGeometryAsync } from 'limitmesh/three';

await ready;

const point = (attribute, v) => new THREE.Vector3().fromBufferAttribute(attribute, v);

/** By edge, as a text of its ends' places, how often triangles run one way along it, and 1000 times how often the other way. */
function edgesByPlace({ index, attributes }) {
  const uses = new Map();
  const name = v => point(attributes.position, v).toArray().join(' ');
  for (let corner = 0; corner < index.count; corner++) {
    const next = corner % 3 === 2 ? corner - 2 : corner + 1;
    const [a, b] = [name(index.getX(corner)), name(index.getX(next))];
    const key = a < b ? `${a}|${b}` : `${b}|${a}`;
    uses.set(key, (uses.get(key) ?? 0) + (a < b ? 1 : 1000));
  }
  return uses;
}

function assertWatertight(geometry, name) {
  const wrong = [...edgesByPlace(geometry).values()].filter(uses => uses !== 1001);
  assert.equal(wrong.length, 0, `${name}: each edge is of two triangles, which run oppositely along it`);
}

function areaOf({ index, attributes }, first, count) {
  let area = 0;
  for (let corner = first; corner < first + count; corner += 3) {
    const [a, b, c] = [0, 1, 2].map(i => point(attributes.position, index.getX(corner + i)));
    area += b.sub(a).cross(c.sub(a)).length() / 2;
  }
  return area;
}

function volumeOf({ index, attributes }) {
  let volume = 0;
  for (let corner = 0; corner < index.count; corner += 3) {
    const [a, b, c] = [0, 1, 2].map(i => point(attributes.position, index.getX(corner + i)));
    volume += a.dot(b.cross(c)) / 6;
  }
  return volume;
}

const box = () => new THREE.BoxGeometry(1, 2, 3, 3, 3, 3);
const closed = {
  box: box(),
  'box without an index': box().toNonIndexed(),
  sphere: new THREE.SphereGeometry(1, 16, 12),
  knot: new THREE.TorusKnotGeometry(1, 0.3, 48, 8),
  merged: mergeGeometries([box(), new THREE.SphereGeometry(1, 12, 8).translate(5, 0, 0), new THREE.TorusKnotGeometry(1, 0.3, 48, 8).translate(0, 9, 0)]),
};

for (const [name, cage] of Object.entries(closed)) {
  test(`${name}: closed at seams of uv and normals`, () => {
    const fine = refineGeometry(cage, { tolerance: '0.2%' });
    assertWatertight(fine, name);
    assert.ok(volumeOf(fine) > 0);
    assert.ok(fine.userData.limitmesh.error.certified);
    assert.equal(fine.userData.limitmesh.stop, 'met');
    assert.deepEqual(Object.keys(fine.attributes).sort(), Object.keys(cage.attributes).sort());
    for (const own of Object.values(fine.attributes)) assert.equal(own.count, fine.attributes.position.count);
  });
}

test('normals are those of the sphere, and split at creases', () => {
  const sphere = refineGeometry(new THREE.IcosahedronGeometry(1, 3), { tolerance: '0.1%' });
  const { position, normal } = sphere.attributes;
  for (let v = 0; v < position.count; v++) assert.ok(point(position, v).normalize().dot(point(normal, v)) > 0.999);
  const sharp = refineGeometry(new THREE.BoxGeometry(1, 1, 1, 2, 2, 2), { creaseAngle: 60 });
  for (let v = 0; v < sharp.attributes.position.count; v++) {
    const [x, y, z] = point(sharp.attributes.normal, v).toArray().map(Math.abs).sort();
    assert.ok(x < 1e-6 && y < 1e-6 && z > 1 - 1e-6, 'along an axis');
  }
});

test('creases and corners are named by the vertices of the geometry', () => {
  const cage = new THREE.BoxGeometry(1, 1, 1, 2, 2, 2);
  const { position } = cage.attributes;
  const isTop = v => position.getY(v) === 0.5 && (Math.abs(position.getX(v)) === 0.5 || Math.abs(position.getZ(v)) === 0.5);
  const creases = [];
  for (let corner = 0; corner < cage.index.count; corner++) {
    const [a, b] = [cage.index.getX(corner), cage.index.getX(corner % 3 === 2 ? corner - 2 : corner + 1)];
    const [p, q] = [point(position, a), point(position, b)];
    if (isTop(a) && isTop(b) && (p.x === q.x && Math.abs(p.x) === 0.5 || p.z === q.z && Math.abs(p.z) === 0.5)) creases.push([a, b]);
  }
  const corners = Array.from({ length: position.count }, (_, v) => v).filter(v => isTop(v) && Math.abs(position.getX(v)) === 0.5 && Math.abs(position.getZ(v)) === 0.5);
  const fine = refineGeometry(cage, { creases, corners });
  fine.computeBoundingBox();
  // The rim of the top keeps its square; the bottom is round.
  assert.ok(fine.boundingBox.max.toArray().every(x => Math.abs(x - 0.5) < 1e-6));
  const places = Array.from({ length: fine.attributes.position.count }, (_, v) => point(fine.attributes.position, v));
  const reach = sign => Math.max(...places.map(p => sign * p.y + p.x + p.z));
  assert.ok(Math.abs(reach(1) - 1.5) < 1e-6 && reach(-1) < 1.3, `${reach(1)} ${reach(-1)}`);
  assert.throws(() => refineGeometry(cage, { creases: [[0, 999]] }), { code: 'option', place: 'creases[0]' });
});

test('groups draw what their control triangles become', () => {
  // A cylinder with its caps, twice drawn: once by parts, once as a whole; and its side by no group.
  const cage = new THREE.CylinderGeometry(1, 1, 2, 12, 4);
  const [side, top, bottom] = cage.groups;
  cage.clearGroups();
  cage.addGroup(top.start, top.count, 7);
  cage.addGroup(bottom.start, bottom.count, 1);
  cage.addGroup(0, Infinity, 2);
  const fine = refineGeometry(cage, { tolerance: '0.05%', creaseAngle: 60 });
  assert.deepEqual(fine.groups.map(own => own.materialIndex), [7, 1, 2]);
  assert.equal(fine.groups[2].count, fine.index.count);
  const circle = Math.PI;
  for (const own of fine.groups.slice(0, 2)) assert.ok(Math.abs(areaOf(fine, own.start, own.count) - circle) < 0.15 * circle);
  // Caps are flat: all of them, and no other triangles, are at the ends.
  for (const [at, y] of [[0, 1], [1, -1]]) {
    const { start, count } = fine.groups[at];
    for (let corner = start; corner < start + count; corner++) assert.ok(Math.abs(fine.attributes.position.getY(fine.index.getX(corner)) - y) < 1e-6);
  }
  const rest = fine.index.count - fine.groups[0].count - fine.groups[1].count;
  assert.ok(rest > 3 * side.count / 3 / 2, 'the side is there, too');
  assertWatertight(fine, 'groups');
});

test('areas of groups are those of the limit surface', () => {
  const cage = new THREE.BoxGeometry(2, 2, 2, 4, 4, 4);
  const coarse = refineGeometry(cage, { tolerance: '0.5%' });
  const fine = refineGeometry(cage, { tolerance: '0.01%' });
  assert.equal(coarse.groups.length, 6);
  const sixth = areaOf(fine, 0, fine.index.count) / 6;
  coarse.groups.forEach((own, i) => {
    const [a, b] = [areaOf(coarse, own.start, own.count), areaOf(fine, fine.groups[i].start, fine.groups[i].count)];
    assert.ok(Math.abs(a / b - 1) < 0.01 && Math.abs(b / sixth - 1) < 0.01, `${a} ${b} ${sixth}: a cube has equal sides`);
    assert.equal(own.materialIndex, cage.groups[i].materialIndex);
  });
});

/** The same geometry with one buffer for all, and uv and colours as fractions of integers. */
function interleaved(cage) {
  const { position, uv, color } = cage.attributes;
  const all = new THREE.InterleavedBuffer(new Float32Array(8 * position.count), 8);
  const own = { position: new THREE.InterleavedBufferAttribute(all, 3, 1), uv: new THREE.InterleavedBufferAttribute(all, 2, 5) };
  for (let v = 0; v < position.count; v++) {
    own.position.setXYZ(v, ...point(position, v).toArray());
    own.uv.setXY(v, uv.getX(v), uv.getY(v));
  }
  const bytes = new THREE.BufferAttribute(new Uint8Array(3 * position.count), 3, true);
  for (let v = 0; v < position.count; v++) bytes.setXYZ(v, color.getX(v), color.getY(v), color.getZ(v));
  const geometry = new THREE.BufferGeometry().setIndex(cage.index);
  return geometry.setAttribute('position', own.position).setAttribute('uv', own.uv).setAttribute('color', bytes);
}

test('interleaved and normalised attributes are what plain ones are', () => {
  const cage = new THREE.SphereGeometry(1, 12, 8);
  const colors = new THREE.BufferAttribute(new Float32Array(3 * cage.attributes.position.count), 3);
  for (let v = 0; v < colors.count; v++) colors.setXYZ(v, v % 3 === 0 ? 1 : 0, (v % 5) / 5, (v % 51) / 255);
  cage.setAttribute('color', colors);
  const [a, b] = [refineGeometry(cage), refineGeometry(interleaved(cage))];
  assert.deepEqual(a.index.array, b.index.array);
  assert.deepEqual(a.attributes.position.array, b.attributes.position.array);
  assert.deepEqual(a.attributes.uv.array, b.attributes.uv.array);
  assert.ok(b.attributes.color.array instanceof Uint8Array && b.attributes.color.normalized);
  for (let v = 0; v < a.attributes.color.count; v++) {
    for (const get of ['getX', 'getY', 'getZ']) assert.ok(Math.abs(a.attributes.color[get](v) - b.attributes.color[get](v)) <= 1 / 255);
  }
});

test('uv of the limit surface: linear ones stay so', () => {
  // On a flat grid with boundaries that stay, the place on the texture is the place itself.
  const cage = new THREE.PlaneGeometry(1, 1, 4, 4);
  const grid = cage.attributes.position;
  for (let v = 0; v < grid.count; v++) grid.setZ(v, 0.3 * Math.sin(3 * grid.getX(v)));
  const fine = refineGeometry(cage, { boundary: 'fixed' });
  const { position, uv } = fine.attributes;
  for (let v = 0; v < position.count; v++) {
    assert.ok(Math.abs(uv.getX(v) - position.getX(v) - 0.5) < 1e-6 && Math.abs(uv.getY(v) - position.getY(v) - 0.5) < 1e-6);
  }
});

test('whole numbers are labels, halves stay halves, instances stay as they are, tangents are found anew', () => {
  const source = new THREE.SphereGeometry(1, 12, 8);
  const cage = new THREE.InstancedBufferGeometry().copy(source);
  cage.instanceCount = 2;
  const offsets = new THREE.InstancedBufferAttribute(new Float32Array([0, 0, 0, 5, 0, 0]), 3);
  const count = cage.attributes.position.count;
  const bone = new THREE.BufferAttribute(new Int16Array(count).map((_, v) => (cage.attributes.position.getY(v) > 0 ? 300 : -2)), 1);
  const half = new THREE.Float16BufferAttribute(new Uint16Array(count), 1);
  for (let v = 0; v < count; v++) half.setX(v, cage.attributes.position.getX(v));
  cage.setAttribute('offset', offsets).setAttribute('bone', bone).setAttribute('heat', half);
  cage.computeTangents();
  const fine = refineGeometry(cage);
  assert.ok(fine.isInstancedBufferGeometry && fine.instanceCount === 2);
  assert.equal(fine.attributes.offset, offsets);
  assert.ok(fine.attributes.bone.array instanceof Int16Array);
  assert.deepEqual([...new Set(fine.attributes.bone.array)].sort(), [-2, 300]);
  assert.ok(fine.attributes.heat.isFloat16BufferAttribute);
  let farthest = 0;
  for (let v = 0; v < fine.attributes.heat.count; v++) farthest = Math.max(farthest, Math.abs(fine.attributes.heat.getX(v) - fine.attributes.position.getX(v)));
  assert.ok(farthest < 0.1, 'linear over faces, so near to the surface');
  const { tangent, normal } = fine.attributes;
  for (let v = 0; v < tangent.count; v++) assert.ok(Math.abs(new THREE.Vector3(tangent.getX(v), tangent.getY(v), tangent.getZ(v)).dot(point(normal, v))) < 1e-5);
});

/** A tube along y with two bones: the upper half follows one of them, blended around the middle. */
function tube() {
  const geometry = new THREE.CylinderGeometry(0.3, 0.3, 4, 8, 8);
  const { position } = geometry.attributes;
  const indices = new Uint16Array(4 * position.count);
  const weights = new Float32Array(4 * position.count);
  for (let v = 0; v < position.count; v++) {
    const upper = Math.min(Math.max(position.getY(v) + 0.5, 0), 1);
    indices.set([0, 1, 0, 0], 4 * v);
    weights.set([1 - upper, upper, 0, 0], 4 * v);
  }
  geometry.setAttribute('skinIndex', new THREE.BufferAttribute(indices, 4));
  geometry.setAttribute('skinWeight', new THREE.BufferAttribute(weights, 4));
  return geometry;
}

function skinned(geometry) {
  const bones = [new THREE.Bone(), new THREE.Bone()];
  bones[0].position.y = -2;
  bones[1].position.y = 2;
  bones[0].add(bones[1]);
  const mesh = new THREE.SkinnedMesh(geometry, new THREE.MeshBasicMaterial());
  mesh.add(bones[0]);
  mesh.updateMatrixWorld(true);
  mesh.bind(new THREE.Skeleton(bones));
  return { mesh, bones };
}

const placesOf = ({ mesh }) => Array.from({ length: mesh.geometry.attributes.position.count }, (_, v) => mesh.getVertexPosition(v, new THREE.Vector3()));

test('skins: rest, a rigid motion, and a bend', () => {
  const cage = tube();
  const fine = refineGeometry(cage, { tolerance: '0.1%' });
  const bare = cage.clone();
  bare.deleteAttribute('skinIndex').deleteAttribute('skinWeight');
  assert.deepEqual(refineGeometry(bare, { tolerance: '0.1%' }).attributes.position.array, fine.attributes.position.array);
  const { skinIndex, skinWeight, position } = fine.attributes;
  assert.ok(skinIndex.array instanceof Uint16Array);
  for (let v = 0; v < skinWeight.count; v++) {
    assert.ok(Math.abs(skinWeight.getX(v) + skinWeight.getY(v) + skinWeight.getZ(v) + skinWeight.getW(v) - 1) < 1e-6);
  }
  const own = skinned(fine);
  placesOf(own).forEach((p, v) => assert.ok(p.distanceTo(point(position, v)) < 1e-5, 'bind pose'));
  // The whole skeleton moves: so do all points.
  own.bones[0].rotation.set(0.3, 0.2, 1);
  own.bones[0].position.set(1, 2, 3);
  own.mesh.updateMatrixWorld(true);
  own.mesh.skeleton.update();
  const rigid = new THREE.Matrix4().multiplyMatrices(own.bones[0].matrixWorld, new THREE.Matrix4().makeTranslation(0, 2, 0));
  placesOf(own).forEach((p, v) => assert.ok(p.distanceTo(point(position, v).applyMatrix4(rigid)) < 1e-5, 'rigid motion'));
  // Weights at a vertex are the limits of the cage's weights there, as if they were heights.
  const { positions, index, weights } = welded(cage);
  const raised = Float64Array.from(positions, (x, i) => (i % 3 === 1 ? x + weights[(i - 1) / 3] : x));
  const [places, heights] = [positions, raised].map(own => limit(own, index, { weld: null }).positions);
  const at = nearestOf(position, places);
  weights.forEach((_, v) => {
    const joints = [skinIndex.getX(at[v]), skinIndex.getY(at[v])];
    const own = [skinWeight.getX(at[v]), skinWeight.getY(at[v])];
    const second = own.reduce((sum, weight, i) => sum + (joints[i] === 1 ? weight : 0), 0);
    assert.ok(Math.abs(second - (heights[3 * v + 1] - places[3 * v + 1])) < 1e-6);
  });
});

/** By place the vertex that is there. */
function nearestOf(position, places) {
  return Array.from({ length: places.length / 3 }, (_, row) => {
    const place = new THREE.Vector3().fromArray(places, 3 * row);
    const found = Array.from({ length: position.count }, (_, v) => v).find(v => point(position, v).distanceTo(place) < 1e-6);
    assert.ok(found !== undefined, 'each control vertex has its limit in the result');
    return found;
  });
}

const keyOf = p => p.toArray().map(x => Math.round(x * 1e4)).join();

/** Vertices by their places, by simple means. */
function welded({ index, attributes }) {
  const numbers = new Map();
  const [positions, weights, origins] = [[], [], []];
  const triangles = Array.from(index.array, v => {
    const p = point(attributes.position, v);
    if (!numbers.has(keyOf(p))) {
      numbers.set(keyOf(p), origins.length);
      origins.push(v);
      positions.push(...p.toArray());
      weights.push(attributes.skinWeight?.getY(v) ?? 0);
    }
    return numbers.get(keyOf(p));
  });
  return { positions: Float64Array.from(positions), index: Uint32Array.from(triangles), weights, origins };
}

function withTargets(isRelative) {
  const cage = new THREE.SphereGeometry(1, 12, 8);
  const base = cage.attributes.position;
  const target = make => {
    const own = new THREE.BufferAttribute(new Float32Array(3 * base.count), 3);
    for (let v = 0; v < base.count; v++) {
      const p = point(base, v);
      const d = make(p);
      own.setXYZ(v, ...(isRelative ? d : d.add(p)).toArray());
    }
    return own;
  };
  cage.morphAttributes.position = [target(p => new THREE.Vector3(p.x * 0.5, 0, Math.round(p.y * 8) / 8)), target(() => new THREE.Vector3(0, 0, 0)), target(p => new THREE.Vector3(0, p.y, 0))];
  cage.morphTargetsRelative = isRelative;
  return cage;
}

const morphed = (geometry, weights) => {
  const mesh = new THREE.Mesh(geometry, new THREE.MeshBasicMaterial());
  mesh.updateMorphTargets();
  mesh.morphTargetInfluences = weights;
  return placesOf({ mesh });
};

test('morph targets: the limit of base and target is that of the moved cage', () => {
  for (const isRelative of [true, false]) {
    const cage = withTargets(isRelative);
    const fine = refineGeometry(cage, { tolerance: '0.1%' });
    assert.equal(fine.morphTargetsRelative, isRelative);
    assert.equal(fine.morphAttributes.position.length, 3);
    assert.equal(fine.morphAttributes.normal.length, 3);
    assertWatertight(fine, 'morph');
    const { positions: rest, index, origins } = welded(cage);
    const start = limit(rest, index, { weld: null }).positions;
    const at = nearestOf(fine.attributes.position, start);
    for (const weights of [[0, 0, 0], [0.5, 0, 0], [1, 0, 0], [0.5, 1, 0.25]]) {
      const cagePlaces = morphed(cage, weights);
      const moved = Float64Array.from(origins.flatMap(v => cagePlaces[v].toArray()));
      const limits = limit(moved, index, { weld: null });
      const places = morphed(fine, weights);
      origins.forEach((_, v) => {
        assert.ok(places[at[v]].distanceTo(new THREE.Vector3().fromArray(limits.positions, 3 * v)) < 2e-6);
        if (weights[0] !== 1) return;
        // As the shader does it.
        const [normal, target] = [fine.attributes.normal, fine.morphAttributes.normal[0]].map(own => point(own, at[v]));
        normal.copy(isRelative ? normal.add(target) : target).normalize();
        const angle = normal.angleTo(new THREE.Vector3().fromArray(limits.normals, 3 * v));
        assert.ok(angle < 0.05, `the normal of the moved surface, ${angle}`);
      });
    }
  }
});

test('vertices that move apart stay apart', () => {
  const cage = new THREE.BufferGeometry();
  // Two squares side by side with vertices of their own, which a target draws apart.
  const positions = [[0, 0], [1, 0], [1, 1], [0, 1], [1, 0], [2, 0], [2, 1], [1, 1]].flatMap(([x, y]) => [x, y, 0]);
  cage.setAttribute('position', new THREE.Float32BufferAttribute(positions, 3)).setIndex([0, 1, 2, 0, 2, 3, 4, 5, 6, 4, 6, 7]);
  const joined = refineGeometry(cage, { boundary: 'fixed' });
  cage.morphAttributes.position = [new THREE.Float32BufferAttribute(positions.map((_, i) => (i >= 12 && i % 3 === 0 ? 1 : 0)), 3)];
  cage.morphTargetsRelative = true;
  const apart = refineGeometry(cage, { boundary: 'fixed' });
  assert.equal(joined.attributes.position.count, 6);
  assert.equal(apart.attributes.position.count, 8);
});

test('windings stay: skies are seen from within, and single faces as they were', () => {
  const sky = new THREE.SphereGeometry(1, 16, 12).scale(-1, 1, 1);
  sky.morphAttributes.position = [new THREE.BufferAttribute(sky.attributes.position.array.map(x => 0.5 * x), 3)];
  sky.morphTargetsRelative = true;
  const fine = refineGeometry(sky);
  assert.ok(volumeOf(sky) < -3 && volumeOf(fine) < -3);
  assertWatertight(fine, 'sky');
  assertNormalsAgree(fine);
  const change = fine.morphAttributes.normal[0];
  // What grows as a whole keeps its normals.
  assert.ok(change.array.every(x => Math.abs(x) < 1e-3));
  const mixed = new THREE.SphereGeometry(1, 16, 12);
  const turned = mixed.index.array.subarray(300, 303);
  turned.set([turned[0], turned[2], turned[1]]);
  const own = refineGeometry(mixed);
  assertNormalsAgree(own);
  const inwards = trianglesOf(own).filter(([a, b, c]) => b.clone().sub(a).cross(c.clone().sub(a)).dot(a) < 0);
  assert.ok(inwards.length > 1 && inwards.length < 30, `${inwards.length} triangles of the one that was turned`);
});

function trianglesOf({ index, attributes }) {
  return Array.from({ length: index.count / 3 }, (_, t) => [0, 1, 2].map(i => point(attributes.position, index.getX(3 * t + i))));
}

/** Normals look to the side that triangles are drawn on. */
function assertNormalsAgree(geometry) {
  trianglesOf(geometry).forEach(([a, b, c], t) => {
    const own = b.clone().sub(a).cross(c.clone().sub(a));
    for (let i = 0; i < 3; i++) assert.ok(own.dot(point(geometry.attributes.normal, geometry.index.getX(3 * t + i))) > 0);
  });
}

test('front and back of a leaf stay two', () => {
  const front = new THREE.PlaneGeometry(1, 1, 3, 3);
  const { position } = front.attributes;
  for (let v = 0; v < position.count; v++) position.setZ(v, 0.2 * Math.sin(4 * position.getX(v)) * position.getY(v));
  const single = refineGeometry(front);
  const back = front.clone();
  for (let corner = 0; corner < back.index.count; corner += 3) back.index.array.set([1, 0].map(i => front.index.array[corner + i]), corner);
  const both = refineGeometry(mergeGeometries([front, back]));
  assert.equal(both.index.count, 2 * single.index.count);
  const seen = sign => trianglesOf(both).filter(([a, b, c]) => sign * b.clone().sub(a).cross(c.clone().sub(a)).z > 0).length;
  assert.deepEqual([seen(1), seen(-1)], [single.index.count / 3, single.index.count / 3]);
  // Also where both name the same vertices.
  const shared = front.clone().setIndex([...front.index.array, ...back.index.array]);
  assert.equal(refineGeometry(shared).index.count, both.index.count);
});

test('the range that is drawn is refined', () => {
  const cage = mergeGeometries([new THREE.BoxGeometry(1, 1, 1, 2, 2, 2), new THREE.BoxGeometry(1, 1, 1, 2, 2, 2).translate(5, 0, 0)]);
  cage.setDrawRange(0, cage.index.count / 2);
  const fine = refineGeometry(cage);
  fine.computeBoundingBox();
  assert.ok(fine.boundingBox.max.x < 1);
  assertWatertight(fine, 'range');
  cage.setDrawRange(0, 4);
  assert.throws(() => refineGeometry(cage), { code: 'mesh', place: 'drawRange' });
});

test('a worker gives the same', async () => {
  const cage = new THREE.TorusKnotGeometry(1, 0.3, 48, 8);
  const [here, there] = [refineGeometry(cage), await refineGeometryAsync(cage)];
  assert.deepEqual(here.attributes.position.array, there.attributes.position.array);
  assert.deepEqual(here.index.array, there.index.array);
  await assert.rejects(refineGeometryAsync(cage, { signal: AbortSignal.abort(new Error('enough')) }), /enough/);
});

test('errors have a code and a place', () => {
  const cage = new THREE.SphereGeometry(1, 8, 6);
  const wrong = (change, expected, options) => {
    const own = cage.clone();
    const changed = change(own);
    const given = changed === undefined ? own : changed;
    assert.throws(() => refineGeometry(given, options), error => {
      assert.ok(error instanceof LimitmeshError, String(error.stack));
      for (const [name, value] of Object.entries(expected)) assert.match(error[name], value);
      return true;
    });
  };
  const mesh = /^mesh$/;
  wrong(() => new THREE.Points(cage), { code: mesh, message: /Points: it is its geometry/ });
  wrong(() => 7, { code: mesh, place: /^geometry$/ });
  wrong(() => null, { code: mesh, place: /^geometry$/ });
  wrong(() => new THREE.EdgesGeometry(cage), { code: mesh, message: /lines/ });
  wrong(() => new THREE.BufferGeometry(), { code: mesh, place: /position/ });
  wrong(() => new THREE.BufferGeometry().setFromPoints([new THREE.Vector3(), new THREE.Vector3(1, 0, 0)]), { code: mesh, message: /points and lines/ });
  wrong(own => void own.attributes.position.setX(3, NaN), { code: mesh, place: /attributes\.position\[3\]/ });
  wrong(own => void own.index.setX(5, 60_000), { code: mesh, place: /index\[5\]/ });
  wrong(own => void own.addGroup(1, 3), { code: mesh, place: /groups\[0\]/ });
  wrong(own => void own.setAttribute('uv', new THREE.Float32BufferAttribute([0, 0], 2)), { code: mesh, place: /attributes\.uv/ });
  wrong(() => {}, { code: /^option$/, place: /^weld$/ }, { weld: -1 });
  wrong(() => {}, { code: /^option$/, place: /^tolerance$/ }, { tolerance: 'x' });
  wrong(() => {}, { code: /^option$/, place: /^channels$/ }, { channels: [] });
  // And the next call works.
  assert.equal(refineGeometry(cage).userData.limitmesh.stop, 'met');
});
