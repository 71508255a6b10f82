// Numbers in words.

/** A count with thin groups of digits. */
export function counted(n, one, many) {
  return `${n.toLocaleString('en')} ${n === 1 ? one : many}`;
}

/** Three digits, without an exponent where that is readable. */
export function digits(x) {
  if (x === 0) {
    return '0';
  }
  const size = Math.abs(x);
  return size >= 1e-4 && size < 1e6 ? String(Number(x.toPrecision(3))) : x.toExponential(2);
}

/** A length with its unit. */
export function length(x, unit) {
  return unit ? `${digits(x)} ${unit}` : digits(x);
}

/** A share in per cent. */
export function percent(share) {
  return `${digits(100 * share)} %`;
}

/** A duration. */
export function seconds(s) {
  return s < 0.0995 ? `${Math.max(1, Math.round(1000 * s))} ms` : `${digits(s)} s`;
}
