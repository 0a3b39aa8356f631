// Where a moving surface is: the curve of NativePlugin/headless/motion.cpp, for its picture and its height.

/** @typedef {{t: number, position: number[]}} Keyframe */

const chord = (/** @type {Keyframe} */ from, /** @type {Keyframe} */ to, /** @type {number} */ axis) => (to.position[axis] - from.position[axis]) / (to.t - from.t);

function velocityAt(/** @type {Keyframe[]} */ keyframes, /** @type {number} */ index, /** @type {number} */ axis, /** @type {boolean} */ isClosed) {
  const last = keyframes.length - 1;
  if (index > 0 && index < last) return chord(keyframes[index - 1], keyframes[index + 1], axis);
  if (isClosed && last > 1) {
    const seconds = keyframes[1].t - keyframes[0].t + keyframes[last].t - keyframes[last - 1].t;
    return (keyframes[1].position[axis] - keyframes[last - 1].position[axis]) / seconds;
  }
  return index === 0 ? chord(keyframes[0], keyframes[1], axis) : chord(keyframes[last - 1], keyframes[last], axis);
}

/**
 * Writes the position of a motion at a time; rotations of the page's scene do not change.
 * @param {{keyframes: Keyframe[], loop?: boolean}} motion
 * @param {number} timeSeconds
 * @param {number[]} into
 */
export function positionAt({ keyframes, loop = false }, timeSeconds, into) {
  const first = keyframes[0];
  const last = keyframes[keyframes.length - 1];
  const period = last.t - first.t;
  const time = loop ? first.t + (timeSeconds - first.t) - period * Math.floor((timeSeconds - first.t) / period) : Math.min(Math.max(timeSeconds, first.t), last.t);
  let right = 1;
  while (right < keyframes.length - 1 && keyframes[right].t <= time) right += 1;
  const a = keyframes[right - 1];
  const b = keyframes[right];
  const span = b.t - a.t;
  const u = (time - a.t) / span;
  const isClosed = loop && first.position.every((value, axis) => Math.abs(value - last.position[axis]) < 1e-9);
  for (let axis = 0; axis < 3; axis += 1) {
    into[axis] = a.position[axis] + u * u * (3 - 2 * u) * (b.position[axis] - a.position[axis])
      + span * u * (1 - u) * (1 - u) * velocityAt(keyframes, right - 1, axis, isClosed)
      + span * u * u * (u - 1) * velocityAt(keyframes, right, axis, isClosed);
  }
  return into;
}
