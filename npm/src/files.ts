/** The module that reads and writes files, and its workers. */

import { compiled } from './module.js';
import { Pool, type Wishes } from './pool.js';
import { text as moduleText } from './generated/files-text.js';
import { text as workerText } from './generated/files-worker-text.js';

const pool = new Pool(() => workerText);

let compiling: Promise<WebAssembly.Module> | undefined;

/** Has a job done in a worker. */
export async function run(job: unknown, transfer: ArrayBuffer[], wishes: Wishes): Promise<unknown> {
  compiling ??= compiled(moduleText);
  return pool.run(await compiling, job, transfer, wishes);
}
