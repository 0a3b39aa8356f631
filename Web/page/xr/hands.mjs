import { rotate } from './frames.mjs';
import { isDocked, profileOf, tipForceNewtons } from './profiles.mjs';

// The input sources of a session in two hands, and their poses in each frame. Knows WebXR, not three.js.

/** What one side holds, and where. */
class Side {
  /** @type {any} an XRInputSource, or null */
  source = null;
  /** @type {import('./profiles.mjs').Profile | null} */
  profile = null;
  isTracked = false;
  /** Whether the source ever measured its position: one that never does has nothing better than its guess. */
  #measures = false;
  /** Of the tip, in the room. */
  position = new Float64Array(3);
  orientation = new Float64Array([0, 0, 0, 1]);
  /** Of the tip, in the scene's frame. */
  tip = new Float64Array(3);

  /** @param {'left' | 'right'} name @param {import('./hand.mjs').Hand} hand */
  constructor(name, hand) {
    this.name = name;
    this.hand = hand;
  }

  take(source) {
    if (source === this.source) return;
    this.source = source;
    this.profile = source && profileOf(source);
    this.isTracked = false;
    this.#measures = false;
    this.hand.hold(source?.gamepad ?? null);
  }

  /** Reads the pose. A position that is guessed while tracking fails is none: it would scratch, and jump when the true one comes. */
  track(frame, space) {
    const { source, profile } = this;
    const place = source && (profile.joint ? source.hand.get(profile.joint) : source.targetRaySpace);
    const pose = place ? (profile.joint ? frame.getJointPose?.(place, space) : frame.getPose(place, space)) : null;
    if (pose && !pose.emulatedPosition) this.#measures = true;
    this.isTracked = Boolean(pose) && !(pose.emulatedPosition && this.#measures) && !isDocked(profile, source.gamepad);
    if (!this.isTracked) return;
    const { position, orientation } = pose.transform;
    this.orientation[0] = orientation.x;
    this.orientation[1] = orientation.y;
    this.orientation[2] = orientation.z;
    this.orientation[3] = orientation.w;
    rotate(this.orientation, profile.tipMetres, this.position);
    this.position[0] += position.x;
    this.position[1] += position.y;
    this.position[2] += position.z;
  }
}

/** Both hands. */
export class Hands {
  #placement;
  #newtonsAtFullPressure;
  #isSuspended = false;
  /** @type {[Side, Side]} */
  sides;

  /**
   * @param {object} parts
   * @param {import('./hand.mjs').Hand} parts.left
   * @param {import('./hand.mjs').Hand} parts.right
   * @param {import('./frames.mjs').Placement} parts.placement
   * @param {number} parts.newtonsAtFullPressure
   */
  constructor({ left, right, placement, newtonsAtFullPressure }) {
    this.sides = [new Side('left', left), new Side('right', right)];
    this.#placement = placement;
    this.#newtonsAtFullPressure = newtonsAtFullPressure;
  }

  /** Takes what the session has now. A source of neither hand goes to a free one, the right first. */
  bind(sources) {
    const held = Array.from(sources).filter((source) => profileOf(source) !== null);
    const [left, right] = this.sides;
    const sided = (name) => held.find(({ handedness }) => handedness === name) ?? null;
    const unsided = held.filter(({ handedness }) => handedness !== 'left' && handedness !== 'right');
    right.take(sided('right') ?? unsided.shift() ?? null);
    left.take(sided('left') ?? unsided.shift() ?? null);
  }

  /** @returns {Side | undefined} */
  sideOf(source) {
    return this.sides.find((side) => side.source === source);
  }

  /** Follows both hands for one frame of the session; `space` is the room's reference space. */
  update(frame, space, timeSeconds, frameMs) {
    for (const side of this.sides) {
      side.track(frame, space);
      const tip = side.isTracked ? this.#placement.toScene(side.position, side.tip) : null;
      const force = side.profile ? tipForceNewtons(side.profile, side.source.gamepad, this.#newtonsAtFullPressure) : undefined;
      side.hand.update(timeSeconds, frameMs, tip, force);
    }
  }

  /** After the room's origin has moved. */
  lift() {
    for (const { hand } of this.sides) hand.lift();
  }

  set isSuspended(value) {
    if (value === this.#isSuspended) return;
    this.#isSuspended = value;
    for (const { hand } of this.sides) {
      if (value) hand.suspend();
      else hand.resume();
    }
  }

  get isSuspended() {
    return this.#isSuspended;
  }

  async close() {
    await Promise.all(this.sides.map(({ hand }) => hand.close()));
  }
}
