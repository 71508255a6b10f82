/** Calls that no sane program makes: each ends in a result or in an error with code and place, and the next call works. */

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { test } from 'node:test';
import { LimitmeshError, limit, ready, refine } from 'limitmesh';
import { Engine } from '../dist/engine.js';

await ready;

const CODES = ['mesh', 'option', 'read', 'cancelled', 'memory', 'internal'];
const tetrahedron = {
  positions: new Float64Array([1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1]),
  index: new Uint32Array([0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2]),
};
const usual = refine(tetrahedron.positions, tetrahedron.index);

/** Numbers from 0 to 1 that are the same each time: xorshift. */
function seeded(seed) {
  let state = seed;
  return () => {
    state ^= state << 13;
    state ^= state >>> 17;
    state ^= state << 5;
    return (state >>> 0) / 2 ** 32;
  };
}

const random = seeded(52);
const below = n => Math.floor(random() * n);
const one = list => list[below(list.length)];

const odd = () => one([
  undefined, null, NaN, Infinity, -Infinity, 0, -0, -1, 0.5, 1, 3, 1e300, -1e300, 5e-324, 2 ** 31, 2 ** 32, 2 ** 53, '', 'auto', 'smooth', 'fixed', '1%',
  '-1%', 'NaN', '1e999', '0x10', 'catmull-clark', true, false, 1n, Symbol('a'), {}, [], [1], [[]], [[0, 1]], [[0, 1, -1]], () => true, () => false,
  new Date(), new Float32Array(3), new DataView(new ArrayBuffer(8)), new Map(), /a/, { length: 5 }, { positions: 1 },
]);

const NAMES = [
  'tolerance', 'triangles', 'angle', 'optimize', 'balance', 'flatRegions', 'channels', 'maxTriangles', 'maxLevels', 'maxMemory', 'faceSize', 'interpolate',
  'creaseAngle', 'creases', 'corners', 'boundary', 'concaveCorners', 'scheme', 'smoothTriangles', 'weld', 'repair', 'precision', 'onProgress', 'nonsense',
];

const sane = {
  tolerance: () => one(['1%', 0.05, '0.2%']), triangles: () => below(500) + 1, angle: () => 5 + below(90), optimize: () => random() < 0.5,
  balance: () => random() < 0.5, flatRegions: () => random() < 0.5, maxTriangles: () => 1 + below(2000), maxLevels: () => 1 + below(6),
  faceSize: () => one([3, 4]), interpolate: () => one([true, false, '1%']), creaseAngle: () => 1 + below(180), boundary: () => one(['smooth', 'corners', 'fixed']),
  scheme: () => one(['loop', 'loop-warren', 'butterfly', 'catmull-clark']), weld: () => one([0, null, 0.1, 10]), repair: () => random() < 0.8,
  creases: () => one(['auto', [[0, 1]], [[0, 1, 0.5], [1, 2, 3]], [[3, 3]]]), corners: () => one([[0], [[1, 2.5]], []]), precision: () => one(['f32', 'f64']),
  channels: () => [{ name: 'a', data: Array.from({ length: 8 }, odd), components: one([1, 2, 3, 0, 8]), index: one([null, [0, 1, 2, 3], [9]]),
    domain: one(['vertex', 'corner', 'face', 'edge', undefined]), semantic: one(['texture', 'label', 'other', 'colour', 'x']) }],
};

function options() {
  // So that no call takes long.
  const all = { tolerance: '3%', maxTriangles: 300 };
  for (let i = below(5); i > 0; i--) {
    const name = one(NAMES);
    all[name] = sane[name] && random() < 0.7 ? sane[name]() : odd();
  }
  if (!(typeof all.maxTriangles === 'number' && all.maxTriangles <= 2000)) Object.assign(all, { tolerance: '3%', angle: 30 });
  return all;
}

