/** Power spectra of real blocks whose length is a power of two, with a Hann window. */
export class Spectrum {
  #real;
  #imaginary;
  #window;
  #order;

  /** @param {number} length */
  constructor(length) {
    this.length = length;
    this.#real = new Float64Array(length);
    this.#imaginary = new Float64Array(length);
    this.#window = Float64Array.from({ length }, (_, index) => 0.5 - 0.5 * Math.cos((2 * Math.PI * index) / length));
    const bits = Math.log2(length);
    this.#order = Uint32Array.from({ length }, (_, index) => {
      let turned = 0;
      for (let bit = 0; bit < bits; bit += 1) turned |= ((index >> bit) & 1) << (bits - 1 - bit);
      return turned;
    });
  }

  /**
   * Mean square of each band, so that their sum is about the block's mean square.
   * @param {Float32Array} block @param {Float32Array} into length / 2 bands
   */
  power(block, into) {
    const { length } = this;
    const [real, imaginary] = [this.#real, this.#imaginary];
    for (let index = 0; index < length; index += 1) {
      real[this.#order[index]] = block[index] * this.#window[index];
      imaginary[index] = 0;
    }
    for (let half = 1; half < length; half *= 2) {
      for (let step = 0; step < half; step += 1) {
        const cos = Math.cos((-Math.PI * step) / half);
        const sin = Math.sin((-Math.PI * step) / half);
        for (let at = step; at < length; at += 2 * half) {
          const [a, b] = [real[at + half] * cos - imaginary[at + half] * sin, real[at + half] * sin + imaginary[at + half] * cos];
          real[at + half] = real[at] - a;
          imaginary[at + half] = imaginary[at] - b;
          real[at] += a;
          imaginary[at] += b;
        }
      }
    }
    // The window's own mean square is 3/8.
    const scale = 2 / (length * length * 0.375);
    for (let band = 0; band < into.length; band += 1) into[band] = scale * (real[band] * real[band] + imaginary[band] * imaginary[band]);
  }
}
