/**
 * Another witness for the surface: three-subdivide's uniform refinement by Loop's rules, whose vertices are moved to their limits by the closed
 * form. All of these are points of the limit surface, so that none is farther from our mesh than our bound.
 */

import assert from 'node:assert/strict';
import { test } from 'node:test';
import { BufferAttribute, BufferGeometry } from 'three';
import { LoopSubdivision } from 'three-subdivide';
import { ready, refine } from 'limitmesh';
import { modelOf, torusKnot } from './models.mjs';

await ready;

/** A mesh after uniform refinement, every vertex once. */
function subdivided({ positions, index }, levels) {
  const geometry = new BufferGeometry();
  geometry.setAttribute('position', new BufferAttribute(Float32Array.from(positions), 3));
  geometry.setIndex(new BufferAttribute(Uint32Array.from(index), 1));
  const fine = LoopSubdivision.modify(geometry, levels, { split: false, maxTriangles: Infinity }).getAttribute('position').array;
  const numbers = new Map();
  const found = { positions: [], index: [] };
  for (let corner = 0; corner < fine.length / 3; corner++) {
    const own = [...fine.subarray(3 * corner, 3 * corner + 3)];
    // It computes each vertex several times, with other roundings.
    const key = own.map(x => Math.round(x * 2e4)).join(' ');
    if (!numbers.has(key)) {
      numbers.set(key, numbers.size);
      found.positions.push(own);
    }
    found.index.push(numbers.get(key));
  }
  return found;
}

/** Vertices moved to where Loop's rules lead them: (ω p + Σ q) / (ω + n) with ω = 3 / (8 β), where β is the weight of a neighbour. */
function limits({ positions, index }) {
  const rings = positions.map(() => new Set());
  for (let i = 0; i < index.length; i += 3) {
    const triangle = index.slice(i, i + 3);
    for (const a of triangle) for (const b of triangle) if (a !== b) rings[a].add(b);
  }
  return positions.map((own, v) => {
    const n = rings[v].size;
    const beta = (5 / 8 - (3 / 8 + Math.cos((2 * Math.PI) / n) / 4) ** 2) / n;
    const omega = 3 / (8 * beta);
    return own.map((x, k) => [...rings[v]].reduce((sum, other) => sum + positions[other][k], omega * x) / (omega + n));
  });
}

/** The distance of a point from a triangle: to its plane where it stands over it, else to its edges. */
function distance(p, [a, b, c]) {
  const minus = (u, v) => [u[0] - v[0], u[1] - v[1], u[2] - v[2]];
  const dot = (u, v) => u[0] * v[0] + u[1] * v[1] + u[2] * v[2];
  const [ab, ac, ap] = [minus(b, a), minus(c, a), minus(p, a)];
  const [d00, d01, d11, d20, d21] = [dot(ab, ab), dot(ab, ac), dot(ac, ac), dot(ap, ab), dot(ap, ac)];
  const scale = d00 * d11 - d01 * d01;
  const [v, w] = [(d11 * d20 - d01 * d21) / scale, (d00 * d21 - d01 * d20) / scale];
  if (v >= 0 && w >= 0 && v + w <= 1) return Math.hypot(...ap.map((x, k) => x - v * ab[k] - w * ac[k]));
  const toEdge = (u, v) => {
    const [along, from] = [minus(v, u), minus(p, u)];
    const t = Math.min(1, Math.max(0, dot(from, along) / (dot(along, along) || 1)));
    return Math.hypot(...from.map((x, k) => x - t * along[k]));
  };
  return Math.min(toEdge(a, b), toEdge(b, c), toEdge(c, a));
}

/** Of so many places, each as far from the next in their list. */
const PLACES = 300;

for (const [name, mesh, levels] of [['torus knot', torusKnot(), 2], ['icosphere', modelOf('icosphere'), 3]]) {
  test(`${name}: limits of three-subdivide's vertices are as near as is proven`, () => {
    const fine = subdivided(mesh, levels);
    const triangles = (mesh.index.length / 3) * 4 ** levels;
    assert.equal(fine.index.length / 3, triangles);
    assert.equal(fine.positions.length, triangles / 2 + (name === 'icosphere' ? 2 : 0), 'every vertex once');
    const own = refine(mesh.positions, mesh.index, { tolerance: '0.2%', precision: 'f64' });
    const at = v => own.positions.subarray(3 * v, 3 * v + 3);
    const ours = Array.from({ length: own.index.length / 3 }, (_, t) => [0, 1, 2].map(k => at(own.index[3 * t + k])));
    const places = limits(fine).filter((_, v, all) => v % Math.floor(all.length / PLACES) === 0);
    const far = place => ours.reduce((least, triangle) => Math.min(least, distance(place, triangle)), Infinity);
    const greatest = Math.max(...places.map(far));
    // It reckons with 32 bits.
    assert.ok(greatest <= own.error.upper * 1.001, `${greatest} > ${own.error.upper}`);
    assert.ok(greatest > own.error.upper / 10, 'the places are where the mesh is not');
  });
}
