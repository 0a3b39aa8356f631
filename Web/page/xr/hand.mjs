import { Pulses } from './pulses.mjs';

// One hand: pose -> contact -> voice -> pulse. Knows neither three.js nor WebXR's spaces.

/** Less than that is not felt by anybody, and costs the radio link a message. */
const leastPulse = 0.005;
/** A pulse outlives its frame a little, so that a late frame leaves no gap. */
const pulseFrames = 1.5;
const longestPulseMs = 60;

/** A tip that touches, sounds and pulses. */
export class Hand {
  #scene;
  #voice;
  #motor;
  #pulses = new Pulses();
  #tip = { timeSeconds: 0, positionMetres: [0, 0, 0], forceNewtons: undefined };
  #isSuspended = false;
  #wasTouching = false;
  #knowsPlace = false;
  #isLifted = false;
  /** What the tip touches, or null. The same object in every frame. */
  contact = null;
  /** The newest pulse, 0 for none. */
  pulse = 0;
  /** The material that the hand took from the board. */
  brush = '';
  /** Distinct poses so far. */
  poses = 0;

  /**
   * @param {object} parts
   * @param {import('../../engine/js/haptoflow.d.ts').Scene} parts.scene its own: contact has a memory
   * @param {import('../../engine/js/haptoflow.d.ts').Voice} parts.voice
   */
  constructor({ scene, voice }) {
    this.#scene = scene;
    this.#voice = voice;
    this.#motor = voice.motorTap();
  }

  get voice() {
    return this.#voice;
  }

  get scene() {
    return this.#scene;
  }

  get hasMotor() {
    return this.#pulses.isAvailable;
  }

  /** The gamepad that the hand holds; null for none, and then sound is all. */
  hold(gamepad) {
    this.lift();
    this.#pulses.attach(gamepad);
  }

  /**
   * One frame. `position`: of the tip in the scene's frame, null while it is not tracked; `forceNewtons`: undefined where it is
   * not measured; `frameMs`: from frame to frame. Times must not go back.
   */
  update(timeSeconds, frameMs, position, forceNewtons) {
    if (position === null || this.#isSuspended) this.lift();
    else this.#touch(timeSeconds, position, forceNewtons);
    this.#sendPulse(frameMs);
  }

  #touch(timeSeconds, position, forceNewtons) {
    const tip = this.#tip;
    const held = tip.positionMetres;
    if (!this.#knowsPlace || held[0] !== position[0] || held[1] !== position[1] || held[2] !== position[2]) this.poses += 1;
    tip.timeSeconds = timeSeconds;
    for (let axis = 0; axis < 3; axis += 1) held[axis] = position[axis];
    tip.forceNewtons = forceNewtons;
    const contact = this.#scene.publish(this.#voice, tip);
    this.#knowsPlace = true;
    this.#isLifted = false;
    this.contact = contact.touching ? contact : null;
  }

  #sendPulse(frameMs) {
    const share = this.#motor.peak();
    const isTouching = this.contact !== null;
    // The wave of a touch that ended since the last frame is still to be felt: a tap may be shorter than a frame.
    this.pulse = (isTouching || this.#wasTouching) && share >= leastPulse ? Math.min(1, share) : 0;
    this.#wasTouching = isTouching;
    if (this.pulse > 0) this.#pulses.send(this.pulse, Math.min(longestPulseMs, pulseFrames * frameMs));
  }

  /** Nothing touches any more, and where the tip was is forgotten: what comes next is a new touch, not a jump. */
  lift() {
    this.contact = null;
    if (this.#isLifted) return;
    this.#isLifted = true;
    this.#voice.lift();
    if (!this.#knowsPlace) return;
    this.#knowsPlace = false;
    this.#scene.reset();
  }

  /** Silent at once until it is resumed. */
  suspend() {
    this.lift();
    this.#wasTouching = false;
    this.#isSuspended = true;
    this.#voice.paused = true;
  }

  resume() {
    this.#isSuspended = false;
    this.#voice.paused = false;
  }

  async close() {
    this.#motor.close();
    this.#scene.close();
    await this.#voice.close();
  }
}
