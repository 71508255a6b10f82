/**
 * Builds the package: cargo, the JavaScript beside the modules, modules as texts, types, and with --pack the tarball, which needs python3.
 *
 *   node build.mjs [--profile wasm|wasm-quick] [--pack]
 *
 * The profile `wasm-quick` builds in a third of the time; the module is larger and slower, and its results are the same bytes.
 */

import { execFileSync } from 'node:child_process';
import { copyFileSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { homedir } from 'node:os';
import { dirname, join } from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';
import { gzipSync } from 'node:zlib';
import { build } from 'esbuild';

const here = dirname(fileURLToPath(import.meta.url));
const root = dirname(here);
const target = process.env.CARGO_TARGET_DIR ?? join(root, 'target');
const generated = join(here, 'src', 'generated');
const dist = join(here, 'dist');
const { values: options } = parseArgs({
  options: { profile: { type: 'string', default: 'wasm' }, pack: { type: 'boolean', default: false } },
});

/** Modules by name, with the features of the crate that they have. */
const MODULES = { core: [], files: ['io'] };

function run(program, words, folder = root, more = {}) {
  execFileSync(program, words, { cwd: folder, stdio: 'inherit', env: { ...process.env, ...more } });
}

const cargoHome = process.env.CARGO_HOME ?? join(homedir(), '.cargo');

/**
 * Less is copied into its callers than usual, which takes a quarter of the module's size and none of its speed; and two numbers are reckoned
 * with at a time, as all browsers can since 2023. No folder of this machine is named.
 */
const FLAGS = ['-Cllvm-args=--inline-threshold=5', '-Ctarget-feature=+simd128', `--remap-path-prefix=${cargoHome}=cargo`];

/** The module that cargo builds with some features. */
function compiled(features) {
  const words = ['build', '--locked', '--profile', options.profile, '--target', 'wasm32-unknown-unknown', '--package', 'limitmesh-wasm'];
  const flags = options.profile === 'wasm' ? { CARGO_ENCODED_RUSTFLAGS: FLAGS.join('\x1f') } : {};
  run('cargo', [...words, ...features.flatMap(name => ['--features', name])], root, flags);
  return join(target, 'wasm32-unknown-unknown', options.profile, 'limitmesh_wasm.wasm');
}

/** A module of TypeScript's that exports a text. */
function writeText(name, text) {
  writeFileSync(join(generated, `${name}.js`), `export const text = ${JSON.stringify(text)};\n`);
  writeFileSync(join(generated, `${name}.d.ts`), 'export declare const text: string;\n');
}

function buildModules() {
  const bindgen = join(root, 'crates', 'wasm', 'bindgen');
  run('cargo', ['build', '--locked', '--target-dir', join(target, 'bindgen')], bindgen);
  for (const [name, features] of Object.entries(MODULES)) {
    run(join(target, 'bindgen', 'debug', 'limitmesh-bindgen'), [compiled(features), generated, name]);
    const bytes = readFileSync(join(generated, `${name}_bg.wasm`));
    writeText(`${name}-text`, gzipSync(bytes, { level: 9 }).toString('base64'));
  }
}

/** A worker as one text, which names no other file: around the JavaScript of a module. */
async function buildWorker(module, name) {
  const instead = {
    name: 'instead',
    setup: build => build.onResolve({ filter: /generated\/core\.js$/ }, () => ({ path: join(generated, `${module}.js`) })),
  };
  const { outputFiles } = await build({
    entryPoints: [join(here, 'src', 'worker.ts')],
    plugins: [instead], bundle: true, format: 'iife', minify: true, write: false, target: 'es2022', logLevel: 'warning',
  });
  writeText(name, outputFiles[0].text);
}

function buildTypes() {
  run(process.execPath, [join(here, 'node_modules', 'typescript', 'bin', 'tsc'), '--project', here]);
  mkdirSync(join(dist, 'generated'), { recursive: true });
  for (const name of ['core', 'core-text', 'worker-text', 'files-text', 'files-worker-text']) {
    copyFileSync(join(generated, `${name}.js`), join(dist, 'generated', `${name}.js`));
  }
  copyFileSync(join(generated, 'core_bg.wasm'), join(dist, 'limitmesh.wasm'));
}

rmSync(dist, { recursive: true, force: true });
mkdirSync(generated, { recursive: true });
buildModules();
await buildWorker('core', 'worker-text');
await buildWorker('files', 'files-worker-text');
buildTypes();
for (const licence of ['LICENSE-MIT', 'LICENSE-APACHE']) {
  if (!existsSync(join(here, licence))) copyFileSync(join(root, licence), join(here, licence));
}
if (options.pack) {
  const words = [join(root, 'packaging', 'third_parties.py'), 'limitmesh-wasm', 'io'];
  writeFileSync(join(here, 'LICENSE-THIRD-PARTY'), execFileSync('python3', words, { cwd: root, maxBuffer: 1 << 26 }));
  run('npm', ['pack', '--silent'], here);
}
