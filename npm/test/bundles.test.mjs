/** The package as others get it: a fresh tarball in an empty project, bundled, loaded by a page, in a worker. */

import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { createReadStream, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { createServer } from 'node:http';
import { tmpdir } from 'node:os';
import { extname, join } from 'node:path';
import { after, before, test } from 'node:test';
import { build as esbuild } from 'esbuild';
import { chromium } from 'playwright-core';
import { build as vite } from 'vite';

const CHROMIUM = process.env.CHROMIUM ?? '/usr/bin/chromium';
const npm = join(import.meta.dirname, '..');
const skip = existsSync(CHROMIUM) ? false : `there is no Chromium at ${CHROMIUM}`;

/** What each of them does: refines a tetrahedron here and in a worker, and says how many triangles there are. */
const MAIN = `
import { ready, refine, refineAsync } from 'limitmesh';
const positions = new Float32Array([1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1]);
const index = new Uint16Array([0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2]);
async function main() {
  await ready;
  const here = refine(positions, index).index.length / 3;
  const there = (await refineAsync(positions, index)).index.length / 3;
  return here + ' ' + there;
}
`;
const PAGE = `${MAIN}
main().then(said => (document.title = said), error => (document.title = error.stack));
`;
const SAID = '904 904';

let project, server, address, browser;

before(async () => {
  project = mkdtempSync(join(tmpdir(), 'limitmesh-'));
  const words = ['pack', '--silent', '--ignore-scripts', '--pack-destination', project];
  const tarball = execFileSync('npm', words, { cwd: npm, encoding: 'utf8' }).trim().split('\n').at(-1);
  writeFileSync(join(project, 'package.json'), JSON.stringify({ name: 'fresh', private: true, type: 'module' }));
  execFileSync('npm', ['install', '--silent', '--offline', '--no-audit', '--no-fund', join(project, tarball)], { cwd: project });
  writeFileSync(join(project, 'main.js'), PAGE);
  server = createServer(serve);
  await new Promise(resolve => server.listen(0, '127.0.0.1', resolve));
  address = `http://127.0.0.1:${server.address().port}`;
  if (!skip) browser = await chromium.launch({ executablePath: CHROMIUM, args: ['--headless', '--no-sandbox'] });
});

after(async () => {
  await browser?.close();
  server?.close();
  rmSync(project, { recursive: true, force: true });
});

const TYPES = { '.html': 'text/html', '.js': 'text/javascript', '.mjs': 'text/javascript', '.wasm': 'application/wasm' };

function serve(request, response) {
  const path = join(project, new URL(request.url, 'http://localhost').pathname);
  if (!existsSync(path)) return void response.writeHead(404).end();
  response.writeHead(200, { 'content-type': TYPES[extname(path)] ?? 'text/plain' });
  createReadStream(path).pipe(response);
}

/** What a page says, all requests that it made, and what its console said. */
async function shown(file, headers) {
  const page = await browser.newPage();
  const [requests, console] = [[], []];
  page.on('request', request => requests.push(request.url()));
  page.on('console', line => console.push(line.text()));
  page.on('pageerror', error => console.push(String(error)));
  if (headers) await page.route('**/*.html', async route => route.fulfill({ response: await route.fetch(), headers: { 'content-type': 'text/html', ...headers } }));
  await page.goto(`${address}/${file}`);
  await page.waitForFunction(() => document.title !== '', undefined, { timeout: 60_000 });
  const title = await page.title();
  await page.close();
  return { title, requests, console };
}

function write(file, text) {
  mkdirSync(join(project, file, '..'), { recursive: true });
  writeFileSync(join(project, file), text);
}

const html = script => `<!doctype html><meta charset="utf-8"><link rel="icon" href="data:,">${script}`;

test('an empty Node project: one package, and types', () => {
  const listed = readFileSync(join(project, 'package-lock.json'), 'utf8');
  assert.deepEqual(Object.keys(JSON.parse(listed).packages), ['', 'node_modules/limitmesh']);
  write('node.mjs', `${MAIN}\nconsole.log(await main());`);
  assert.equal(execFileSync(process.execPath, ['node.mjs'], { cwd: project, encoding: 'utf8' }).trim(), SAID);
  write('typed.ts', `import { refine, type Refined } from 'limitmesh';\nexport const found: Refined = refine([0], null, { tolerance: '1%' });\n`);
  const words = ['--noEmit', '--strict', '--module', 'nodenext', '--target', 'es2022', '--types', '', 'typed.ts'];
  execFileSync(process.execPath, [join(npm, 'node_modules/typescript/bin/tsc'), ...words], { cwd: project, stdio: 'inherit' });
});

test('bundled by esbuild', { skip }, async () => {
  await esbuild({
    absWorkingDir: project, entryPoints: ['main.js'], bundle: true, format: 'esm', outfile: 'esbuild/main.js', logLevel: 'error', minify: true,
  });
  write('esbuild/index.html', html('<script type="module" src="main.js"></script>'));
  const { title, requests, console } = await shown('esbuild/index.html');
  assert.equal(title, SAID);
  assert.deepEqual(console, []);
  // Nothing but the page, its script and the worker's text is loaded.
  assert.equal(requests.filter(url => url.startsWith(address)).length, 2);
  assert.ok(requests.every(url => url.startsWith(address) || /^(blob|data):/.test(url)), requests.join(' '));
});

test('bundled by Vite, without configuration', { skip }, async () => {
  write('vite/index.html', html('<script type="module" src="./main.js"></script>'));
  write('vite/main.js', PAGE);
  await vite({ root: join(project, 'vite'), configFile: false, logLevel: 'error', base: './', build: { outDir: '../vite-out', emptyOutDir: true } });
  const { title, console } = await shown('vite-out/index.html');
  assert.equal(title, SAID);
  assert.deepEqual(console, []);
});

test('a plain module script', { skip }, async () => {
  const map = JSON.stringify({ imports: { limitmesh: '/node_modules/limitmesh/dist/index.js' } });
  write('plain.html', html(`<script type="importmap">${map}</script><script type="module" src="main.js"></script>`));
  const { title, console } = await shown('plain.html');
  assert.equal(title, SAID);
  assert.deepEqual(console, []);
});

test('inside a worker of the page', { skip }, async () => {
  const code = `${MAIN}\nmain().then(said => postMessage(said), error => postMessage(error.stack));`;
  write('inside.js', code);
  await esbuild({ absWorkingDir: project, entryPoints: ['inside.js'], bundle: true, format: 'esm', outfile: 'inside/main.js', logLevel: 'error' });
  write('inside.html', html(`<script>new Worker('inside/main.js', { type: 'module' }).onmessage = event => (document.title = event.data)</script>`));
  const { title } = await shown('inside.html');
  assert.equal(title, SAID);
});

test('a page that forbids workers from texts gives its own, and one that forbids WebAssembly is told so', { skip }, async () => {
  write('strict.js', `
import { ready, refineAsync, LimitmeshError } from 'limitmesh';
const mesh = [new Float32Array([1, 1, 1, 1, -1, -1, -1, 1, -1, -1, -1, 1]), new Uint16Array([0, 1, 2, 0, 3, 1, 0, 2, 3, 1, 3, 2])];
const worker = new Worker('/node_modules/limitmesh/dist/worker.js', { type: 'module' });
const told = error => error instanceof LimitmeshError ? error.code + ' ' + error.place : String(error);
const first = await refineAsync(...mesh).then(() => 'worked', told);
const second = await refineAsync(...mesh, { worker }).then(found => found.index.length / 3, told);
document.title = first + ', ' + second;`);
  const map = JSON.stringify({ imports: { limitmesh: '/node_modules/limitmesh/dist/index.js' } });
  write('strict.html', html(`<script type="importmap">${map}</script><script type="module" src="strict.js"></script>`));
  const withWasm = await shown('strict.html', { 'content-security-policy': "script-src 'self' 'unsafe-inline' 'wasm-unsafe-eval'; worker-src 'self'" });
  assert.equal(withWasm.title, 'internal worker, 904');
  const without = await shown('strict.html', { 'content-security-policy': "script-src 'self' 'unsafe-inline'; worker-src 'self'" });
  assert.equal(without.title, 'internal WebAssembly, internal WebAssembly');
});
