// Strokes for keyboards and comparisons. Every leg is a minimum-jerk movement: x(s) = 10 s^3 - 15 s^4 + 6 s^5 (Flash and Hogan,
// 1985).

/** @typedef {{to: [number, number], seconds: number, isLifted?: boolean, newtons?: number}} Leg */
/** @typedef {{name: string, words: string, from: [number, number], legs: Leg[]}} PresetStroke */

const smooth = (/** @type {number} */ s) => s * s * s * (10 - 15 * s + 6 * s * s);
const backAndForth = (/** @type {[number, number]} */ a, /** @type {[number, number]} */ b, /** @type {number} */ seconds, /** @type {number} */ times) =>
  Array.from({ length: 2 * times }, (_, index) => /** @type {Leg} */ ({ to: index % 2 === 0 ? b : a, seconds }));
const rest = (/** @type {[number, number]} */ at, /** @type {number} */ seconds) => /** @type {Leg} */ ({ to: at, seconds });
const taps = (/** @type {[number, number]} */ at, /** @type {number} */ times) =>
  Array.from({ length: 2 * times }, (_, index) => /** @type {Leg} */ ({ to: at, seconds: index % 2 === 0 ? 0.12 : 0.28, isLifted: index % 2 === 1 }));

/** @type {PresetStroke[]} */
export const presetStrokes = [
  { name: 'Across the table', words: 'rod, desk, grille, stone', from: [-0.235, 0.004], legs: [{ to: [0.235, 0.004], seconds: 3 }, { to: [-0.235, 0.004], seconds: 2 }] },
  { name: 'Along the front', words: 'sandpaper, jute, paper, carpet', from: [-0.235, -0.112], legs: [{ to: [0.235, -0.112], seconds: 3.6 }] },
  { name: 'Across the ribs', words: 'corduroy, then along its ribs', from: [-0.09, 0.096], legs: [...backAndForth([-0.09, 0.096], [-0.034, 0.128], 0.8, 2), { to: [-0.075, 0.134], seconds: 0.5 }, ...backAndForth([-0.075, 0.134], [-0.049, 0.089], 0.8, 1)] },
  { name: 'Over the mosaic', words: 'ceramic and leather in turn, and the grout between', from: [0.03, 0.133], legs: [{ to: [0.098, 0.133], seconds: 0.9 }, { to: [0.098, 0.092], seconds: 0.6 }, { to: [0.03, 0.092], seconds: 0.9 }, { to: [0.03, 0.133], seconds: 0.6 }] },
  { name: 'Across the boards', words: 'wood, and a gap every 60 millimetres', from: [-0.12, -0.165], legs: [{ to: [-0.12, 0.165], seconds: 3 }, { to: [-0.12, -0.165], seconds: 2 }] },
  { name: 'Over the word', words: 'paper, and four raised letters', from: [0.022, -0.112], legs: backAndForth([0.022, -0.112], [0.102, -0.112], 1.4, 1) },
  { name: 'Over the dome', words: 'rubber, up and down', from: [0.158, 0.112], legs: backAndForth([0.158, 0.112], [0.212, 0.112], 0.9, 2) },
  { name: 'Rest on the grille', words: 'the hand is still, the grille moves', from: [0, 0.004], legs: [rest([0, 0.004], 8)] },
  { name: 'Three taps', words: 'glass', from: [-0.185, 0.112], legs: taps([-0.185, 0.112], 3) },
];

/** @param {PresetStroke} stroke @param {number} speedScale 1 is the stroke's own speed */
export const secondsOf = (stroke, speedScale) => stroke.legs.reduce((sum, { seconds }) => sum + seconds, 0) / speedScale;

/**
 * Where a stroke is.
 * @param {PresetStroke} stroke @param {number} seconds since it began @param {number} speedScale
 * @returns {{x: number, z: number, isTouching: boolean, newtons?: number}} after its end, its end, lifted
 */
export function strokeAt(stroke, seconds, speedScale) {
  let from = stroke.from;
  let left = seconds * speedScale;
  for (const leg of stroke.legs) {
    if (left < leg.seconds) {
      const share = smooth(Math.max(0, left / leg.seconds));
      return { x: from[0] + share * (leg.to[0] - from[0]), z: from[1] + share * (leg.to[1] - from[1]), isTouching: !leg.isLifted, newtons: leg.newtons };
    }
    left -= leg.seconds;
    from = leg.to;
  }
  return { x: from[0], z: from[1], isTouching: false };
}
