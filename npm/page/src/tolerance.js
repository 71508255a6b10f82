// The slider: its places and their tolerances, as shares of the diagonal.

const COARSEST = 1e-2;
const FINEST = 1e-5;
const PLACES_PER_DECADE = 20;

/** Places at equal ratios from 1 % to 0.001 %, and further where the start is beyond. */
export class EvenPlaces {
  constructor(start) {
    this.coarsest = Math.max(COARSEST, start);
    const finest = Math.min(FINEST, start);
    this.last = Math.round(PLACES_PER_DECADE * Math.log10(this.coarsest / finest));
  }

  /** The tolerance of a place, with two digits. */
  tolerance(place) {
    return Number((this.coarsest * 10 ** (-place / PLACES_PER_DECADE)).toPrecision(2));
  }

  /** The place that is nearest to a tolerance. */
  nearest(tolerance) {
    const place = Math.round(PLACES_PER_DECADE * Math.log10(this.coarsest / tolerance));
    return Math.min(this.last, Math.max(0, place));
  }
}

/** Places for the tolerances that there are, the coarsest first. */
export class GivenPlaces {
  constructor(tolerances) {
    this.tolerances = tolerances;
    this.last = tolerances.length - 1;
  }

  tolerance(place) {
    return this.tolerances[place];
  }

  nearest(tolerance) {
    const apart = this.tolerances.map((own) => Math.abs(Math.log(own / tolerance)));
    return apart.indexOf(Math.min(...apart));
  }
}
