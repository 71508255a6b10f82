/** The module for meshes in memory: compiled when this package is imported, started at the first call. */

import { Engine, type Glue } from './engine.js';
import { LimitmeshError } from './error.js';
import { compiled, supported } from './module.js';
import * as glue from './generated/core.js';
import { text } from './generated/core-text.js';

export const engine = new Engine(glue as Glue);

let module: WebAssembly.Module | undefined;

export const compiling: Promise<WebAssembly.Module> = compiled(text).then(made => (module = made));
// Whoever awaits `ready` or a call learns of it.
compiling.catch(() => {});

/** The engine, started. */
export function started(): Engine {
  if (!engine.isStarted) {
    if (module === undefined) {
      const why = supported ? 'the module is not ready yet: await ready before the first call, or call refineAsync' : 'there is no WebAssembly here';
      throw new LimitmeshError('internal', 'ready', why);
    }
    engine.start(module);
  }
  return engine;
}
