/** Progress on its way from the engine to callers: not more often than they can use it. */

import type { Listener } from './engine.js';
import type { Progress, SurfaceOptions } from './types.js';

/** Milliseconds between two calls. */
const PAUSE = 50;

/** A listener that passes on what it hears now and then; `tell` says whether to go on. */
export function nowAndThen(tell: (progress: Progress) => boolean): Listener {
  let next = 0;
  return {
    hear(stage, done, total, triangles) {
      const now = performance.now();
      if (now < next) return true;
      const goesOn = tell({ stage, done, total: total ?? null, triangles });
      next = performance.now() + PAUSE;
      return goesOn;
    },
  };
}

/** What a callback threw while the engine worked, which must not go through it. */
export class Caught {
  #thrown: { what: unknown } | undefined;

  listener(callback: SurfaceOptions['onProgress']): Listener | undefined {
    if (typeof callback !== 'function') return undefined;
    return nowAndThen(progress => {
      try {
        return callback(progress) !== false;
      } catch (what) {
        this.#thrown = { what };
        return false;
      }
    });
  }

  /** Throws it again, if there is something. */
  rethrow(): void {
    if (this.#thrown !== undefined) throw this.#thrown.what;
  }
}
