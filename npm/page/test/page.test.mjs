// The page as people use it, in a browser.

import assert from 'node:assert/strict';
import { readFile, writeFile } from 'node:fs/promises';
import { join } from 'node:path';
import { after, before, describe, test } from 'node:test';
import { MODELS, colours, compared, difference, folder, launched, onDisk, opened, overlap, picture, ready, run, served, skip } from './browser.mjs';

const TOGGLES = ['wireframe', 'cage', 'side-by-side'];

describe('the page', { skip }, () => {
  let browser;
  before(async () => {
    browser = await launched();
  });
  after(() => browser?.close());

  const written = (name, ...words) => {
    const path = join(folder, name);
    run('view', ...words, '-o', path, '--overwrite');
    return onDisk(path);
  };

  test('a page on disk shows its mesh and asks nobody', async () => {
    const { page, faults } = await opened(browser, written('head.html', 'builtin:head', '--stops', '1%,0.1%'));
    const first = await picture(page);
    assert.ok((await compared(browser, colours, first)) > 500);
    assert.match(await page.textContent('#figures'), /triangles · proven within .* of the limit surface/);
    for (const name of TOGGLES) {
      await page.click(`#${name}`);
      await ready(page);
      assert.ok((await compared(browser, difference, first, await picture(page))) > 0.01, name);
      await page.click(`#${name}`);
    }
    await page.click('input[value="distance"]');
    await ready(page);
    assert.ok((await compared(browser, difference, first, await picture(page))) > 0.01, 'distances');
    assert.match(await page.textContent('#legend-words'), /% of the diagonal/);
    assert.deepEqual(faults, []);
    await page.close();
  });

  test('what a file lacks cannot be chosen', async () => {
    const { page, faults } = await opened(browser, written('cube.html', 'builtin:cube', '--stops', '1%'));
    for (const look of ['material', 'checker']) {
      assert.equal(await page.isDisabled(`input[value="${look}"]`), true, look);
    }
    assert.deepEqual(faults, []);
    await page.close();
  });

  test('it is used by keys alone', async () => {
    const { page, faults } = await opened(browser, written('keys.html', 'builtin:cup', '--stops', '1%,0.1%,0.02%'));
    const figures = () => page.textContent('#figures');
    const fine = await figures();
    await page.keyboard.press('[');
    await ready(page);
    assert.notEqual(await figures(), fine);
    await page.keyboard.press(']');
    await ready(page);
    assert.equal((await figures()).split(' · ')[0], fine.split(' · ')[0]);
    const start = await picture(page);
    for (const key of ['w', 'c', 'd', 's', 'n', 'ArrowLeft', '+']) {
      const old = await picture(page);
      await page.keyboard.press(key);
      await ready(page);
      assert.ok((await compared(browser, difference, old, await picture(page))) > 0.002, key);
    }
    for (const key of ['w', 'c', 's', 'f']) {
      await page.keyboard.press(key);
    }
    await ready(page);
    assert.equal(await compared(browser, difference, start, await picture(page)), 0);
    await page.keyboard.press('?');
    assert.equal(await page.isVisible('#keys'), true);
    await page.keyboard.press('Escape');
    // Every control is reached by Tab.
    const reached = new Set();
    await page.evaluate(() => document.activeElement.blur());
    for (let i = 0; i < 20; i++) {
      await page.keyboard.press('Tab');
      reached.add(await page.evaluate(() => document.activeElement.id || document.activeElement.name));
    }
    for (const id of ['canvas', 'tolerance', 'look', ...TOGGLES, 'fit', 'save-glb', 'save-ply', 'save-png', 'help']) {
      assert.ok(reached.has(id), id);
    }
    assert.deepEqual(faults, []);
    await page.close();
  });

  test('files are saved', async () => {
    const { page } = await opened(browser, written('saved.html', 'builtin:cup', '--tolerance', '0.5%'));
    const saved = async (format) => {
      const waiting = page.waitForEvent('download');
      await page.click(`#save-${format}`);
      return readFile(await (await waiting).path());
    };
    const glb = join(folder, 'cup.glb');
    run('refine', 'builtin:cup', '--tolerance', '0.5%', '-o', glb, '--overwrite');
    assert.ok((await saved('glb')).equals(await readFile(glb)));
    const png = await saved('png');
    assert.ok((await compared(browser, colours, png)) > 200);
    const ply = join(folder, 'saved.ply');
    await writeFile(ply, await saved('ply'));
    // The program's own reader has the same mesh.
    const { hausdorff } = JSON.parse(run('measure', ply, glb, '--json'));
    assert.ok(hausdorff.symmetric < 1e-6 * hausdorff.diagonal, `${hausdorff.symmetric}`);
    await page.close();
  });

  test('its outline is that of the picture that the program draws', async () => {
    const { page } = await opened(browser, written('outline.html', 'builtin:head', '--tolerance', '0.05%'), {
      viewport: { width: 900, height: 900 },
    });
    // From as far away as if rays were parallel.
    const mesh = join(folder, 'head.ply');
    const drawn = join(folder, 'head.png');
    run('refine', 'builtin:head', '--tolerance', '0.05%', '-o', mesh, '--overwrite');
    run('render', mesh, '-o', drawn, '--view', '-1,-2,-4', '--size', '600x600');
    const own = await page.evaluate(async () => {
      const { stage } = window.limitmesh;
      document.getElementById('stage').style.cssText = 'flex: none; width: 600px; height: 600px';
      await new Promise((resolve) => setTimeout(resolve, 300));
      const from = stage.camera.position.clone().set(1, 2, 4);
      stage.look(from, 0.5);
      const blob = await stage.picture();
      return Array.from(new Uint8Array(await blob.arrayBuffer()));
    });
    const same = await compared(browser, overlap, await readFile(drawn), Buffer.from(own));
    assert.ok(same > 0.98, `${same}`);
    await page.close();
  });

  test('without WebGL there is a picture and what is known', async () => {
    const page = await browser.newPage();
    await page.addInitScript(() => {
      HTMLCanvasElement.prototype.getContext = () => null;
    });
    await page.goto(written('picture.html', 'builtin:cup'));
    await page.waitForSelector('#picture:not([hidden])');
    assert.match(await page.textContent('#message'), /draws no meshes/);
    await page.waitForFunction(() => /triangles/.test(document.getElementById('figures').textContent));
    assert.ok((await page.evaluate(() => document.getElementById('picture').naturalWidth)) > 100);
    await page.close();
  });

  test('it follows dark surroundings', async () => {
    const address = written('dark.html', 'builtin:cup');
    const corner = async (colorScheme) => {
      const { page } = await opened(browser, address, { colorScheme });
      const first = await compared(browser, (a) => a[0] + a[1] + a[2], await picture(page));
      await page.close();
      return first;
    };
    assert.ok((await corner('light')) > 600);
    assert.ok((await corner('dark')) < 150);
  });

  test('the program refines as the slider moves', async () => {
    const { child, address } = await served('builtin:head', '--tolerance', '1%');
    const { page, faults } = await opened(browser, address);
    const triangles = async () => Number((await page.textContent('#figures')).split(' ')[0].replaceAll(',', ''));
    const coarse = await triangles();
    for (let i = 0; i < 20; i++) {
      await page.keyboard.press(']');
    }
    await page.waitForFunction((old) => window.limitmesh.mesh.report.triangles > 4 * old, coarse, { timeout: 60_000 });
    await ready(page);
    assert.ok((await triangles()) > 4 * coarse);
    assert.match(await page.textContent('#tolerance-words'), /^0\.1 %/);
    // Another page of the same program takes nothing from this one.
    const other = (await opened(browser, address)).page;
    await other.keyboard.press(']');
    await page.keyboard.press(']');
    for (const own of [page, other]) {
      await ready(own);
      const { words, tolerance } = await own.evaluate(() => ({
        words: document.getElementById('tolerance-words').textContent,
        tolerance: window.limitmesh.mesh.tolerance,
      }));
      assert.equal(words.split(' %')[0], `${Number((100 * tolerance).toPrecision(3))}`);
    }
    await other.close();
    await page.keyboard.press('[');
    await ready(page);
    await page.click('#side-by-side');
    await page.waitForSelector('#right-label:not([hidden])');
    assert.match(await page.textContent('#right-label'), /uniform, \d levels?: .* triangles/);
    assert.deepEqual(faults, []);
    child.kill();
    await page.waitForSelector('#message:not([hidden])');
    assert.match(await page.textContent('#message'), /has ended/);
    assert.equal(await page.isDisabled('#tolerance'), true);
    await page.close();
  });

  describe('of assets', { skip: !MODELS && 'skipped: LIMITMESH_MODELS names no folder of real meshes' }, () => {
    const asset = (name) => join(MODELS, 'assets', name);
    test('materials are those of the file, and a checker shows its texture coordinates', async () => {
      const { page, faults } = await opened(browser, written('duck.html', join(MODELS, 'duck.glb'), '--tolerance', '1%'));
      assert.equal(await page.isChecked('input[value="material"]'), true);
      const own = await picture(page);
      const yellow = (a) => a.filter((_, i) => i % 4 === 0 && a[i] > 180 && a[i + 1] > 140 && a[i + 2] < 90).length;
      assert.ok((await compared(browser, yellow, own)) > 10_000);
      for (const look of ['checker', 'plain']) {
        await page.click(`input[value="${look}"]`);
        await ready(page);
        assert.ok((await compared(browser, difference, own, await picture(page))) > 0.01, look);
      }
      assert.deepEqual(faults, []);
      await page.close();
    });

    test('skins move', async () => {
      const { page, faults } = await opened(browser, written('skin.html', asset('simple_skin.gltf'), '--tolerance', '1%'));
      const still = await picture(page);
      await page.click('#play');
      await page.waitForTimeout(700);
      assert.ok((await compared(browser, difference, still, await picture(page))) > 0.005);
      assert.deepEqual(faults, []);
      await page.close();
    });

    test('pictures in files beside a document are in the page', async () => {
      const path = asset('TextureTransformTest.gltf');
      const { page, faults } = await opened(browser, written('textures.html', path, '--tolerance', '1%'));
      const drawn = await picture(page);
      const blue = (a) => a.filter((_, i) => i % 4 === 2 && a[i] > 150 && a[i - 1] < 40 && a[i - 2] < 40).length;
      // One of the discs is blue, by its picture alone.
      assert.ok((await compared(browser, blue, drawn)) > 1000);
      assert.deepEqual(faults, []);
      await page.close();
    });

    test('shapes are moved', async () => {
      const { page, faults } = await opened(browser, written('shapes.html', asset('MorphStressTest.gltf'), '--tolerance', '1%'));
      const still = await picture(page);
      await page.click('#morphs summary');
      await page.locator('#morph-list input').first().fill('1');
      await page.click('#morphs summary');
      await ready(page);
      assert.ok((await compared(browser, difference, still, await picture(page))) > 0.002);
      assert.deepEqual(faults, []);
      await page.close();
    });
  });
});

