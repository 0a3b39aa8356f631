import { positionAt } from '../table/motion.mjs';

// Where a surface of a scene is at a time, for drawing. The contact model has its own answer (NativePlugin/headless/motion.cpp),
// which a page cannot ask for; Tests/Web/xr-motion.test.mjs holds the two together.

function normalised(rotation) {
  const length = Math.hypot(...rotation);
  return rotation.map((part) => part / length);
}

/** The shorter way from one rotation to another at a constant rate. */
function between(a, b, share, into) {
  let cosine = 0;
  for (let part = 0; part < 4; part += 1) cosine += a[part] * b[part];
  const sign = cosine < 0 ? -1 : 1;
  const angle = Math.acos(Math.min(1, Math.abs(cosine)));
  const sine = Math.sin(angle);
  const isSmall = sine < 1e-6;
  const left = isSmall ? 1 - share : Math.sin((1 - share) * angle) / sine;
  const right = sign * (isSmall ? share : Math.sin(share * angle) / sine);
  for (let part = 0; part < 4; part += 1) into[part] = left * a[part] + right * b[part];
}

/** The pose of a surface of SCENE.json over time, in the scene's frame. */
export class Motion {
  position = [0, 0, 0];
  rotation = [0, 0, 0, 1];
  #keyframes;
  #isLoop;

  constructor(surface) {
    const { keyframes = [{ t: 0, ...surface }], loop = false } = surface.motion ?? {};
    this.#isLoop = loop;
    this.#keyframes = keyframes.map(({ t, position = [0, 0, 0], rotation = [0, 0, 0, 1] }) => ({ t, position: [...position], rotation: normalised(rotation) }));
    this.position = [...this.#keyframes[0].position];
    this.rotation = [...this.#keyframes[0].rotation];
  }

  get isMoving() {
    return this.#keyframes.length > 1;
  }

  /** Sets `position` and `rotation` to those of a time. */
  at(timeSeconds) {
    if (!this.isMoving) return;
    const frames = this.#keyframes;
    positionAt({ keyframes: frames, loop: this.#isLoop }, timeSeconds, this.position);
    const first = frames[0].t;
    const last = frames[frames.length - 1].t;
    const period = last - first;
    const time = this.#isLoop ? timeSeconds - period * Math.floor((timeSeconds - first) / period) : Math.min(last, Math.max(first, timeSeconds));
    let right = 1;
    while (right < frames.length - 1 && frames[right].t <= time) right += 1;
    const a = frames[right - 1];
    const b = frames[right];
    between(a.rotation, b.rotation, (time - a.t) / (b.t - a.t), this.rotation);
  }
}
