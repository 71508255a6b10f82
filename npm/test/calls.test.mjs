/** What calls give: shapes of results, defaults, channels, progress, cancelling, workers. */

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { LimitmeshError, limit, measure, measureAsync, ready, refine, refineAsync, supported } from 'limitmesh';
import { modelOf, torusKnot } from './models.mjs';

await ready;

const knot = torusKnot();

/** A cube of 1 with its corners at 0 and 1: eight vertices, twelve triangles. */
const cube = {
  positions: Float64Array.from({ length: 24 }, (_, i) => (Math.floor(i / 3) >> i % 3) & 1),
  index: [0, 2, 1, 1, 2, 3, 4, 5, 6, 5, 7, 6, 0, 1, 4, 1, 5, 4, 2, 6, 3, 3, 6, 7, 0, 4, 2, 2, 4, 6, 1, 3, 5, 3, 7, 5],
};

test('the torus knot has the triangles of three.js, closed and within the tolerance', () => {
  assert.equal(supported, true);
  assert.equal(knot.index.length, 3 * 2048);
  const found = refine(knot.positions, knot.index);
  assert.equal(found.stop, 'met');
  assert.ok(found.error.certified);
  const diagonal = diagonalOf(knot.positions);
  assert.ok(found.error.upper <= 0.001 * diagonal, 'without a goal the tolerance is 0.1 %');
  assert.ok(found.positions instanceof Float32Array && found.normals instanceof Float32Array);
  assert.equal(found.normals.length, found.positions.length);
  assert.equal(found.parents.length, found.index.length / 3);
  assert.ok(found.parents.every(face => face < 2048));
  assert.equal(found.sides.corners.length, 0);
  assert.equal(openEdges(found.index), 0);
  const distance = measure(found, null, { limitOf: knot, certified: true });
  assert.ok(distance.certified && distance.lower <= found.error.upper && distance.upper >= found.error.lower);
  assert.ok(found.normals.every(Number.isFinite));
});

test('positions are of the precision of the input or of that asked for, and bounds hold for them', () => {
  const double = refine(Float64Array.from(knot.positions), knot.index);
  assert.ok(double.positions instanceof Float64Array);
  const single = refine(Float64Array.from(knot.positions), knot.index, { precision: 'f32' });
  assert.deepEqual(single.positions, Float32Array.from(double.positions));
  assert.ok(single.error.upper > double.error.upper && single.error.lower < double.error.lower);
});

test('triangles without an index are welded to the same mesh', () => {
  const soup = Float64Array.from([...cube.index].flatMap(v => [...cube.positions.subarray(3 * v, 3 * v + 3)]));
  const [welded, indexed] = [refine(soup, null), refine(cube.positions, cube.index)];
  assert.equal(welded.index.length, indexed.index.length);
  assert.equal(openEdges(welded.index), 0);
});

test('quads are refined by Catmull and Clark, and their parents are the quads', () => {
  const quads = [0, 2, 3, 1, 4, 5, 7, 6, 0, 1, 5, 4, 2, 6, 7, 3, 0, 4, 6, 2, 1, 3, 7, 5];
  const found = refine(cube.positions, quads, { faceSize: 4, tolerance: '1%' });
  assert.equal(openEdges(found.index), 0);
  assert.deepEqual([...new Set(found.parents)].sort(), [0, 1, 2, 3, 4, 5]);
  // The limit of a corner of the cube: 9 parts of the corner, 4 of each neighbour, 1 of each diagonal of a face, for three faces.
  const weights = 9 / 24, [own, edge, face] = [weights, 4 / 24, 1 / 24];
  const expected = 3 * 0 * own + edge * 1 + face * 2;
  const corner = limit(cube.positions, quads, { faceSize: 4 }).positions.slice(0, 3);
  corner.forEach(x => assert.ok(Math.abs(x - expected) < 1e-12, `${x} is not ${expected}`));
});

test('a sharp cube stays a cube, with a normal for each side of its edges', () => {
  const found = refine(cube.positions, cube.index, { creaseAngle: 30, flatRegions: false });
  assert.equal(found.creaseAngle, 30);
  assert.ok(found.error.upper < 1e-9);
  assert.ok(found.sides.corners.length > 0 && found.sides.normals.length === 3 * found.sides.corners.length);
  const auto = refine(cube.positions, cube.index, { creases: 'auto' });
  assert.ok(auto.creaseAngle === null || auto.creaseAngle > 0);
  const tagged = refine(cube.positions, cube.index, { creases: [[0, 1]], corners: [0, [1, 2]] });
  assert.ok(tagged.sides.corners.length > 0);
});

test('the surface passes through the vertices if asked', () => {
  const { positions } = limit(cube.positions, cube.index, { interpolate: true });
  positions.forEach((x, i) => assert.ok(Math.abs(x - cube.positions[i]) < 1e-9));
});

