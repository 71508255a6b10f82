/** The package gives the bytes that the native library gives, for all built-in models and three goals. */

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { test } from 'node:test';
import { readFileSync } from 'node:fs';
import { ready, refine } from 'limitmesh';
import { modelOf } from './models.mjs';

const lines = readFileSync(new URL('same-bytes.txt', import.meta.url), 'utf8').trim().split('\n');

await ready;

test('every model is refined to the bytes of the native library', () => {
  assert.equal(lines.length, 51);
  for (const line of lines) {
    const [name, tolerance, triangles, hash] = line.split(' ');
    const { positions, index, faceSize } = modelOf(name);
    const found = refine(positions, index, { tolerance, faceSize, scheme: 'loop', precision: 'f64' });
    assert.equal(found.index.length / 3, Number(triangles), line);
    const own = createHash('sha256').update(bytes(found.positions)).update(bytes(found.index)).digest('hex');
    assert.equal(own, hash, line);
  }
});

function bytes(array) {
  return new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
}
