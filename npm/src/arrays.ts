/** Numbers from outside as the typed arrays that the engine takes: always copies of their own. */

import { LimitmeshError, type ErrorCode } from './error.js';
import { shown } from './check.js';

type Elements = ArrayLike<unknown>;

/** More elements than the engine can number. */
const MOST = 2 ** 32 - 2;

function elements(value: unknown, place: string, code: ErrorCode): Elements {
  const isList = Array.isArray(value) || (ArrayBuffer.isView(value) && !(value instanceof DataView));
  if (!isList) throw new LimitmeshError(code, place, `${place} is ${shown(value)}, expected numbers`);
  return value as unknown as Elements;
}

/** As 64-bit numbers. */
export function floats(value: unknown, place: string, code: ErrorCode): Float64Array {
  const given = elements(value, place, code);
  if (!Array.isArray(given) && !isBig(given)) return new Float64Array(given as ArrayLike<number>);
  return Float64Array.from(given, (x, i) => {
    if (typeof x === 'number') return x;
    const at = `${place}[${i}]`;
    throw new LimitmeshError(code, at, `${at} is ${shown(x)}, expected a number`);
  });
}

/** As whole numbers of 32 bits. */
export function wholes(value: unknown, place: string, code: ErrorCode): Uint32Array {
  const given = elements(value, place, code);
  const isUnsigned = given instanceof Uint32Array || given instanceof Uint16Array || given instanceof Uint8Array;
  if (isUnsigned) return new Uint32Array(given);
  for (let i = 0; i < given.length; i++) {
    const own = given[i];
    if (typeof own === 'number' && Number.isInteger(own) && own >= 0 && own <= MOST) continue;
    const at = `${place}[${i}]`;
    throw new LimitmeshError(code, at, `${at} is ${shown(own)}, expected a whole number of at least 0`);
  }
  return Uint32Array.from(given as ArrayLike<number>);
}

function isBig(given: Elements): boolean {
  return given instanceof BigInt64Array || given instanceof BigUint64Array;
}

/** The buffers of all arrays in a plain object, to be handed over rather than copied. */
export function buffersOf(value: unknown, found = new Set<ArrayBuffer>()): ArrayBuffer[] {
  if (ArrayBuffer.isView(value)) {
    if (value.buffer instanceof ArrayBuffer) found.add(value.buffer);
  } else if (typeof value === 'object' && value !== null) {
    for (const own of Object.values(value)) buffersOf(own, found);
  }
  return [...found];
}
