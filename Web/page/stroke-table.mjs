/** @typedef {{timeSeconds: number, positionMetres: readonly number[], forceNewtons: number, orientation: readonly number[] | null}} StrokeRow */

const number = (/** @type {number} */ value, /** @type {number} */ digits) => String(Number(value.toFixed(digits)));

/**
 * STROKE.csv of Documentation~/scene-and-stroke.md, with orientations if every row has one. A tip in the air has no measured force.
 * @param {StrokeRow[]} rows
 */
export function strokeTable(rows) {
  const isOriented = rows.length > 0 && rows.every(({ orientation }) => orientation !== null);
  const lines = rows.map(({ timeSeconds, positionMetres, forceNewtons, orientation }) => [
    number(timeSeconds, 6),
    ...positionMetres.map((value) => number(value, 7)),
    number(forceNewtons, 4),
    ...(isOriented && orientation ? orientation.map((value) => number(value, 5)) : []),
  ].join(','));
  return `${['t,x,y,z,force', isOriented ? ',qx,qy,qz,qw' : '', '\n'].join('')}${lines.map((line) => `${line}\n`).join('')}`;
}

/** A pen's turn from upright, from its tilt towards x and y of the screen in degrees, as x, y, z, w in the scene's frame. */
export function orientationOf(/** @type {number} */ tiltXDegrees, /** @type {number} */ tiltYDegrees) {
  const towardsX = Math.tan((tiltXDegrees * Math.PI) / 180);
  const towardsZ = -Math.tan((tiltYDegrees * Math.PI) / 180);
  const lean = Math.hypot(towardsX, towardsZ);
  if (lean < 1e-9) return [0, 0, 0, 1];
  const half = Math.atan(lean) / 2;
  // The axis is up x lean, in a left-handed frame: y towards x is a negative turn about z.
  return [(Math.sin(half) * towardsZ) / lean, 0, (-Math.sin(half) * towardsX) / lean, Math.cos(half)];
}
