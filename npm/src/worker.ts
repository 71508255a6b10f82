/** A worker: does one job after the other. Pages whose rules forbid workers from texts start it by its address. */

import { buffersOf } from './arrays.js';
import { Engine, type Glue } from './engine.js';
import { LimitmeshError } from './error.js';
import { perform, type Job } from './jobs.js';
import { nowAndThen } from './listen.js';
import * as glue from './generated/core.js';
import type { FromWorker, ToWorker } from './pool.js';

/** The half of a message port that browsers and Node share. */
interface Port {
  postMessage(message: FromWorker, transfer?: ArrayBuffer[]): void;
}

declare const process: { getBuiltinModule(name: string): { parentPort: Port & { on(name: string, hear: (data: ToWorker) => void): void } } };

const engine = new Engine(glue as Glue);

function answer(port: Port, { module, job, isHeard }: ToWorker): void {
  try {
    engine.start(module);
    const tell = nowAndThen(progress => {
      port.postMessage({ progress });
      return true;
    });
    const result = engine.call(own => perform(own, job as Job, isHeard ? tell : undefined));
    port.postMessage({ result }, buffersOf(result));
  } catch (thrown) {
    port.postMessage({ error: toldOf(thrown) });
  }
}

function toldOf(thrown: unknown): NonNullable<FromWorker['error']> {
  if (thrown instanceof LimitmeshError) return { code: thrown.code, place: thrown.place, message: thrown.message };
  return { code: 'internal', place: 'worker', message: thrown instanceof Error ? thrown.message : String(thrown) };
}

if (typeof WorkerGlobalScope === 'undefined') {
  const { parentPort } = process.getBuiltinModule('node:worker_threads');
  parentPort.on('message', message => answer(parentPort, message));
} else {
  const port = globalThis as unknown as Port;
  globalThis.addEventListener('message', event => answer(port, (event as MessageEvent<ToWorker>).data));
}

declare const WorkerGlobalScope: unknown;
