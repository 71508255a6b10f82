// The page in the crate is what these sources give.

import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFile } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { test } from 'node:test';
import { fileURLToPath } from 'node:url';

const here = (path) => fileURLToPath(new URL(path, import.meta.url));

test('the page is built from its sources', async () => {
  const path = join(tmpdir(), `limitmesh-page-${process.pid}.html`);
  const { status, stderr } = spawnSync(process.execPath, [here('../build.mjs'), path], { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
  const built = await readFile(path);
  const own = await readFile(here('../../../crates/view/assets/view.html'));
  assert.ok(built.equals(own), 'crates/view/assets/view.html is not what npm/page gives: run `npm run build:page` in npm');
  assert.ok(built.length <= 300_000, `${built.length} bytes`);
});
