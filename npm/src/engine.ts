/** An instance of the WebAssembly module, which is left behind when it traps, and the errors of its calls. */

import { LimitmeshError, type ErrorCode } from './error.js';

/** What the tool writes beside the module, as far as it is used here. Arrays that it gives are copies. */
export interface Glue {
  initSync(module: { module: WebAssembly.Module }): { memory: WebAssembly.Memory };
  __wbg_reset_state(): void;
  last_panic(): string | undefined;
  refine(mesh: object, control: object, goals: object, listener?: Listener): RefinedOut;
  limit(mesh: object, control: object, listener?: Listener): LimitsOut;
  measure(surface: object, reference: object, how: object, listener?: Listener): object;
  measure_limit(surface: object, reference: object, control: object, how: object, listener?: Listener): object;
  /** Of the module for files alone. */
  refine_file?(bytes: Uint8Array, from: string, to: string, control: object, goals: object, listener?: Listener): FileOut;
}

interface Handle {
  free(): void;
}

export interface ChannelOut extends Handle {
  data(): Float64Array<ArrayBuffer>;
  index(): Uint32Array<ArrayBuffer>;
  domain(): string;
}

interface LimitsOut extends Handle {
  positions(): Float64Array<ArrayBuffer>;
  normals(): Float64Array<ArrayBuffer>;
}

interface FileOut extends Handle {
  bytes(): Uint8Array<ArrayBuffer>;
  told(): object;
}

interface RefinedOut extends Handle {
  positions(): Float64Array<ArrayBuffer>;
  positions_single(): Float32Array<ArrayBuffer>;
  index(): Uint32Array<ArrayBuffer>;
  normals(): Float32Array<ArrayBuffer>;
  side_corners(): Uint32Array<ArrayBuffer>;
  side_normals(): Float32Array<ArrayBuffer>;
  parents(): Uint32Array<ArrayBuffer>;
  channels(): ChannelOut[];
  told(): object;
}

/** Who hears how far a call has come, and says whether it goes on. It must not throw. */
export interface Listener {
  hear(stage: string, done: number, total: number | undefined, triangles: number): boolean;
}

/** A module's memory never shrinks: after a call that took more than this, a new instance begins. */
const KEPT_MEMORY = 256 * 2 ** 20;

const OUT_OF_MEMORY = 'there is not enough memory: a greater tolerance, fewer triangles or a smaller maxMemory need less';

export class Engine<G extends Glue = Glue> {
  readonly #glue: G;
  #module: WebAssembly.Module | undefined;
  #isLost = false;

  constructor(glue: G) {
    this.#glue = glue;
  }

  get isStarted(): boolean {
    return this.#module !== undefined;
  }

  start(module: WebAssembly.Module): void {
    if (this.isStarted) return;
    this.#glue.initSync({ module });
    this.#module = module;
  }

  /** What `work` gives; its errors are `LimitmeshError`s, and the next call works after any of them. */
  call<T>(work: (glue: G) => T): T {
    try {
      if (this.#isLost) this.#renew();
      const result = work(this.#glue);
      if (this.#memory() > KEPT_MEMORY) this.#renew();
      return result;
    } catch (thrown) {
      throw this.#error(thrown);
    }
  }

  /** Bytes that the instance has. */
  #memory(): number {
    // Of a module that is started, this gives what it exports.
    return this.#module === undefined ? 0 : this.#glue.initSync({ module: this.#module }).memory.buffer.byteLength;
  }

  #renew(): void {
    this.#isLost = true;
    this.#glue.__wbg_reset_state();
    this.#isLost = false;
  }

  #error(thrown: unknown): LimitmeshError {
    if (thrown instanceof LimitmeshError) return thrown;
    if (Array.isArray(thrown)) {
      const [code, place, message] = thrown as [ErrorCode, string, string];
      return new LimitmeshError(code, place, message);
    }
    this.#isLost = true;
    const said = this.#lastWords();
    if (isOfMemory(thrown, said)) return new LimitmeshError('memory', 'maxMemory', OUT_OF_MEMORY);
    const why = said ?? (thrown instanceof Error ? thrown.message : String(thrown));
    return new LimitmeshError('internal', 'limitmesh', `this is an error of limitmesh, please report it: ${why}`);
  }

  #lastWords(): string | undefined {
    try {
      return this.#glue.last_panic();
    } catch {
      return undefined;
    }
  }
}

/** An allocation that fails ends the module without a word; too large ones panic; those for arguments and of JavaScript itself say so. */
function isOfMemory(thrown: unknown, said: string | undefined): boolean {
  if (said !== undefined) return /capacity overflow|memory allocation/.test(said);
  if (thrown instanceof WebAssembly.RuntimeError) return /unreachable/i.test(thrown.message);
  return thrown instanceof Error && /malloc|allocat|array length|array buffer|grow|out of memory/i.test(thrown.message);
}
