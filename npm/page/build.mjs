// Builds the page: code, style and three.js in one file that limitmesh has in it.
//
// The same packages give the same bytes. `node build.mjs FILE` writes elsewhere than into the crate.

import { readFile, writeFile } from 'node:fs/promises';
import { fileURLToPath } from 'node:url';
import { build, transform } from 'esbuild';
import { gzipSync } from 'fflate';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));
const text = (path) => readFile(here(path), 'utf8');

const output = process.argv[2] ?? here('../../crates/view/assets/view.html');

const bundle = await build({
  entryPoints: [here('src/main.js')],
  bundle: true,
  write: false,
  minify: true,
  format: 'iife',
  target: 'es2022',
  charset: 'utf8',
  legalComments: 'none',
  absWorkingDir: here('.'),
});
const code = bundle.outputFiles[0].contents;
// No time in it.
const packed = gzipSync(code, { level: 9, mem: 9, mtime: 0 });
const small = async (path, loader) => (await transform(await text(path), { loader, minify: true, charset: 'utf8' })).code.trim();

const licence = (await text('../node_modules/three/LICENSE')).trim();
const elements = [
  `<!-- three.js, which is in this page:\n${licence}\n-->`,
  `<script type="text/plain" id="code">${Buffer.from(packed).toString('base64')}</script>`,
  `<script>${await small('src/bootstrap.js', 'js')}</script>`,
].join('\n');
const page = (await text('src/page.html'))
  .replace('/*page.css*/', await small('src/page.css', 'css'))
  .replace('<!--limitmesh:code-->', () => elements);
await writeFile(output, page);
console.log(`${output}: ${page.length} bytes, code ${code.length}, packed ${packed.length}`);
