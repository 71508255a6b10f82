/** Calls on a worker that the caller gives: one after the other, and none after one that ended it. */

import assert from 'node:assert/strict';
import { after, test } from 'node:test';
import { Worker as Thread } from 'node:worker_threads';
import { measure, measureAsync, ready, refine, refineAsync } from 'limitmesh';
import { torusKnot } from './models.mjs';

await ready;

const knot = torusKnot();
const mesh = [knot.positions, knot.index];
const begun = [];

/** A browser's worker, made of a thread of Node's. */
class BrowserWorker {
  #thread = new Thread(new URL('../dist/worker.js', import.meta.url));

  constructor() {
    begun.push(this);
    this.#thread.on('message', data => this.onmessage?.({ data }));
    this.#thread.on('error', error => this.onerror?.(error));
  }

  postMessage(message, transfer) {
    this.#thread.postMessage(message, transfer);
  }

  terminate() {
    this.isTerminated = true;
    void this.#thread.terminate();
  }
}

globalThis.Worker = BrowserWorker;
after(() => begun.forEach(worker => worker.terminate()));

test('calls at once on one worker all settle, each with its own result', { timeout: 60_000 }, async () => {
  const worker = new BrowserWorker();
  const goals = ['1%', '0.1%', '0.05%'];
  const found = await Promise.all(goals.map(tolerance => refineAsync(...mesh, { tolerance, worker })));
  goals.forEach((tolerance, i) => assert.deepEqual(found[i], refine(...mesh, { tolerance })));
  const a = { positions: found[0].positions, index: found[0].index };
  assert.deepEqual(await measureAsync(a, knot, { worker }), measure(a, knot));
  await assert.rejects(refineAsync(knot.positions, [0, 1, 5000], { worker }), { code: 'mesh', place: 'index[2]' });
  assert.equal((await refineAsync(...mesh, { worker })).stop, 'met', 'a mesh that is none leaves the worker as it was');
});

test('a worker that a call has ended is refused at once, also by the calls that wait for it', { timeout: 60_000 }, async () => {
  const endings = [
    worker => refineAsync(...mesh, { tolerance: '0.001%', worker, onProgress: () => false }),
    worker => refineAsync(...mesh, { tolerance: '0.0001%', maxMemory: '2GB', worker, signal: AbortSignal.timeout(300) }),
  ];
  for (const end of endings) {
    const worker = new BrowserWorker();
    const [ended, waiting] = await Promise.allSettled([end(worker), refineAsync(...mesh, { worker })]);
    assert.ok(worker.isTerminated && ended.status === 'rejected');
    assert.deepEqual([waiting.reason?.code, waiting.reason?.place], ['internal', 'worker']);
    await assert.rejects(refineAsync(...mesh, { worker }), { name: 'LimitmeshError', code: 'internal', place: 'worker', message: /ended by an earlier call/ });
  }
});

test('a call that is aborted while it waits leaves the worker to the others', { timeout: 60_000 }, async () => {
  const worker = new BrowserWorker();
  const controller = new AbortController();
  const first = refineAsync(...mesh, { tolerance: '0.01%', worker });
  const second = refineAsync(...mesh, { worker, signal: controller.signal });
  const third = refineAsync(...mesh, { worker });
  setTimeout(() => controller.abort(new Error('gone')), 20);
  await assert.rejects(second, { message: 'gone' });
  assert.equal((await first).stop, 'met');
  assert.equal((await third).stop, 'met');
  assert.ok(!worker.isTerminated);
});