function positions() {
  if (random() < 0.1) return odd();
  const kind = one([Float64Array, Float32Array, Array, Int8Array]);
  const scale = one([1, 1, 1, 1e-30, 1e30, 1e300]);
  const vertices = one([0, 1, 3, 4, 5, 8, 12]);
  const values = Array.from({ length: 3 * vertices + (random() < 0.1 ? 1 : 0) }, () => Math.round((random() - 0.5) * 4) * scale);
  if (random() < 0.1) values[below(values.length)] = one([NaN, Infinity, 1e308]);
  return kind.from(values);
}

function index(count) {
  if (random() < 0.15) return odd();
  const kind = one([Uint32Array, Uint16Array, Array]);
  const corners = Array.from({ length: 3 * below(24) + (random() < 0.1 ? 1 : 0) }, () => below(count + (random() < 0.02 ? 2 : 0)));
  return kind.from(corners);
}

test('10,000 random calls end in results or in errors that name their place', () => {
  const seen = {};
  for (let call = 0; call < 10_000; call++) {
    const p = random() < 0.5 ? tetrahedron.positions : positions();
    const i = random() < 0.5 ? tetrahedron.index : index((p?.length ?? 0) / 3);
    const o = random() < 0.05 ? odd() : options();
    try {
      const found = random() < 0.9 ? refine(p, i, o) : limit(p, i, o);
      assert.ok(found.positions.length % 3 === 0);
      seen.result = (seen.result ?? 0) + 1;
    } catch (error) {
      assert.ok(error instanceof LimitmeshError, `${call}: ${error?.stack}`);
      assert.ok(CODES.includes(error.code) && error.place.length > 0 && error.message.length > 0);
      assert.notEqual(error.code, 'internal', `${call}: ${error.message}`);
      seen[error.code] = (seen[error.code] ?? 0) + 1;
    }
    if (call % 100 === 0) assert.deepEqual(refine(tetrahedron.positions, tetrahedron.index), usual);
  }
  assert.deepEqual(refine(tetrahedron.positions, tetrahedron.index), usual);
  // Each kind is met, so that this tests something.
  for (const kind of ['result', 'mesh', 'option']) assert.ok(seen[kind] > 100, JSON.stringify(seen));
});

test('where memory ends, the error says so, and the next call works', () => {
  const script = `
    import { ready, refine } from 'limitmesh';
    await ready;
    const positions = new Float64Array([1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1]), index = [0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2];
    const codes = [];
    for (let i = 0; i < 2; i++) {
      try { refine(positions, index, { tolerance: 1e-7, maxMemory: '3GB' }); } catch (error) { codes.push(error.code); }
      codes.push(refine(positions, index).stop);
    }
    try { refine(new Float64Array(2.7e7), null); } catch (error) { codes.push(error.code); }
    codes.push(refine(positions, index).stop);
    console.log(codes.join(' '));`;
  // Four hundred pages are 25 MiB.
  const words = ['--wasm-max-mem-pages=400', '--input-type=module', '--eval', script];
  const said = execFileSync(process.execPath, words, { cwd: import.meta.dirname, encoding: 'utf8' });
  assert.equal(said.trim(), 'memory met memory met memory met');
});

test('after a panic the message is told, and another instance does the next call', () => {
  let renewed = 0;
  const lost = new WebAssembly.RuntimeError('unreachable');
  const module = {};
  const glue = {
    initSync: () => ({ memory: { buffer: { byteLength: 0 } } }),
    __wbg_reset_state: () => renewed++,
    last_panic: () => 'panicked at row 7',
  };
  const engine = new Engine(glue);
  engine.start(module);
  const trap = () => engine.call(() => { throw lost; });
  assert.throws(trap, { code: 'internal', place: 'limitmesh', message: /panicked at row 7/ });
  assert.equal(renewed, 0, 'only when there is another call');
  assert.equal(engine.call(() => 5), 5);
  assert.equal(renewed, 1);
  glue.last_panic = () => 'panicked: capacity overflow';
  assert.throws(trap, { code: 'memory' });
  glue.last_panic = () => undefined;
  assert.throws(trap, { code: 'memory' });
  glue.last_panic = trap;
  assert.throws(() => engine.call(() => { throw new RangeError('Maximum call stack size exceeded'); }), { code: 'internal' });
});
