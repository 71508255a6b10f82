/** What the engine can do, in plain objects that go to a worker and back. */

import type { ControlIn, GoalsIn, HowIn } from './options.js';
import type { MeshIn } from './mesh.js';
import type { ChannelOut, Glue, Listener } from './engine.js';
import type { Distance, Domain, FileReport, FloatArray, Limits, Refined, RefinedChannel, RefinedFile } from './types.js';

/** One job. */
export type Job =
  | { kind: 'refine'; mesh: MeshIn; control: ControlIn; goals: GoalsIn }
  | { kind: 'limit'; mesh: MeshIn; control: ControlIn; isSingle: boolean }
  | { kind: 'file'; bytes: Uint8Array; from: string; to: string; control: ControlIn; goals: GoalsIn }
  | { kind: 'measure'; surface: MeshIn; reference: MeshIn; control: ControlIn | undefined; how: HowIn };

/** What comes of it. */
export type Done = { refine: Refined; limit: Limits; measure: Distance; file: RefinedFile };

/** Does a job on an instance; whoever listens says whether it goes on. */
export function perform<J extends Job>(glue: Glue, job: J, listener: Listener | undefined): Done[J['kind']];
export function perform(glue: Glue, job: Job, listener: Listener | undefined): Done[Job['kind']] {
  switch (job.kind) {
    case 'refine': return refine(glue, job, listener);
    case 'limit': return limit(glue, job, listener);
    case 'file': return file(glue, job, listener);
    case 'measure': return measure(glue, job, listener);
  }
}

function refine(glue: Glue, job: Job & { kind: 'refine' }, listener: Listener | undefined): Refined {
  const found = glue.refine(job.mesh, job.control, job.goals, listener);
  try {
    const channels = found.channels();
    return {
      positions: job.goals.isSingle ? found.positions_single() : found.positions(),
      index: found.index(),
      normals: found.normals(),
      sides: { corners: found.side_corners(), normals: found.side_normals() },
      parents: found.parents(),
      channels: channels.map((own, row) => channelOf(own, job.mesh.channels[row]!, job.goals.isSingle)),
      ...(found.told() as Omit<Refined, 'positions' | 'index' | 'normals' | 'sides' | 'parents' | 'channels'>),
    };
  } finally {
    found.free();
  }
}

function channelOf(own: ChannelOut, from: { name: string; components: number }, isSingle: boolean): RefinedChannel {
  try {
    const { name, components } = from;
    return { name, data: asAsked(own.data(), isSingle), components, index: own.index(), domain: own.domain() as Domain };
  } finally {
    own.free();
  }
}

function limit(glue: Glue, job: Job & { kind: 'limit' }, listener: Listener | undefined): Limits {
  const found = glue.limit(job.mesh, job.control, listener);
  try {
    return { positions: asAsked(found.positions(), job.isSingle), normals: asAsked(found.normals(), job.isSingle) };
  } finally {
    found.free();
  }
}

function measure(glue: Glue, job: Job & { kind: 'measure' }, listener: Listener | undefined): Distance {
  return (job.control === undefined
    ? glue.measure(job.surface, job.reference, job.how, listener)
    : glue.measure_limit(job.surface, job.reference, job.control, job.how, listener)) as Distance;
}

function file(glue: Glue, job: Job & { kind: 'file' }, listener: Listener | undefined): RefinedFile {
  const found = glue.refine_file!(job.bytes, job.from, job.to, job.control, job.goals, listener);
  try {
    return { bytes: found.bytes(), report: found.told() as FileReport };
  } finally {
    found.free();
  }
}

function asAsked(values: Float64Array<ArrayBuffer>, isSingle: boolean): FloatArray {
  return isSingle ? new Float32Array(values) : values;
}
