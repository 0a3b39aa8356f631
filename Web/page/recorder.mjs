import { strokeTable } from './stroke-table.mjs';

/** A clip's longest, too. */
export const longestSeconds = 600;

/** Records what tips do and what is heard, until it is stopped. */
export class Recorder {
  #tips;
  /** @type {import('../engine/js/haptoflow.d.ts').WaveTap[]} */
  #taps = [];
  /** @type {Float32Array[][]} */
  #chunks = [];
  #timer = 0;
  #began = 0;
  onLimit = () => {};

  /** @param {import('./table/tip.mjs').Tip[]} tips */
  constructor(tips) {
    this.#tips = tips;
  }

  get isRunning() {
    return this.#taps.length > 0;
  }

  get seconds() {
    return this.isRunning ? (performance.now() - this.#began) / 1000 : 0;
  }

  start() {
    if (this.isRunning) return;
    this.#began = performance.now();
    this.#taps = this.#tips.map(({ voice }) => voice.waveTap({ seconds: 20 }));
    this.#chunks = this.#tips.map(() => []);
    for (const tip of this.#tips) {
      tip.rows = [];
      tip.touched.clear();
    }
    // A hidden page's timers come once a second.
    this.#timer = setInterval(() => this.#collect(), 200);
  }

  #collect() {
    this.#taps.forEach((tap, index) => {
      const chunk = new Float32Array(tap.sampleRateHz);
      let count = tap.read(chunk);
      while (count > 0) {
        this.#chunks[index].push(chunk.slice(0, count));
        count = tap.read(chunk);
      }
    });
    if (this.seconds > longestSeconds) this.onLimit();
  }

  /**
   * Ends the recording.
   * @returns {{samples: Float32Array, rateHz: number, seconds: number, strokes: string[], materials: string[]}} strokes: STROKE.csv of each tip that moved; materials: what was touched
   */
  stop() {
    this.#collect();
    clearInterval(this.#timer);
    const rateHz = this.#taps[0].sampleRateHz;
    for (const tap of this.#taps) tap.close();
    const lengths = this.#chunks.map((chunks) => chunks.reduce((sum, chunk) => sum + chunk.length, 0));
    const samples = new Float32Array(Math.max(...lengths));
    for (const chunks of this.#chunks) {
      let at = 0;
      for (const chunk of chunks) {
        for (const sample of chunk) {
          samples[at] += sample;
          at += 1;
        }
      }
    }
    const strokes = this.#tips.map(({ rows }) => rows ?? []).filter((rows) => rows.length > 1).map(strokeTable);
    for (const tip of this.#tips) tip.rows = null;
    this.#taps = [];
    this.#chunks = [];
    const materials = [...new Set(this.#tips.flatMap(({ touched }) => [...touched]))];
    return { samples, rateHz, seconds: samples.length / rateHz, strokes, materials };
  }
}
