import { parseCsv } from './csv.mjs';
import { labelsOf } from './labels.mjs';

/**
 * Combines a stroke with the contact states that `haptoflow contact` computed for it.
 * @returns {{timeSeconds: number, position: number[], touching: boolean, label: string | null, speedMps: number, forceNewtons: number}[]}
 *   times are relative to the start of the stroke; speed is tangential to the surface, 0 without touch
 */
export function readContacts(contactCsv, strokeCsv, scene) {
  const stroke = parseCsv(strokeCsv, 'stroke', ['t', 'x', 'y', 'z']).map((row) => ({
    timeSeconds: Number(row.t),
    position: [Number(row.x), Number(row.y), Number(row.z)],
  }));
  const labelOf = new Map(scene.surfaces.map((surface) => [surface.name, labelsOf(surface.material)[0]]));
  const rows = parseCsv(contactCsv, 'haptoflow contact', ['t', 'surface', 'touching', 'vx_mps', 'vy_mps', 'force_n']);
  const start = stroke[0].timeSeconds;
  let next = 0;
  return rows.map((row) => {
    const time = Number(row.t);
    while (next < stroke.length - 2 && stroke[next + 1].timeSeconds < time) next += 1;
    const touching = row.touching === '1';
    return {
      timeSeconds: time - start,
      position: between(stroke[next], stroke[next + 1] ?? stroke[next], time),
      touching,
      label: touching ? (labelOf.get(row.surface) ?? row.surface) : null,
      speedMps: Math.hypot(Number(row.vx_mps), Number(row.vy_mps)),
      forceNewtons: Number(row.force_n),
    };
  });
}

function between(from, to, time) {
  const span = to.timeSeconds - from.timeSeconds;
  const share = span > 0 ? Math.max(0, Math.min(1, (time - from.timeSeconds) / span)) : 0;
  return from.position.map((value, axis) => value + share * (to.position[axis] - value));
}
