// How often something happens, over the last second or so.

const windowMs = 1000;

/** Turns a growing count into a rate. */
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
