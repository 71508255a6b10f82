// What the tests of the page share: a browser, the program, and pictures to compare.

import { spawn, spawnSync } from 'node:child_process';
import { existsSync } from 'node:fs';
import { mkdtemp } from 'node:fs/promises';
import { tmpdir } from 'node:os';
import { join } from 'node:path';
import { fileURLToPath, pathToFileURL } from 'node:url';
import { chromium } from 'playwright-core';

const PROGRAM = process.env.LIMITMESH ?? fileURLToPath(new URL('../../../target/debug/limitmesh', import.meta.url));
const BROWSER = process.env.CHROMIUM ?? '/usr/bin/chromium';

/** Why the tests cannot run here; false where they can. */
export const skip =
  (!existsSync(BROWSER) && `skipped: there is no Chromium at ${BROWSER}`) ||
  (!existsSync(PROGRAM) && 'skipped: the program is not built (cargo build)');

/** The folder of real meshes, if there is one. */
export const MODELS = process.env.LIMITMESH_MODELS;

export const folder = await mkdtemp(join(tmpdir(), 'limitmesh-page-'));

/** Runs the program to its end; gives what it prints. */
export function run(...words) {
  const { status, stdout, stderr } = spawnSync(PROGRAM, words, { encoding: 'utf8' });
  if (status !== 0) {
    throw new Error(`${words.join(' ')}: ${stderr}`);
  }
  return stdout;
}

/** The program as a server of its page. */
export async function served(...words) {
  const child = spawn(PROGRAM, ['view', ...words, '--no-open'], { stdio: ['ignore', 'pipe', 'ignore'] });
  const [line] = await new Promise((resolve) => child.stdout.once('data', (data) => resolve(String(data).split('\n'))));
  return { child, address: line };
}

/** A browser that draws with the processor. */
export function launched(...options) {
  return chromium.launch({
    executablePath: BROWSER,
    args: ['--no-sandbox', '--use-angle=swiftshader', '--enable-unsafe-swiftshader', ...options],
  });
}

/** Opens a page and collects what it must not do: requests to elsewhere, lines of the console, errors. */
export async function opened(browser, address, options = {}) {
  const page = await browser.newPage({ viewport: { width: 800, height: 600 }, ...options });
  const faults = [];
  page.on('request', (request) => {
    const url = request.url();
    if (!url.startsWith('data:') && !url.startsWith('blob:') && !url.startsWith(address)) {
      faults.push(`a request to ${url}`);
    }
  });
  page.on('console', (message) => {
    // The browser's own word on what it draws with.
    if (!/GPU stall|software|swiftshader/i.test(message.text())) {
      faults.push(`console: ${message.text()}`);
    }
  });
  page.on('pageerror', (error) => faults.push(error.message));
  await page.goto(address);
  await ready(page);
  return { page, faults };
}

/** A page that was written to a file. */
export const onDisk = (path) => pathToFileURL(path).href;

/** Waits until the mesh that is wanted is drawn. */
export async function ready(page) {
  await page.waitForFunction(() => window.limitmesh?.mesh && document.body.getAttribute('aria-busy') === 'false', null, { timeout: 60_000 });
  await page.evaluate(() => new Promise((resolve) => requestAnimationFrame(() => requestAnimationFrame(resolve))));
}

/** The picture of the mesh alone. */
export const picture = (page) => page.locator('#stage').screenshot();

/** Compares pictures by a function of their pixels (RGBA), in a page of its own. */
export async function compared(browser, compare, ...pictures) {
  const page = await browser.newPage();
  const texts = pictures.map((own) => Buffer.from(own).toString('base64'));
  const found = await page.evaluate(
    async ([source, texts]) => {
      const pixels = async (text) => {
        const bytes = Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
        const image = await createImageBitmap(new Blob([bytes]));
        const context = new OffscreenCanvas(image.width, image.height).getContext('2d');
        context.drawImage(image, 0, 0);
        return context.getImageData(0, 0, image.width, image.height).data;
      };
      return eval(source)(...(await Promise.all(texts.map(pixels))));
    },
    [`(${compare})`, texts],
  );
  await page.close();
  return found;
}

/** How many colours a picture has. */
export const colours = (a) => new Set(new Uint32Array(a.buffer)).size;

/** The share of pixels in which two pictures differ visibly. */
export function difference(a, b) {
  let count = 0;
  for (let i = 0; i < a.length; i += 4) {
    count += Math.abs(a[i] - b[i]) + Math.abs(a[i + 1] - b[i + 1]) + Math.abs(a[i + 2] - b[i + 2]) > 12;
  }
  return a.length === b.length ? (4 * count) / a.length : 1;
}

/**
 * The pixels that are covered in both of two square pictures, of those in either, after the second is moved and scaled so that it fills
 * the box of the first: cameras that look along one direction differ in nothing else. What is like the upper left corner is ground.
 */
export function overlap(a, b) {
  const shape = (pixels) => {
    const size = Math.sqrt(pixels.length / 4);
    const covers = (x, y) => [0, 1, 2].some((k) => Math.abs(pixels[4 * (y * size + x) + k] - pixels[k]) > 6);
    const all = Array.from({ length: size * size }, (_, i) => [i % size, Math.floor(i / size)]).filter(([x, y]) => covers(x, y));
    const least = [0, 1].map((k) => all.reduce((own, place) => Math.min(own, place[k]), size));
    const most = [0, 1].map((k) => all.reduce((own, place) => Math.max(own, place[k]), 0));
    return { covers, least, most };
  };
  const [first, second] = [shape(a), shape(b)];
  const mapped = (at, k) => {
    const share = (at - first.least[k]) / (first.most[k] - first.least[k]);
    return Math.round(second.least[k] + share * (second.most[k] - second.least[k]));
  };
  let [both, either] = [0, 0];
  for (let y = first.least[1]; y <= first.most[1]; y++) {
    for (let x = first.least[0]; x <= first.most[0]; x++) {
      const [one, other] = [first.covers(x, y), second.covers(mapped(x, 0), mapped(y, 1))];
      both += one && other;
      either += one || other;
    }
  }
  return both / either;
}
