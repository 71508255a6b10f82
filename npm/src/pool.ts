/**
 * Workers, one job each at a time. A busy worker hears nothing, so a job that is cancelled ends its worker; the next job starts another one,
 * with the module that is compiled already.
 */

import { LimitmeshError, type ErrorCode } from './error.js';
import type { Progress } from './types.js';

/** What a worker is told. */
export interface ToWorker {
  module: WebAssembly.Module;
  job: unknown;
  /** Whether anybody wants to know of progress. */
  isHeard: boolean;
}

/** What it tells: one of these. */
export interface FromWorker {
  progress?: Progress;
  result?: unknown;
  error?: { code: ErrorCode; place: string; message: string };
}

/** What browsers' workers and Node's have in common, made alike. */
interface Hands {
  post(message: ToWorker, transfer: ArrayBuffer[]): void;
  hear(message: (data: FromWorker) => void, failure: (why: string) => void): void;
  /** Whether the process waits for it. */
  hold(isHeld: boolean): void;
  end(): void;
}

/** What a call waits for. */
export interface Wishes {
  signal: AbortSignal | undefined;
  onProgress: ((progress: Progress) => unknown) | undefined;
  worker: Worker | undefined;
}

interface NodeWorker {
  postMessage(message: unknown, transfer: ArrayBuffer[]): void;
  removeAllListeners(): void;
  on(name: string, hear: (data: never) => void): void;
  ref(): void;
  unref(): void;
  terminate(): Promise<number>;
}

declare const process: {
  versions?: { node?: string };
  getBuiltinModule?(name: string): { Worker: new (source: string, options: { eval: true }) => NodeWorker };
} | undefined;

export class Pool {
  readonly #source: () => string;
  readonly #idle: Hands[] = [];
  readonly #waiting: (() => void)[] = [];
  #busy = 0;

  /** `source` is the text of a worker. */
  constructor(source: () => string) {
    this.#source = source;
  }

  /** Has a job done; ends it, and its worker, as soon as the signal says so. */
  async run(module: WebAssembly.Module, job: unknown, transfer: ArrayBuffer[], wishes: Wishes): Promise<unknown> {
    if (wishes.worker !== undefined) return resultOf(await onGiven(wishes.worker, { module, job, transfer, wishes }));
    await this.#turn(wishes.signal);
    this.#busy++;
    try {
      const hands = this.#idle.pop() ?? started(this.#source());
      const done = await work(hands, { module, job, transfer, wishes });
      hands.hold(false);
      this.#idle.push(hands);
      return resultOf(done);
    } finally {
      this.#busy--;
      this.#waiting.shift()?.();
    }
  }

  /** Waits until there are fewer jobs than processors. */
  async #turn(signal: AbortSignal | undefined): Promise<void> {
    const most = Math.max(1, globalThis.navigator?.hardwareConcurrency ?? 4);
    while (this.#busy >= most) {
      await new Promise<void>(resolve => this.#waiting.push(resolve));
      if (signal?.aborted) this.#waiting.shift()?.();
      signal?.throwIfAborted();
    }
  }
}

/** A job, and what its caller waits for. */
interface Task {
  module: WebAssembly.Module;
  job: unknown;
  transfer: ArrayBuffer[];
  wishes: Wishes;
}

/** What is known of a worker that callers gave. */
interface Given {
  /** Resolves when the last of its calls has settled. */
  isFree: Promise<void>;
  isEnded: boolean;
}

const GIVEN = new WeakMap<Worker, Given>();

/** A job on a worker that the caller gave, after those that were given to it before. One that a call has ended answers nobody. */
async function onGiven(worker: Worker, task: Task): Promise<FromWorker> {
  const { signal } = task.wishes;
  const own = GIVEN.get(worker) ?? { isFree: Promise.resolve(), isEnded: false };
  GIVEN.set(worker, own);
  const end = () => {
    own.isEnded = true;
    worker.terminate();
  };
  const done = own.isFree.then(() => {
    signal?.throwIfAborted();
    if (own.isEnded) throw new LimitmeshError('internal', 'worker', ENDED);
    return work({ ...ofBrowser(worker), end }, task);
  });
  own.isFree = done.then(() => {}, () => {});
  return unlessAborted(done, signal);
}

