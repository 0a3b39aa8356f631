import { wordsOfMaterial } from './panel.mjs';

// What the panel is told, a few times a second.

const everyMs = 250;
const windowMs = 1000;

/** Turns a growing count into a rate, over the last second or so. */
export class Rate {
  #beganMs = -1;
  #beganCount = 0;
  perSecond = NaN;

  /** @param {number} nowMs @param {number} count so far */
  update(nowMs, count) {
    if (this.#beganMs >= 0 && nowMs - this.#beganMs < windowMs) return;
    if (this.#beganMs >= 0) this.perSecond = (1000 * (count - this.#beganCount)) / (nowMs - this.#beganMs);
    this.#beganMs = nowMs;
    this.#beganCount = count;
  }
}

/** Counts frames and poses, and keeps the panel up to date. */
export class Report {
  #haptics;
  #panel;
  #shownMs = -Infinity;
  #frames = 0;
  #frameRate = new Rate();
  #poseRate = new Rate();

  /** @param {{haptics: any, panel: import('./panel.mjs').Panel}} parts */
  constructor({ haptics, panel }) {
    this.#haptics = haptics;
    this.#panel = panel;
  }

  /** Frames and distinct poses of the busier hand, per second, over the last second; NaN before. */
  rates() {
    return { framesPerSecond: this.#frameRate.perSecond, posesPerSecond: this.#poseRate.perSecond };
  }

  /** One frame. `material`: touched last; `brush`: taken from the board. */
  update(timeMs, sides, material, brush) {
    this.#frames += 1;
    const [left, right] = sides;
    this.#frameRate.update(timeMs, this.#frames);
    this.#poseRate.update(timeMs, Math.max(left.hand.poses, right.hand.poses));
    if (timeMs - this.#shownMs < everyMs) return;
    this.#shownMs = timeMs;
    const { tier, lastRoundMs } = this.#haptics.statistics();
    const label = wordsOfMaterial(material);
    this.#panel.show({ label, brush, quality: tier, segmentMs: lastRoundMs, posesPerSecond: this.#poseRate.perSecond, sides: sides.map(stateOf) });
  }
}

function stateOf({ name, source, profile, isTracked, hand }) {
  return {
    name: name === 'left' ? 'Left' : 'Right',
    device: source === null ? '' : profile.name,
    isTracked,
    isTouching: hand.contact !== null,
    silence: hand.voice.statistics().silence,
    hasMotor: hand.hasMotor,
    forceNewtons: hand.contact?.forceNewtons ?? NaN,
  };
}
