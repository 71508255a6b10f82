/** The one error that this package throws. */

/**
 * Who is at fault: the mesh, an option, a file that is read, nobody (the call was cancelled), the memory, or this package.
 */
export type ErrorCode = 'mesh' | 'option' | 'read' | 'cancelled' | 'memory' | 'internal';

/** What could not be done, and why. The next call works after any of these. */
export class LimitmeshError extends Error {
  override readonly name = 'LimitmeshError';
  readonly code: ErrorCode;
  /** The argument or option at fault, such as `index[12]`; in files the line, byte or part. */
  readonly place: string;

  constructor(code: ErrorCode, place: string, message: string) {
    super(message);
    this.code = code;
    this.place = place;
  }
}
