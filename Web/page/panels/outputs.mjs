import { find } from '../dom.mjs';

const vibrationMs = 50;
const leastShare = 0.03;
const rumbleMs = 60;

/** Where the signal goes besides the loudspeaker: a phone's motor and a gamepad's, by the envelope of the motor output. */
export class Outputs {
  #voices;
  /** @type {import('../../engine/js/haptoflow.d.ts').MotorTap[]} */
  #taps = [];
  #vibration = find('#output-vibration');
  #rumble = find('#output-rumble');
  #note = find('#output-note');
  #vibratedAt = 0;
  #rumbledAt = 0;
  #isRumbling = false;

  /** @param {readonly import('../../engine/js/haptoflow.d.ts').Voice[]} voices */
  constructor(voices) {
    this.#voices = voices;
    this.#vibration.disabled = typeof navigator.vibrate !== 'function';
    for (const input of [this.#vibration, this.#rumble]) input.addEventListener('change', () => this.#switch());
    for (const type of ['gamepadconnected', 'gamepaddisconnected']) addEventListener(type, () => this.#describe());
    this.#describe();
  }

  #gamepad() {
    return navigator.getGamepads?.().find((gamepad) => gamepad?.vibrationActuator) ?? null;
  }

  #describe() {
    const gamepad = this.#gamepad();
    this.#note.textContent = [
      this.#vibration.disabled ? 'This browser has no vibration motor for pages.' : '',
      gamepad ? `Gamepad: ${gamepad.id}.` : 'No gamepad with a motor was seen: press one of its buttons.',
    ].filter(Boolean).join(' ');
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
      if (share > leastShare) navigator.vibrate(Math.round(share * vibrationMs));
    }
    if (this.#rumble.checked && nowMs - this.#rumbledAt >= rumbleMs / 2) {
      this.#rumbledAt = nowMs;
      const isFelt = share > leastShare;
      if (isFelt || this.#isRumbling) {
        // The small motor turns fast, which is nearer to a texture.
        const strength = isFelt ? share : 0;
        this.#gamepad()?.vibrationActuator?.playEffect('dual-rumble', { duration: rumbleMs, weakMagnitude: strength, strongMagnitude: 0.4 * strength }).catch(() => {});
      }
      this.#isRumbling = isFelt;
    }
  }
}