const ENDED = 'worker was ended by an earlier call, which was aborted, cancelled or failed: give a new one';

/** What a promise gives, or the signal's reason as soon as it is aborted. */
function unlessAborted<T>(promise: Promise<T>, signal: AbortSignal | undefined): Promise<T> {
  return new Promise((resolve, reject) => {
    const abort = () => reject(signal!.reason);
    signal?.addEventListener('abort', abort);
    promise.then(resolve, reject).finally(() => signal?.removeEventListener('abort', abort));
  });
}

/** One job on one worker, which is ended if the job is. */
function work(hands: Hands, { module, job, transfer, wishes }: Task): Promise<FromWorker> {
  const { signal, onProgress } = wishes;
  return new Promise((resolve, reject) => {
    const abort = () => end(signal!.reason);
    const end = (why: unknown) => {
      hands.end();
      settle();
      reject(why);
    };
    const settle = () => signal?.removeEventListener('abort', abort);
    if (signal?.aborted) return end(signal.reason);
    signal?.addEventListener('abort', abort);
    const hear = (told: FromWorker) => {
      if (told.progress !== undefined) return tell(told.progress);
      settle();
      resolve(told);
    };
    const tell = (progress: Progress) => {
      try {
        if (onProgress?.(progress) === false) {
          end(new LimitmeshError('cancelled', 'onProgress', 'the call was cancelled: onProgress returned false'));
        }
      } catch (thrown) {
        end(thrown);
      }
    };
    hands.hear(hear, why => end(notStarted(why)));
    hands.hold(true);
    hands.post({ module, job, isHeard: onProgress !== undefined }, transfer);
  });
}

/** After an error a worker is as good as before: its engine sees to that. */
function resultOf({ error, result }: FromWorker): unknown {
  if (error !== undefined) throw new LimitmeshError(error.code, error.place, error.message);
  return result;
}

function notStarted(why: string): LimitmeshError {
  const hint = "a page whose Content-Security-Policy forbids workers from blob: gives one, new Worker(new URL('limitmesh/worker', import.meta.url))";
  return new LimitmeshError('internal', 'worker', `the worker failed (${hint}): ${why}`);
}

/** A new worker from its text. */
function started(source: string): Hands {
  if (typeof Worker === 'undefined' && typeof process !== 'undefined' && process.getBuiltinModule !== undefined) {
    const { Worker } = process.getBuiltinModule('node:worker_threads');
    return ofNode(new Worker(source, { eval: true }));
  }
  if (typeof Worker === 'undefined') throw notStarted('there are no workers here');
  const address = URL.createObjectURL(new Blob([source], { type: 'text/javascript' }));
  try {
    return ofBrowser(new Worker(address));
  } catch (thrown) {
    throw notStarted(String(thrown));
  } finally {
    // The worker has begun to load by then.
    setTimeout(() => URL.revokeObjectURL(address), 10_000);
  }
}

function ofBrowser(worker: Worker): Hands {
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    hear(message, failure) {
      worker.onmessage = event => message(event.data as FromWorker);
      worker.onerror = event => failure(event.message ?? 'it could not be loaded');
      worker.onmessageerror = () => failure('a message could not be read');
    },
    hold() {},
    end: () => worker.terminate(),
  };
}

function ofNode(worker: NodeWorker): Hands {
  return {
    post: (message, transfer) => worker.postMessage(message, transfer),
    hear(message, failure) {
      worker.removeAllListeners();
      worker.on('message', message as (data: never) => void);
      worker.on('error', ((error: Error) => failure(error.message)) as (data: never) => void);
    },
    hold: isHeld => (isHeld ? worker.ref() : worker.unref()),
    end: () => void worker.terminate(),
  };
}
