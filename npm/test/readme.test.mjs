/** The examples of the README are what TypeScript takes as they stand, and arrays of results fit where browsers want plain buffers. */

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { join } from 'node:path';
import { after, test } from 'node:test';
import { pathToFileURL } from 'node:url';

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

/** What the examples need of Node. */
const NODE = `
declare module 'node:fs/promises' {
  export function readFile(name: string): Promise<Uint8Array>;
  export function writeFile(name: string, bytes: Uint8Array): Promise<void>;
}
`;

const RESULTS = `
import { refine, refineFile, type Refined } from 'limitmesh';
export async function blobOf(bytes: Uint8Array): Promise<Blob> {
  return new Blob([(await refineFile(bytes, 'obj', 'glb')).bytes]);
}
export const blob = (found: Refined) => new Blob([found.positions, found.index, found.normals, found.parents, found.sides.corners]);
`;

/** React as far as the hook needs it: state, and effects whose clean-up runs when what they depend on changes, and at the end. */
const REACT = `
const cells = [];
let next = 0;
const pending = [];
export function useState(first) {
  const cell = (cells[next++] ??= { value: first });
  return [cell.value, value => { cell.value = value; }];
}
export function useEffect(effect, on) {
  const cell = (cells[next++] ??= {});
  if (cell.on?.every((own, i) => Object.is(own, on[i]))) return;
  pending.push(() => { cell.cleanUp?.(); cell.cleanUp = effect(); });
  cell.on = on;
}
export function render(hook) {
  next = 0;
  const shown = hook();
  pending.splice(0).forEach(run => run());
  return shown;
}
export const unmount = () => cells.forEach(cell => cell.cleanUp?.());
`;

test('the hook frees what it made once it is not shown, and never what it was given', async () => {
  const [, hook] = /^```jsx\n(.*?)^```$/ms.exec(readFileSync(join(npm, 'README.md'), 'utf8'));
  writeFileSync(join(folder, 'react.mjs'), REACT);
  writeFileSync(join(folder, 'three.mjs'), 'export const refineGeometryAsync = async (from, { tolerance }) => from.refined(tolerance);\n');
  writeFileSync(join(folder, 'hook.mjs'), hook.replace("'react'", "'./react.mjs'").replace("'limitmesh/three'", "'./three.mjs'"));
  const { useRefined } = await import(pathToFileURL(join(folder, 'hook.mjs')));
  const { render, unmount } = await import(pathToFileURL(join(folder, 'react.mjs')));
  const disposed = [];
  const named = name => ({ name, dispose: () => disposed.push(name), refined: tolerance => named(`${name} at ${tolerance}`) });
  const [a, b] = [named('a'), named('b')];
  const show = async (geometry, tolerance) => {
    render(() => useRefined(geometry, { tolerance }));
    await new Promise(resolve => setTimeout(resolve));
    return render(() => useRefined(geometry, { tolerance })).name;
  };
  assert.equal(render(() => useRefined(a, { tolerance: 1 })), a, 'until there is a finer one');
  assert.equal(await show(a, 1), 'a at 1');
  assert.equal(await show(a, 2), 'a at 2');
  assert.deepEqual(disposed, ['a at 1']);
  assert.equal(await show(b, 2), 'b at 2');
  assert.deepEqual(disposed, ['a at 1', 'a at 2']);
  unmount();
  assert.deepEqual(disposed, ['a at 1', 'a at 2', 'b at 2']);
});

test('examples compile strictly', () => {
  const readme = readFileSync(join(npm, 'README.md'), 'utf8');
  const blocks = [...readme.matchAll(/^```js\n(.*?)^```$/gms)].map(([, block]) => block);
  assert.ok(blocks.length >= 5);
  const texts = { 'globals.d.ts': GLOBALS, 'node.d.ts': NODE, 'results.ts': RESULTS };
  blocks.forEach((block, i) => (texts[`example${i}.ts`] = `${block}\nexport {};\n`));
  for (const [name, text] of Object.entries(texts)) writeFileSync(join(folder, name), text);
  const words = ['--ignoreConfig', '--noEmit', '--strict', '--skipLibCheck', '--module', 'nodenext', '--target', 'es2022', '--types', '', ...Object.keys(texts)];
  const { stdout, status } = spawnSync(process.execPath, [join(npm, 'node_modules/typescript/bin/tsc'), ...words], { cwd: folder, encoding: 'utf8' });
  assert.equal(status, 0, stdout);
});