test('channels are carried along: a linear one is that of the places', () => {
  const data = Float32Array.from(cube.index.flatMap(v => [...cube.positions.subarray(3 * v, 3 * v + 3)]));
  const byCorner = { name: 'place', data, components: 3, domain: 'corner', semantic: 'texture' };
  const byVertex = { name: 'x', data: cube.positions.filter((_, i) => i % 3 === 0), components: 1 };
  const byFace = { name: 'material', data: Uint8Array.from({ length: 12 }, (_, i) => i % 2), components: 1, domain: 'face', semantic: 'label' };
  const found = refine(cube.positions, cube.index, { tolerance: '1%', channels: [byCorner, byVertex, byFace] });
  assert.deepEqual(found.channels.map(own => own.name), ['place', 'x', 'material']);
  const [place, x, material] = found.channels;
  assert.equal(place.domain, 'corner');
  assert.equal(place.index.length, found.index.length);
  assert.ok(place.data instanceof Float64Array);
  // Texture coordinates that are the positions, refined by the same rules, are the positions of the result.
  const greatest = Math.max(...Array.from(place.index, (row, corner) => {
    const v = found.index[corner];
    return Math.hypot(...[0, 1, 2].map(k => place.data[3 * row + k] - found.positions[3 * v + k]));
  }));
  assert.ok(greatest < 1e-9, `${greatest}`);
  assert.ok(x.data.every(value => value >= 0 && value <= 1));
  assert.equal(material.domain, 'face');
  found.parents.forEach((face, triangle) => assert.equal(material.data[material.index[triangle]], face % 2));
});

test('goals and caps end a refinement as they say', () => {
  assert.ok(refine(knot.positions, knot.index, { triangles: '5k' }).index.length <= 15_000);
  const capped = refine(knot.positions, knot.index, { tolerance: '0.001%', maxTriangles: 10_000 });
  assert.equal(capped.stop, 'triangle-cap');
  assert.equal(refine(knot.positions, knot.index, { tolerance: '0.001%', maxMemory: '2MB' }).stop, 'memory-cap');
  assert.equal(refine(knot.positions, knot.index, { tolerance: '0.001%', maxLevels: 1 }).stop, 'level-cap');
  const bent = refine(knot.positions, knot.index, { angle: 20 });
  assert.ok(bent.index.length > 0 && bent.stop === 'met');
  const few = refine(knot.positions, knot.index, { optimize: true });
  assert.ok(few.index.length < refine(knot.positions, knot.index).index.length);
});

test('a tolerance that rounding to 32 bits spoils is not met, and others leave room for it', () => {
  const diagonal = diagonalOf(knot.positions);
  for (const part of [3e-4, 1e-4, 7e-5]) {
    const { stop, error } = refine(knot.positions, knot.index, { tolerance: part * diagonal });
    assert.equal(stop, 'met');
    assert.ok(error.upper <= part * diagonal, `${error.upper} ${part * diagonal}`);
  }
  const tolerance = 2e-7;
  const far = Float64Array.from(cube.positions, x => x + 10);
  const options = { tolerance, maxLevels: 12, maxTriangles: 20_000, creaseAngle: 30 };
  const double = refine(far, cube.index, options);
  assert.equal(double.stop, 'met');
  assert.ok(double.error.upper <= tolerance);
  // A third of a step of 32-bit numbers near 10 to 11.
  const between = Float64Array.from(far, x => x + 2 ** -20 / 3);
  const single = refine(between, cube.index, { ...options, precision: 'f32' });
  assert.ok(single.error.upper > tolerance);
  assert.equal(single.stop, 'rounding');
  const wide = refine(between, cube.index, { ...options, tolerance: 1e-5, precision: 'f32' });
  assert.ok(wide.error.upper <= 1e-5 && wide.stop === 'met');
});

test('what onProgress throws is thrown again, and false cancels', async () => {
  const sum = new RangeError('mine');
  const raise = () => { throw sum; };
  assert.throws(() => refine(knot.positions, knot.index, { onProgress: raise }), error => error === sum);
  await assert.rejects(refineAsync(knot.positions, knot.index, { onProgress: raise }), error => error === sum);
  const stop = { onProgress: () => false };
  assert.throws(() => refine(knot.positions, knot.index, stop), { code: 'cancelled', place: 'onProgress' });
  await assert.rejects(refineAsync(knot.positions, knot.index, stop), { code: 'cancelled', place: 'onProgress' });
  const heard = [];
  refine(knot.positions, knot.index, { tolerance: '0.005%', onProgress: at => void heard.push(at) });
  assert.ok(heard.length > 0 && heard.every(at => typeof at.stage === 'string' && at.done >= 0 && at.triangles >= 0));
});

