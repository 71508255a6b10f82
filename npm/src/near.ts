/** Points that are one: those within a distance of each other, along chains. */

/** By point, the number of those that it is one with. A distance of 0 is that of equal points alone, for which 0 and −0 are equal. */
export function clusters(count: number, point: (at: number) => Point, distance: number): Uint32Array {
  if (distance === 0) return equals(count, at => point(at).join(' '));
  const above = new Uint32Array(count).map((_, at) => at);
  const root = (at: number): number => {
    let own = at;
    while (above[own] !== own) own = above[own] = above[above[own]!]!;
    return own;
  };
  const cells = new Map<string, number[]>();
  for (let at = 0; at < count; at++) {
    const own = point(at);
    for (const key of cellsAround(own, distance)) {
      for (const other of cells.get(key) ?? []) if (isNear(own, point(other), distance)) above[root(at)] = root(other);
    }
    const [key] = cellsAround(own, 0, distance);
    const met = cells.get(key!);
    if (met === undefined) cells.set(key!, [at]);
    else met.push(at);
  }
  return above.map((_, at) => root(at));
}

/** Numbers of things by their texts, in the order in which these come. */
export function equals(count: number, text: (at: number) => string): Uint32Array {
  const known = new Map<string, number>();
  return new Uint32Array(count).map((_, at) => {
    const own = text(at);
    const number = known.get(own) ?? known.size;
    known.set(own, number);
    return number;
  });
}

export type Point = readonly [number, number, number];

/** A cell's side, in distances: most points are not that near to a side. */
const SIDE = 16;

/** The cells of a grid that a box around a point touches. */
function cellsAround(point: Point, reach: number, distance = reach): string[] {
  const ends = point.map(x => [...new Set([x - reach, x + reach].map(end => Math.floor(end / (SIDE * distance))))]);
  return ends[0]!.flatMap(x => ends[1]!.flatMap(y => ends[2]!.map(z => `${x} ${y} ${z}`)));
}

function isNear(a: Point, b: Point, distance: number): boolean {
  return Math.hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]) <= distance;
}
