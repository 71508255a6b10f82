/** The package gives the bytes that every processor gives: those of `golden/manifest.txt`, whose words are options of `refine`. */

import assert from 'node:assert/strict';
import { createHash } from 'node:crypto';
import { test } from 'node:test';
import { readFileSync } from 'node:fs';
import { ready, refine } from 'limitmesh';
import { modelOf } from './models.mjs';

const manifest = readFileSync(new URL('../../golden/manifest.txt', import.meta.url), 'utf8');
const lines = manifest.trim().split('\n').filter(line => line.includes(' scheme='));

await ready;

test('every model is refined to the bytes of the native library', () => {
  assert.equal(lines.length, 187);
  for (const line of lines) {
    const words = line.split(' ');
    const [name, triangles, hash] = [words[0], words.at(-2), words.at(-1)];
    const options = Object.fromEntries(words.slice(1, -2).map(word => word.split('=')).map(([key, value]) => [key, valueOf(value)]));
    const { positions, index, faceSize } = modelOf(name);
    const found = refine(positions, index, { ...options, faceSize, precision: 'f64' });
    assert.equal(found.index.length / 3, Number(triangles), line);
    const own = createHash('sha256').update(bytes(found.positions)).update(bytes(found.index)).digest('hex');
    assert.equal(own, hash, line);
  }
});

function valueOf(text) {
  if (text === 'true') return true;
  return Number.isNaN(Number(text)) ? text : Number(text);
}

function bytes(array) {
  return new Uint8Array(array.buffer, array.byteOffset, array.byteLength);
}
