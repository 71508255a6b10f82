// What the page says of its meshes.

import { counted, digits, length, percent, seconds } from './numbers.js';

/** A mesh in one line: triangles, distance, time. */
export function figures({ report, tolerance }, data) {
  const parts = [counted(report.triangles, 'triangle', 'triangles')];
  if (report.upper === null) {
    parts.push(`refined to ${percent(tolerance)}`);
  } else {
    const words = report.certified ? 'proven within' : 'within about';
    const share = percent(report.upper / data.diagonal);
    parts.push(`${words} ${length(report.upper, data.unit)} (${share} of the diagonal) of the limit surface`);
  }
  parts.push(`refined in ${seconds(report.seconds)}`);
  return parts.join(' · ');
}

/** A tolerance at the slider. */
export function toleranceWords(tolerance, data) {
  return `${percent(tolerance)} = ${length(tolerance * data.diagonal, data.unit)}`;
}

/** The names of meshes that stand side by side. */
export function labels({ report }, data) {
  const uniform = report.uniform;
  const proven = report.upper === null ? '' : `, within ${length(report.upper, data.unit)}`;
  const sampled = uniform.upper === null ? '' : `, off by ${length(uniform.upper, data.unit)} or more`;
  return [
    `adaptive: ${counted(report.triangles, 'triangle', 'triangles')}${proven}`,
    `uniform, ${counted(uniform.levels, 'level', 'levels')}: ${counted(uniform.triangles, 'triangle', 'triangles')}${sampled}`,
  ];
}

/** Why no distances are shown. */
export const NO_DISTANCES = 'No distances are known here: `limitmesh view` measures them for files with one mesh of at most 200,000 triangles.';

/** The legend's marks, and what it is about. */
export function legend(greatest, data) {
  const marks = [0, greatest / 2, greatest].map(digits);
  const unit = data.unit ? ` in ${data.unit}` : '';
  const share = percent(greatest / data.diagonal);
  return {
    marks,
    words: `Distance of the mesh from the limit surface${unit}, the greatest of samples inside each triangle; ${marks[2]} is ${share} of the diagonal.`,
  };
}
