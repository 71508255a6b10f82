/**
 * Weights of skins: a channel with a number for each joint, smooth as the surface, and back from it the four greatest at a vertex, ties by
 * index, which are made to add up to 1.
 */

import type { Joined } from './join.js';
import type { Influence, Part } from './parts.js';
import type { Channel, RefinedChannel } from './types.js';

/** Joints that move a vertex at most: more are not read by everyone. */
export const MOST_JOINTS = 4;

/** The weights of a joined mesh's vertices, and the joints that they are of; null without a skin. */
export function weightsChannel(parts: readonly Part[], joined: Joined): { channel: Channel; joints: number[] } | null {
  if (parts.every(part => part.influences === null)) return null;
  const lists = joined.origins.map(({ part, vertex }) => parts[part]!.influences?.[vertex] ?? []);
  const joints = [...new Set(lists.flatMap(list => list.map(own => own.joint)))].sort((a, b) => a - b);
  if (joints.length === 0) return null;
  const columns = new Map(joints.map((joint, column) => [joint, column]));
  const data = new Float64Array(lists.length * joints.length);
  lists.forEach((list, v) => {
    const total = list.reduce((sum, own) => sum + own.weight, 0);
    for (const { joint, weight } of list) data[v * joints.length + columns.get(joint)!] = weight / total;
  });
  return { channel: { name: 'weights', data, components: joints.length, domain: 'vertex', semantic: 'skin-weight' }, joints };
}

/** The greatest weights at some corners, with their joints; weights of 0 where there are fewer. */
export function densest(corners: Uint32Array, channel: RefinedChannel, joints: number[]): { joints: Uint32Array; weights: Float64Array } {
  const { data, index, components } = channel;
  const found = { joints: new Uint32Array(MOST_JOINTS * corners.length), weights: new Float64Array(MOST_JOINTS * corners.length) };
  corners.forEach((corner, v) => {
    const first = index[corner]! * components;
    const greatest = mostOf(data.subarray(first, first + components), joints);
    const total = greatest.reduce((sum, own) => sum + own.weight, 0);
    greatest.forEach(({ joint, weight }, i) => {
      found.joints[MOST_JOINTS * v + i] = joint;
      found.weights[MOST_JOINTS * v + i] = weight / total;
    });
  });
  return found;
}

/** The influences with the greatest weights above 0, the greatest first. */
function mostOf(weights: ArrayLike<number>, joints: number[]): Influence[] {
  const found: Influence[] = [];
  joints.forEach((joint, column) => {
    const weight = weights[column]!;
    if (weight > 0) found.push({ joint, weight });
  });
  // Sorting keeps the order of equal ones.
  return found.sort((a, b) => b.weight - a.weight).slice(0, MOST_JOINTS);
}
