/** Options have the same names and defaults here, in Python and in the program. */

import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { test } from 'node:test';
import { controlOf, FILE_OPTIONS, goalsOf, howOf, MEASURE_OPTIONS, REFINE_OPTIONS } from '../dist/options.js';

const root = new URL('../../', import.meta.url);
const text = path => readFileSync(new URL(path, root), 'utf8');

/** Our name, Python's, its default there, and the program's option; null where there is none. */
const TABLE = [
  ['tolerance', 'tolerance', 'None', 'tolerance'],
  ['triangles', 'triangles', 'None', 'triangles'],
  ['angle', 'angle', 'None', 'angle'],
  ['optimize', 'optimize', 'False', 'optimize'],
  ['balance', 'balance', 'False', 'balance'],
  ['flatRegions', 'flat_regions', 'True', 'divide_flat'],
  ['channels', 'channels', 'None', null],
  ['maxTriangles', 'max_triangles', 'None', 'max_triangles'],
  // The program's --levels is both this and the steps of other methods.
  ['maxLevels', 'max_levels', 'None', 'levels'],
  // A browser does not say how much memory there is.
  ['maxMemory', 'max_memory', '"50%"', 'max_memory'],
  // Python's faces say how many corners they have.
  ['faceSize', null, null, null],
  ['interpolate', 'interpolate', 'None', 'interpolate'],
  ['creaseAngle', 'crease_angle', 'None', 'crease_angle'],
  ['creases', 'creases', 'None', null],
  ['corners', 'corners', 'None', null],
  ['boundary', 'boundary', '"smooth"', 'boundary'],
  ['concaveCorners', 'concave_corners', 'None', 'concave_corners'],
  ['scheme', 'scheme', 'None', 'scheme'],
  ['smoothTriangles', 'smooth_triangles', 'False', 'smooth_triangles'],
  ['weld', 'weld', '0.0', 'weld'],
  ['repair', 'repair', 'True', 'strict'],
  // JavaScript has arrays of both; what Python gives is of 64 bits.
  ['precision', null, null, null],
  ['onProgress', 'progress', 'None', null],
];

/** Defaults of a function's keyword arguments in Python. */
function defaultsOf(path, name) {
  const source = text(path);
  const start = source.indexOf(`def ${name}(`);
  const signature = source.slice(start, source.indexOf(') ->', start));
  return Object.fromEntries([...signature.matchAll(/^ {4}(\w+): [^=\n]+ = (.+),$/gm)].map(([, own, value]) => [own, value]));
}

test('every option of refine is in the table, and Python has it with the same default', () => {
  assert.deepEqual([...REFINE_OPTIONS].sort(), TABLE.map(([own]) => own).sort());
  const python = defaultsOf('crates/python/python/limitmesh/_refine.py', 'refine');
  for (const [own, theirs, usual] of TABLE) {
    if (theirs !== null) assert.equal(python[theirs], usual, own);
  }
});

test('the program has those of files under the same names', () => {
  const folder = 'crates/cli/src/arguments/';
  const files = ['refine', 'exact', 'features', 'interpolation', 'shared'].map(name => text(`${folder}${name}.rs`)).join('\n');
  for (const [own, , , option] of TABLE) {
    if (option === null || !FILE_OPTIONS.includes(own)) continue;
    assert.ok(new RegExp(`^    (pub\\(crate\\) )?${option}: `, 'm').test(files), own);
  }
});

test('options that are left out are what the table says', () => {
  const control = controlOf({});
  assert.deepEqual(control, {
    weld: 0, repair: true, boundary: 'smooth', creaseAngle: undefined, autoCreases: false, leadsParts: false, dividesConcaveCorners: false,
    interpolate: undefined, scheme: 'loop', smoothTriangles: false,
  });
  assert.equal(controlOf({ faceSize: 4 }).scheme, 'catmull-clark');
  for (const divided of [{ creaseAngle: 30 }, { creases: 'auto' }, { boundary: 'fixed' }]) {
    assert.equal(controlOf(divided).dividesConcaveCorners, true);
  }
  assert.deepEqual(goalsOf({}, true, control), {
    tolerance: { amount: 0.001, isPart: true }, triangles: undefined, angle: undefined, optimize: false, balance: false, flatRegions: true,
    maxTriangles: undefined, maxLevels: undefined, maxMemory: 2 ** 30, isSingle: true,
  });
  assert.equal(goalsOf({ triangles: '20k' }, true, control).tolerance, undefined);
});

test('measure has the options of Python', () => {
  const python = defaultsOf('crates/python/python/limitmesh/_measure.py', 'measure');
  const camel = name => name.replace(/_(\w)/g, (_, letter) => letter.toUpperCase());
  const theirs = Object.keys(python).filter(name => !['b', 'threads', 'progress'].includes(name)).map(camel);
  const ours = MEASURE_OPTIONS.filter(name => !['faceSize', 'repair', 'onProgress'].includes(name));
  assert.deepEqual([...ours].sort(), theirs.sort());
  assert.equal(howOf({}).samples, Number(python.samples.replace('_', '')));
});
