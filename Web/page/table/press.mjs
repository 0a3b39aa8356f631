// How hard a hand without a force sensor presses: at once to the chosen force, then harder while it is held still.

const attackSeconds = 0.03;
const stillMps = 0.01;
const growthNewtonsPerSecond = 1;
export const largestForceNewtons = 2;

/** One touch of a mouse, a finger or a key. */
export class Press {
  #grown = 0;
  #age = 0;

  begin() {
    this.#grown = 0;
    this.#age = 0;
  }

  /**
   * The force after `seconds` more.
   * @param {number} seconds since the last call @param {number} speedMps of the tip @param {number} chosenNewtons
   */
  force(seconds, speedMps, chosenNewtons) {
    this.#age += seconds;
    if (speedMps < stillMps) this.#grown += growthNewtonsPerSecond * seconds;
    this.#grown = Math.min(this.#grown, Math.max(0, largestForceNewtons - chosenNewtons));
    const share = Math.min(1, 0.3 + (0.7 * this.#age) / attackSeconds);
    return Math.min(largestForceNewtons, share * chosenNewtons + this.#grown);
  }
}

/** The force of a pointer that measures its pressure, 0 to 1: a pen's full pressure is `largestForceNewtons`. */
export const penForce = (/** @type {number} */ pressure) => Math.max(0.02, pressure * largestForceNewtons);
