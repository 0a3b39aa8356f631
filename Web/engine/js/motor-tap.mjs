import { HaptoFlowError } from './errors.mjs';

// Points for motors, from a voice's wave. The features take rates that are multiples of 2 kHz; a wave of another rate is
// brought to 48 kHz by straight lines, which lose 0.02 dB at 1 kHz and below.

const pointNumbers = 7;
const pointCapacity = 64;
const samplesAtOnce = 2048;
const waveRateHz = 2000;

/** @typedef {import('./haptoflow.d.ts').MotorPoint} MotorPoint */

export class MotorTap {
  #core;
  #tap;
  #features;
  #rateHz;
  #fullScaleMps2;
  #wave = new Float32Array(samplesAtOnce);
  #samples;
  #points;
  #startSeconds;
  /** Of the resampled wave, in samples of the tap. */
  #position = 0;
  #previous = 0;
  /** @type {MotorPoint[]} */
  #found = [];
  #peak = 0;
  #latestShare = 0;
  #isClosed = false;

  /**
   * @param {import('./module.mjs').Core} core
   * @param {import('./wave-tap.mjs').WaveTap} tap
   * @param {number} fullScaleMps2
   * @param {import('./haptoflow.d.ts').MotorOptions} options
   */
  constructor(core, tap, fullScaleMps2, { frameSeconds = 0.005, minimumFrequencyHz = 60, maximumFrequencyHz = 400 }) {
    this.#core = core;
    this.#tap = tap;
    this.#rateHz = tap.sampleRateHz % waveRateHz === 0 ? tap.sampleRateHz : 48000;
    this.#fullScaleMps2 = fullScaleMps2;
    this.#features = core.exports.hapto_motor_create(this.#rateHz, frameSeconds, minimumFrequencyHz, maximumFrequencyHz);
    if (this.#features === 0) core.call('hapto_motor_process', 0, 0, 0, 0, 0);
    // Resampling may make more of them.
    this.#samples = core.allocate(4 * samplesAtOnce * 8);
    this.#points = core.allocate(8 * pointNumbers * pointCapacity);
    this.#startSeconds = tap.secondsOf(0);
  }

  /** Copies the wave in m/s^2 into the module; returns the number of samples. */
  #copyIn(/** @type {number} */ count) {
    const target = this.#core.f32;
    const at = this.#samples >> 2;
    const scale = this.#fullScaleMps2;
    const wave = this.#wave;
    if (this.#rateHz === this.#tap.sampleRateHz) {
      for (let index = 0; index < count; index += 1) target[at + index] = scale * wave[index];
      return count;
    }
    const step = this.#tap.sampleRateHz / this.#rateHz;
    let made = 0;
    // Position -1 is the last sample of the piece before.
    while (this.#position < count - 1) {
      const left = Math.floor(this.#position);
      const first = left < 0 ? this.#previous : wave[left];
      target[at + made] = scale * (first + (this.#position - left) * (wave[left + 1] - first));
      made += 1;
      this.#position += step;
    }
    this.#previous = wave[count - 1];
    this.#position -= count;
    return made;
  }

  #process(/** @type {boolean} */ keepsPoints) {
    if (this.#isClosed) throw new HaptoFlowError('closed', 'the tap is closed');
    for (let count = this.#tap.read(this.#wave); count > 0; count = this.#tap.read(this.#wave)) {
      const samples = this.#copyIn(count);
      const frames = this.#core.exports.hapto_motor_process(this.#features, this.#samples, samples, this.#points, pointCapacity);
      const numbers = this.#core.f64;
      for (let frame = 0; frame < frames; frame += 1) {
        const at = (this.#points >> 3) + frame * pointNumbers;
        this.#latestShare = numbers[at + 4];
        this.#peak = Math.max(this.#peak, numbers[at + 4], numbers[at + 5]);
        if (keepsPoints) this.#found.push(this.#pointAt(numbers, at));
      }
    }
  }

  /** @returns {MotorPoint} */
  #pointAt(/** @type {Float64Array} */ numbers, /** @type {number} */ at) {
    return {
      timeSeconds: this.#startSeconds + numbers[at] / waveRateHz,
      durationSeconds: numbers[at + 1] / waveRateHz,
      amplitudeMps2: numbers[at + 2],
      frequencyHz: numbers[at + 3],
      share: numbers[at + 4],
      transientShare: numbers[at + 5],
      transientOffsetSeconds: numbers[at + 6],
    };
  }

  read() {
    this.#process(true);
    const found = this.#found;
    this.#found = [];
    return found;
  }

  peak() {
    this.#peak = -1;
    this.#process(false);
    // Between two frames the last one goes on.
    return this.#peak < 0 ? this.#latestShare : this.#peak;
  }

  close() {
    if (this.#isClosed) return;
    this.#isClosed = true;
    this.#tap.close();
    this.#core.exports.hapto_motor_close(this.#features);
    this.#core.free(this.#samples);
    this.#core.free(this.#points);
  }
}
