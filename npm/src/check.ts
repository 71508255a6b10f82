/** Values of options, checked one by one. Messages are those of the Python package. */

import { LimitmeshError } from './error.js';

/** A length, or a part of the diagonal. */
export interface Extent {
  amount: number;
  isPart: boolean;
}

/** The error of an option. */
export function bad(place: string, value: unknown, expected: string): LimitmeshError {
  return new LimitmeshError('option', place, `${place} is ${shown(value)}, expected ${expected}`);
}

/** A value as a message can hold it. */
export function shown(value: unknown): string {
  if (typeof value === 'string') return value.length > 40 ? `'${value.slice(0, 40)}…'` : `'${value}'`;
  if (typeof value === 'function') return 'a function';
  if (Array.isArray(value)) return value.length <= 4 && value.every(own => typeof own === 'number') ? `[${value.join(',')}]` : 'an array';
  if (typeof value === 'object' && value !== null) return 'an object';
  return String(value);
}

export function isGiven<T>(value: T | null | undefined): value is T {
  return value !== undefined && value !== null;
}

export function number(value: unknown, place: string, expected: string, fits: (x: number) => boolean): number {
  if (typeof value !== 'number' || !fits(value)) throw bad(place, value, expected);
  return value;
}

/** Degrees above 0, at most 180. */
export function degrees(value: unknown, place: string): number {
  return number(value, place, 'degrees above 0, at most 180', x => x > 0 && x <= 180);
}

export function boolean(value: unknown, place: string, usual: boolean): boolean {
  if (value === undefined) return usual;
  if (typeof value !== 'boolean') throw bad(place, value, 'true or false');
  return value;
}

export function oneOf<T extends string>(value: unknown, place: string, words: readonly T[]): T {
  const found = words.find(word => word === value);
  if (found === undefined) throw bad(place, value, `one of ${words.map(word => `'${word}'`).join(', ')}`);
  return found;
}

const THOUSANDS: Record<string, number> = { '': 1, k: 1e3, m: 1e6, g: 1e9 };

/** A whole number; counts may be written as people write them, such as "20k". */
export function whole(value: unknown, place: string, least: number, most = Number.MAX_SAFE_INTEGER): number {
  const range = most < Number.MAX_SAFE_INTEGER ? `from ${least} to ${most}` : `of at least ${least}`;
  const fits = (x: number) => x >= least && x <= most && Number.isInteger(x);
  if (typeof value !== 'string') return number(value, place, `a whole number ${range}`, fits);
  const found = countOf(value);
  if (!fits(found)) throw bad(place, value, `a whole number ${range}, such as '20000', '20,000', '20k' or '2e4'`);
  return found;
}

function countOf(text: string): number {
  const found = /^\s*(\d{1,3}(?:,\d{3})+|\d{1,3}(?:_\d{3})+|\d+\.?\d*(?:e\+?\d+)?)\s*([kmg]?)\s*$/i.exec(text);
  if (!found) return NaN;
  const amount = Number(found[1]!.replace(/[,_]/g, '')) * THOUSANDS[found[2]!.toLowerCase()]!;
  // 1.1 M is a whole number but for what rounding makes of it.
  return Math.abs(amount - Math.round(amount)) <= 1e-9 * amount ? Math.round(amount) : amount;
}

/** A length above 0, or with % a part of the diagonal. */
export function extent(value: unknown, place: string, least: 'above' | 'of at least' = 'above'): Extent {
  const expected = `a length ${least} 0, or with % a part of the diagonal such as '0.1%'`;
  const fits = (x: number) => Number.isFinite(x) && (x > 0 || (x === 0 && least === 'of at least'));
  if (typeof value !== 'string') return { amount: number(value, place, expected, fits), isPart: false };
  const found = /^\s*([-+]?(?:\d+\.?\d*|\.\d+)(?:e[-+]?\d+)?)\s*(%?)\s*$/i.exec(value);
  const amount = found ? Number(found[1]) : NaN;
  if (!fits(amount)) throw bad(place, value, expected);
  return found![2] === '%' ? { amount: amount / 100, isPart: true } : { amount, isPart: false };
}

const UNITS: Record<string, number> = { '': 1, K: 2 ** 10, M: 2 ** 20, G: 2 ** 30 };

/** More than this a module with 32-bit addresses cannot have beside what it needs itself. */
const MOST_MEMORY = 3.5 * 2 ** 30;

/** Bytes: a number, or such as "500MB". */
export function memory(value: unknown, place: string): number {
  const expected = `bytes above 0, at most 3.5 GiB, such as '500MB'`;
  const found = typeof value === 'string' ? /^\s*(\d+\.?\d*)\s*([KMG]?)i?B?\s*$/i.exec(value) : null;
  const amount = found ? Number(found[1]) * UNITS[found[2]!.toUpperCase()]! : value;
  if (typeof amount !== 'number' || !(amount > 0 && amount <= MOST_MEMORY)) throw bad(place, value, expected);
  return amount;
}

/** Refuses options that there are not: a word that is misspelt must not go unheard. */
export function known(options: object, names: readonly string[]): void {
  for (const name of Object.keys(options)) {
    if (names.includes(name)) continue;
    const near = names.find(own => own.toLowerCase() === name.replace(/[-_]/g, '').toLowerCase());
    const hint = near === undefined ? `there are ${names.join(', ')}` : `it is called ${near}`;
    throw new LimitmeshError('option', name, `there is no option ${shown(name)}; ${hint}`);
  }
}
