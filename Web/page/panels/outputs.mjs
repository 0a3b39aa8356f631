import { find } from '../dom.mjs';

const vibrationMs = 50;
const leastShare = 0.03;
const rumbleMs = 60;
const vibrationName = 'Vibration of this phone';
const rumbleName = 'Rumble of a gamepad';

/** Where the signal goes besides the loudspeaker: a phone's motor and a gamepad's, by the envelope of the motor output. */
export class Outputs {
  #voices;
  #messages;
  /** @type {import('../../engine/js/haptoflow.d.ts').MotorTap[]} */
  #taps = [];
  #vibration = find('#output-vibration');
  #rumble = find('#output-rumble');
  #note = find('#output-note');
  #vibratedAt = 0;
  #rumbledAt = 0;
  #isRumbling = false;

  /** @param {readonly import('../../engine/js/haptoflow.d.ts').Voice[]} voices @param {import('../messages.mjs').Messages} messages */
  constructor(voices, messages) {
    this.#voices = voices;
    this.#messages = messages;
    if (typeof navigator.vibrate !== 'function') this.#giveUp(this.#vibration, vibrationName);
    if (typeof navigator.getGamepads !== 'function') this.#giveUp(this.#rumble, rumbleName);
    for (const input of [this.#vibration, this.#rumble]) input.addEventListener('change', () => this.#switch());
    for (const type of ['gamepadconnected', 'gamepaddisconnected']) addEventListener(type, () => this.#describe());
    this.#describe();
  }

  /** A motor that the page does without from now on. @param {any} [why] */
  #giveUp(/** @type {any} */ input, /** @type {string} */ name, why) {
    input.checked = false;
    input.disabled = true;
    this.#messages.missing(name, why);
  }

  #gamepad() {
    if (this.#rumble.disabled) return null;
    try {
      // getGamepads throws where a policy forbids gamepads.
      return Array.from(navigator.getGamepads() ?? []).find((gamepad) => gamepad?.vibrationActuator) ?? null;
    } catch (error) {
      this.#giveUp(this.#rumble, rumbleName, error);
      return null;
    }
  }

  #describe() {
    const gamepad = this.#gamepad();
    const seen = gamepad ? `Gamepad: ${gamepad.id}.` : 'No gamepad with a motor was seen: press one of its buttons.';
    this.#note.textContent = this.#rumble.disabled ? '' : seen;
  }

  #vibrate(/** @type {number} */ milliseconds) {
    try {
      if (navigator.vibrate(milliseconds) === false) this.#messages.missing(vibrationName, 'the browser refuses it, as some do in a frame of another origin and before a tap');
      else this.#messages.found(vibrationName);
    } catch (error) {
      this.#giveUp(this.#vibration, vibrationName, error);
      this.#switch();
    }
  }

  async #shake(/** @type {number} */ strength) {
    try {
      const motor = this.#gamepad()?.vibrationActuator;
      if (!motor) return;
      // The small motor turns fast, which is nearer to a texture.
      await motor.playEffect('dual-rumble', { duration: rumbleMs, weakMagnitude: strength, strongMagnitude: 0.4 * strength });
      this.#messages.found(rumbleName);
    } catch (error) {
      this.#messages.missing(rumbleName, error);
    }
  }

  #switch() {
    const isOn = this.#vibration.checked || this.#rumble.checked;
    if (isOn && this.#taps.length === 0) this.#taps = this.#voices.map((voice) => voice.motorTap());
    if (!isOn) {
      for (const tap of this.#taps) tap.close();
      this.#taps = [];
    }
  }

  /** @param {number} nowMs */
  frame(nowMs) {
    if (this.#taps.length === 0) return;
    const share = Math.min(1, this.#taps.reduce((largest, tap) => Math.max(largest, tap.peak()), 0));
    if (this.#vibration.checked && nowMs - this.#vibratedAt >= vibrationMs) {
      this.#vibratedAt = nowMs;
      // A phone's motor has no strength: the share of time stands for it.
      if (share > leastShare) this.#vibrate(Math.round(share * vibrationMs));
    }
    if (this.#rumble.checked && nowMs - this.#rumbledAt >= rumbleMs / 2) {
      this.#rumbledAt = nowMs;
      const isFelt = share > leastShare;
      if (isFelt || this.#isRumbling) void this.#shake(isFelt ? share : 0);
      this.#isRumbling = isFelt;
    }
  }
}
