// Where a surface of a scene is at a time, for drawing. The contact model has its own answer (NativePlugin/headless/motion.cpp),
// which a page cannot ask for yet; Tests/Web/xr-motion.test.mjs holds the two together.

const still = { position: [0, 0, 0], rotation: [0, 0, 0, 1] };

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
    this.#keyframes = keyframes.map(({ t, position = still.position, rotation = still.rotation }) => ({ t, position, rotation: normalised(rotation), velocity: [0, 0, 0] }));
    this.#setVelocities();
    this.#rest(this.#keyframes[0]);
  }

  get isMoving() {
    return this.#keyframes.length > 1;
  }

  #setVelocities() {
    const frames = this.#keyframes;
    const last = frames.length - 1;
    const isClosed = this.#isLoop && last > 1 && Math.hypot(...frames[0].position.map((part, axis) => part - frames[last].position[axis])) < 1e-9;
    frames.forEach((frame, index) => {
      const isEnd = index === 0 || index === last;
      const from = isEnd && isClosed ? last - 1 : Math.max(0, index - 1);
      const to = isEnd && isClosed ? 1 : Math.min(last, index + 1);
      const seconds = isEnd && isClosed ? frames[1].t - frames[0].t + frames[last].t - frames[last - 1].t : frames[to].t - frames[from].t;
      if (seconds > 0) frame.velocity = frame.position.map((_, axis) => (frames[to].position[axis] - frames[from].position[axis]) / seconds);
    });
  }

  #rest(frame) {
    for (let axis = 0; axis < 3; axis += 1) this.position[axis] = frame.position[axis];
    for (let part = 0; part < 4; part += 1) this.rotation[part] = frame.rotation[part];
  }

  /** Sets `position` and `rotation` to those of a time. */
  at(timeSeconds) {
    const frames = this.#keyframes;
    const first = frames[0].t;
    const last = frames[frames.length - 1].t;
    let time = timeSeconds;
    if (this.#isLoop && last > first) time -= (last - first) * Math.floor((time - first) / (last - first));
    if (time <= first || time >= last) {
      this.#rest(time <= first ? frames[0] : frames[frames.length - 1]);
      return this;
    }
    let right = 1;
    while (frames[right].t <= time) right += 1;
    const a = frames[right - 1];
    const b = frames[right];
    const span = b.t - a.t;
    const u = (time - a.t) / span;
    const toB = u * u * (3 - 2 * u);
    const leaving = span * u * (1 - u) * (1 - u);
    const arriving = span * u * u * (u - 1);
    for (let axis = 0; axis < 3; axis += 1) {
      this.position[axis] = a.position[axis] + toB * (b.position[axis] - a.position[axis]) + leaving * a.velocity[axis] + arriving * b.velocity[axis];
    }
    between(a.rotation, b.rotation, u, this.rotation);
    return this;
  }
}
