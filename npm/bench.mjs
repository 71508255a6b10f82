/**
 * The figures of the README, beside three-subdivide, in one run: `node bench.mjs [FOLDER]`, where FOLDER has bunny_3674.obj.
 *
 * Seconds are those of the processor, the least of several calls; the first call is told apart, as it warms the engine up. In Chromium, where
 * there is one, they are those of the clock.
 */

import { existsSync, readFileSync } from 'node:fs';
import { join } from 'node:path';
import { createServer } from 'node:http';
import { brotliCompressSync } from 'node:zlib';
import { chromium } from 'playwright-core';
import { BufferAttribute, BufferGeometry } from 'three';
import { LoopSubdivision } from 'three-subdivide';
import { measure, ready, refine } from 'limitmesh';
import { torusKnot } from './test/models.mjs';

const CALLS = 5;

/** Seconds of the first call and of the quickest, and its result. */
function timed(work) {
  const all = [];
  let result;
  for (let i = 0; i < CALLS; i++) {
    const before = process.cpuUsage();
    result = work();
    const { user, system } = process.cpuUsage(before);
    all.push((user + system) / 1e6);
  }
  return { first: all[0], least: Math.min(...all), result };
}

/** Positions and triangles of an OBJ file. */
function objOf(path) {
  const lines = readFileSync(path, 'utf8').split('\n').map(line => line.trim().split(/\s+/));
  const positions = lines.filter(([kind]) => kind === 'v').flatMap(([, ...xyz]) => xyz.slice(0, 3).map(Number));
  const index = lines.filter(([kind]) => kind === 'f').flatMap(([, ...corners]) => corners.slice(0, 3).map(word => parseInt(word) - 1));
  return { positions: Float32Array.from(positions), index: Uint32Array.from(index) };
}

function subdivided({ positions, index }, levels) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(positions, 3));
  geometry.setIndex(new BufferAttribute(index, 1));
  return LoopSubdivision.modify(geometry, levels, { split: false, maxTriangles: Infinity });
}

function diagonalOf(positions) {
  const along = axis => positions.filter((_, i) => i % 3 === axis);
  return Math.hypot(...[0, 1, 2].map(axis => along(axis).reduce((a, b) => Math.max(a, b)) - along(axis).reduce((a, b) => Math.min(a, b))));
}

const percent = (length, mesh) => `${((100 * length) / diagonalOf(mesh.positions)).toFixed(4)} %`;
const line = (name, triangles, { first, least }, distance) =>
  console.log(`${name}: ${triangles} triangles, ${least.toFixed(3)} s (first call ${first.toFixed(3)} s), ${distance}`);

const start = performance.now();
await ready;
console.log(`ready after ${(performance.now() - start).toFixed(0)} ms`);
const wasm = readFileSync(new URL('dist/limitmesh.wasm', import.meta.url));
console.log(`module: ${wasm.length} bytes, ${brotliCompressSync(wasm).length} by brotli`);

const bunny = join(process.argv[2] ?? '../../shared/models', 'bunny_3674.obj');
const meshes = { 'torus knot': [torusKnot(), 3] };
if (existsSync(bunny)) meshes.bunny_3674 = [objOf(bunny), 2];
else console.log(`skipped: there is no ${bunny}`);

for (const [name, [mesh, levels]] of Object.entries(meshes)) {
  const theirs = timed(() => subdivided(mesh, levels));
  const positions = theirs.result.getAttribute('position').array;
  const { lower } = measure({ positions }, null, { limitOf: mesh, samples: 20_000 });
  line(`${name}, three-subdivide ${levels} levels`, positions.length / 9, theirs, `at least ${percent(lower, mesh)} away, sampled`);
  for (const tolerance of ['0.1%', '0.01%', lower]) {
    const own = timed(() => refine(mesh.positions, mesh.index, { tolerance }));
    const title = tolerance === lower ? `no farther, ${(theirs.least / own.least).toFixed(1)} times as fast` : tolerance;
    line(`${name}, limitmesh ${title}`, own.result.index.length / 3, own, `within ${percent(own.result.error.upper, mesh)}`);
  }
}

await inChromium();

/** The same calls on a page. */
async function inChromium() {
  const executablePath = process.env.CHROMIUM ?? '/usr/bin/chromium';
  if (!existsSync(executablePath)) return console.log(`skipped: there is no Chromium at ${executablePath}`);
  const server = createServer((request, response) => {
    const isPage = request.url === '/';
    response.writeHead(200, { 'content-type': isPage ? 'text/html' : 'text/javascript' });
    response.end(isPage ? '<link rel="icon" href="data:,">' : readFileSync(new URL(`.${request.url}`, import.meta.url)));
  });
  await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
  const browser = await chromium.launch({ executablePath, args: ['--headless', '--no-sandbox'] });
  const page = await browser.newPage();
  await page.goto(`http://127.0.0.1:${server.address().port}/`);
  for (const [name, [{ positions, index }]] of Object.entries(meshes)) {
    const given = { positions: [...positions], index: [...index], calls: CALLS };
    const seconds = await page.evaluate(async ({ positions, index, calls }) => {
      const { ready, refine } = await import('/dist/index.js');
      await ready;
      const [p, i] = [Float32Array.from(positions), Uint32Array.from(index)];
      return Array.from({ length: calls }, () => {
        const start = performance.now();
        refine(p, i);
        return (performance.now() - start) / 1000;
      });
    }, given);
    console.log(`${name}, limitmesh 0.1% in Chromium: ${Math.min(...seconds).toFixed(3)} s (first call ${seconds[0].toFixed(3)} s)`);
  }
  await browser.close();
  server.close();
}
