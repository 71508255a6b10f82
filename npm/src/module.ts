/** WebAssembly modules from texts: nothing is fetched, so that there is nothing to find. */

import { LimitmeshError } from './error.js';

/** Whether modules can run here. */
export const supported: boolean = typeof WebAssembly === 'object' && typeof WebAssembly.compile === 'function';

/** The module in a text: base64 of its gzip-compressed bytes. */
export async function compiled(text: string): Promise<WebAssembly.Module> {
  if (!supported) throw new LimitmeshError('internal', 'WebAssembly', 'there is no WebAssembly here');
  const packed = Uint8Array.from(atob(text), letter => letter.charCodeAt(0));
  const stream = new Blob([packed]).stream().pipeThrough(new DecompressionStream('gzip'));
  try {
    return await WebAssembly.compile(await new Response(stream).arrayBuffer());
  } catch (thrown) {
    const why = thrown instanceof Error ? thrown.message : String(thrown);
    const hint = "a page with a Content-Security-Policy needs script-src 'wasm-unsafe-eval'";
    throw new LimitmeshError('internal', 'WebAssembly', `the module could not be compiled (${hint}): ${why}`);
  }
}
