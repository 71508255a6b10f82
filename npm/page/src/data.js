// The data in the page: one JSON text, and binary parts in elements of their own.

/** The page's description of what it shows. */
export function readData() {
  const element = document.getElementById('limitmesh');
  if (!element) {
    throw new Error('there is no mesh in it.');
  }
  return JSON.parse(element.textContent);
}

/** The bytes of an element's base64 text. */
export function plainPart(name) {
  const text = document.getElementById(name).textContent;
  return Uint8Array.from(atob(text), (c) => c.charCodeAt(0));
}

/** The bytes of a part of a stop; null where it has none. */
export async function part(place) {
  if (!place) {
    return null;
  }
  const bytes = plainPart(place.blob);
  if (!place.gzip) {
    return bytes;
  }
  const unpacked = new Blob([bytes]).stream().pipeThrough(new DecompressionStream('gzip'));
  return new Uint8Array(await new Response(unpacked).arrayBuffer());
}

/** Bytes as 32-bit numbers. */
export function floats(bytes) {
  // A part of a longer answer may begin anywhere; numbers may not.
  return new Float32Array(bytes.slice().buffer);
}
