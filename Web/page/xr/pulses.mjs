// Pulses on the motor of one gamepad, whichever way the browser has for it.

/** Sends pulses; a gamepad without a motor takes them silently. Allocates nothing itself. */
export class Pulses {
  #actuator = null;
  #effect = { duration: 0, strongMagnitude: 0, weakMagnitude: 0 };
  #onFailure = () => {
    this.#actuator = null;
  };

  /** The gamepad of an XRInputSource; null for none. A motor that failed is tried again. */
  attach(gamepad) {
    try {
      this.#actuator = gamepad?.hapticActuators?.[0] ?? gamepad?.vibrationActuator ?? null;
    } catch {
      // Where a policy forbids gamepads, this may throw, too.
      this.#actuator = null;
    }
  }

  get isAvailable() {
    return this.#actuator !== null;
  }

  /** @param {number} value 0 to 1 @param {number} durationMs until the next one replaces it */
  send(value, durationMs) {
    const actuator = this.#actuator;
    if (actuator === null) return;
    try {
      this.#started(actuator, value, durationMs)?.catch?.(this.#onFailure);
    } catch {
      this.#onFailure();
    }
  }

  #started(actuator, value, durationMs) {
    if (actuator.pulse) return actuator.pulse(value, durationMs);
    const effect = this.#effect;
    effect.duration = durationMs;
    effect.strongMagnitude = value;
    effect.weakMagnitude = value;
    return actuator.playEffect('dual-rumble', effect);
  }
}
