// Where meshes come from: the stops in the page, or the program that serves it.
//
// A mesh is { tolerance, report, glb, distances, uniform, uniformDistances }: files as bytes, distances by triangle; null where there is
// none.

import { floats, part } from './data.js';
import { EvenPlaces, GivenPlaces } from './tolerance.js';

const numbers = (bytes) => bytes && floats(bytes);

/** The meshes in the page. */
export class Stops {
  isLive = false;

  constructor(data) {
    this.stops = data.stops;
    this.places = new GivenPlaces(data.stops.map((stop) => stop.tolerance));
    // One mesh in the page has its uniform counterpart, or none has.
    this.hasUniform = data.stops.some((stop) => stop.parts.uniform);
  }

  async mesh(place) {
    const { tolerance, report, parts } = this.stops[place];
    return {
      tolerance,
      report,
      glb: await part(parts.glb),
      distances: numbers(await part(parts.distances)),
      uniform: await part(parts.uniform),
      uniformDistances: numbers(await part(parts.uniform_distances)),
    };
  }
}

/** The meshes of a program. */
export class Program {
  isLive = true;
  hasUniform = true;

  constructor(data) {
    this.addresses = data.live;
    this.places = new EvenPlaces(data.start);
    // Several pages of one program may be open: each is answered.
    [this.page] = crypto.getRandomValues(new Uint32Array(1));
    // The tolerance that the program was started with stands at its place exactly.
    this.start = data.start;
  }

  async mesh(place, isUniformWanted, signal) {
    const tolerance = this.tolerance(place);
    const answer = await this.ask(this.addresses.refine, { tolerance, uniform: isUniformWanted }, signal);
    const length = new DataView(answer.buffer).getUint32(0, true);
    const head = JSON.parse(new TextDecoder().decode(answer.subarray(4, 4 + length)));
    const own = (name) => {
      const found = head.parts[name];
      return found ? answer.subarray(4 + length + found[0], 4 + length + found[0] + found[1]) : null;
    };
    return {
      tolerance,
      report: head.report,
      glb: own('glb'),
      distances: numbers(own('distances')),
      uniform: own('uniform'),
      uniformDistances: numbers(own('uniform_distances')),
    };
  }

  tolerance(place) {
    return place === this.places.nearest(this.start) ? this.start : this.places.tolerance(place);
  }

  /** The mesh as a file of a format. */
  file(format, tolerance) {
    return this.ask(this.addresses.file, { format, tolerance });
  }

  /** Ends when the program does. */
  async ended() {
    try {
      const reader = (await fetch(this.addresses.alive)).body.getReader();
      while (!(await reader.read()).done);
    } catch {
      // It is gone.
    }
  }

  async ask(address, body, signal) {
    const answer = await fetch(address, { method: 'POST', body: JSON.stringify({ page: this.page, ...body }), signal });
    if (answer.ok) {
      return new Uint8Array(await answer.arrayBuffer());
    }
    // This page asked for another mesh since.
    if (answer.status === 409) {
      throw new DOMException('a newer request came', 'AbortError');
    }
    const said = await answer.json().catch(() => ({}));
    throw new Error(said.error ?? `the program answers ${answer.status}`);
  }
}
