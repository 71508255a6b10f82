/** The examples of the README are what TypeScript takes as they stand, and arrays of results fit where browsers want plain buffers. */

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';

const npm = join(import.meta.dirname, '..');
// Within the package, which finds itself by its name from here.
const folder = mkdtempSync(join(npm, 'readme-'));
after(() => rmSync(folder, { recursive: true, force: true }));

/** What the examples leave to the reader: meshes, and imports that an example before has. */
const GLOBALS = `
import type * as limitmesh from 'limitmesh';
declare global {
  const positions: Float32Array, index: Uint32Array, uvs: Float32Array;
  const mesh: import('three').Mesh;
  const refine: typeof limitmesh.refine;
  const refineAsync: typeof limitmesh.refineAsync;
}
`;

const RESULTS = `
import { refine, refineFile, type Refined } from 'limitmesh';
export async function blobOf(bytes: Uint8Array): Promise<Blob> {
  return new Blob([(await refineFile(bytes, 'obj', 'glb')).bytes]);
}
export const blob = (found: Refined) => new Blob([found.positions, found.index, found.normals, found.parents, found.sides.corners]);
`;

test('examples compile strictly', () => {
  const readme = readFileSync(join(npm, 'README.md'), 'utf8');
  const blocks = [...readme.matchAll(/^```js\n(.*?)^```$/gms)].map(([, block]) => block);
  assert.ok(blocks.length >= 5);
  const texts = { 'globals.d.ts': GLOBALS, 'results.ts': RESULTS };
  blocks.forEach((block, i) => (texts[`example${i}.ts`] = `${block}\nexport {};\n`));
  for (const [name, text] of Object.entries(texts)) writeFileSync(join(folder, name), text);
  const words = ['--noEmit', '--strict', '--skipLibCheck', '--module', 'nodenext', '--target', 'es2022', '--types', '', ...Object.keys(texts)];
  const { stdout, status } = spawnSync(process.execPath, [join(npm, 'node_modules/typescript/bin/tsc'), ...words], { cwd: folder, encoding: 'utf8' });
  assert.equal(status, 0, stdout);
});