test('a worker gives the same as a call here, leaves the arrays alone, and several work at once', async () => {
  const here = refine(knot.positions, knot.index);
  const all = await Promise.all([1, 2, 3].map(() => refineAsync(knot.positions, knot.index)));
  for (const found of all) assert.deepEqual(found, here);
  assert.equal(knot.positions.length, 3 * 1024);
  const a = await measureAsync(here, null, { limitOf: knot });
  assert.deepEqual(a, measure(here, null, { limitOf: knot }));
});

test('a signal ends a call at once, with its reason, and the next one works', async () => {
  const { positions, index } = modelOf('head');
  const controller = new AbortController();
  const long = { tolerance: '0.0001%', maxMemory: '3GB', signal: controller.signal };
  const reason = new Error('the reader has gone on');
  setTimeout(() => controller.abort(reason), 200);
  const start = performance.now();
  await assert.rejects(refineAsync(positions, index, long), error => error === reason);
  assert.ok(performance.now() - start < 1000, 'at once');
  await assert.rejects(refineAsync(positions, index, { signal: AbortSignal.abort(reason) }), error => error === reason);
  assert.equal((await refineAsync(positions, index)).stop, 'met');
});

test('workers of other kinds are refused', async () => {
  const worker = { postMessage() {} };
  await assert.rejects(refineAsync(cube.positions, cube.index, { worker }), { code: 'option', place: 'worker' });
});

test('errors name who is at fault and where', async () => {
  const { positions, index } = cube;
  const off = Float64Array.from(positions);
  off[4] = NaN;
  const cases = [
    [[positions.subarray(1), index], 'mesh', 'positions'],
    [[off, index], 'mesh', 'positions[4]'],
    [[[[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2]], 'mesh', 'positions[0]'],
    [[[0, 0, '0'], [0, 1, 2]], 'mesh', 'positions[2]'],
    [[positions.subarray(0, 12), null], 'mesh', 'positions'],
    [[positions, [0, 1, 8]], 'mesh', 'index[2]'],
    [[positions, [0, 1]], 'mesh', 'index'],
    [[positions, [0, 1, -2]], 'mesh', 'index[2]'],
    [['positions', index], 'mesh', 'positions'],
    [[positions, []], 'mesh', 'index'],
    [[positions, index, { tolerance: -1 }], 'option', 'tolerance'],
    [[positions, index, { tolerance: '1 mm' }], 'option', 'tolerance'],
    [[positions, index, { tolerence: 1 }], 'option', 'tolerence'],
    [[positions, index, { scheme: 'sqrt3' }], 'option', 'scheme'],
    [[positions, index, { creases: [[0, 9]] }], 'option', 'creases[0]'],
    [[positions, index, { maxMemory: '5GB' }], 'option', 'maxMemory'],
    [[positions, index, { channels: [{ name: 'a', data: [1, 2], components: 1 }] }], 'option', 'channels[0].data'],
    [[positions, index, { signal: new AbortController().signal }], 'option', 'signal'],
  ];
  for (const [given, code, place] of cases) {
    assert.throws(() => refine(...given), error => {
      assert.ok(error instanceof LimitmeshError && error instanceof Error);
      assert.deepEqual([error.code, error.place], [code, place], error.message);
      return error.message.length > 10;
    });
    const [p, i, o] = given;
    if (place !== 'signal') await assert.rejects(refineAsync(p, i, o), { name: 'LimitmeshError', code, place });
  }
});

test('errors say what was given, where else it goes, and in which mesh it is', () => {
  const { positions, index } = cube;
  const message = /^positions\[0\] is \[0,0,0\], expected a number$/;
  assert.throws(() => refine([[0, 0, 0], [1, 0, 0], [0, 1, 0]], [0, 1, 2]), { message });
  assert.throws(() => refine(positions, index, { signal: new AbortController().signal }), { place: 'signal', message: /refineAsync/ });
  const bad = { positions, index: [0, 1, 8] };
  assert.throws(() => measure(cube, bad), { code: 'mesh', place: 'b.index[2]', message: /^b\.index\[2\] names vertex 8/ });
  assert.throws(() => measure(bad, cube), { code: 'mesh', place: 'a.index[2]' });
  assert.throws(() => measure(cube, null, { limitOf: bad }), { code: 'mesh', place: 'limitOf.index[2]' });
});

function diagonalOf(positions) {
  const along = axis => positions.filter((_, i) => i % 3 === axis);
  return Math.hypot(...[0, 1, 2].map(axis => Math.max(...along(axis)) - Math.min(...along(axis))));
}

/** Edges of one triangle only. */
function openEdges(index) {
  const open = new Set();
  for (let i = 0; i < index.length; i++) {
    const [a, b] = [index[i], index[i % 3 === 2 ? i - 2 : i + 1]];
    if (!open.delete(`${b} ${a}`)) open.add(`${a} ${b}`);
  }
  return open.size;
}
