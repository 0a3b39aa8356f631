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

/** @typedef {{timeSeconds: number, positionMetres: readonly number[], forceNewtons: number, orientation: readonly number[] | null}} StrokeRow */

const number = (/** @type {number} */ value, /** @type {number} */ digits) => String(Number(value.toFixed(digits)));

/**
 * STROKE.csv of Documentation~/scene-and-stroke.md, with orientations if every row has one. A tip in the air has no measured force.
 * @param {StrokeRow[]} rows
 */
export function strokeTable(rows) {
  const isOriented = rows.length > 0 && rows.every(({ orientation }) => orientation !== null);
  const lines = rows.map(({ timeSeconds, positionMetres, forceNewtons, orientation }) => [
    number(timeSeconds, 6),
    ...positionMetres.map((value) => number(value, 7)),
    number(forceNewtons, 4),
    ...(isOriented && orientation ? orientation.map((value) => number(value, 5)) : []),
  ].join(','));
  return `${['t,x,y,z,force', isOriented ? ',qx,qy,qz,qw' : '', '\n'].join('')}${lines.map((line) => `${line}\n`).join('')}`;
}

/**
 * A WAV file of one channel of 32-bit floats.
 * @param {Float32Array} samples @param {number} rateHz @returns {Uint8Array}
 */
export function wavBytes(samples, rateHz) {
  const bytes = new Uint8Array(58 + 4 * samples.length);
  const view = new DataView(bytes.buffer);
  const word = (/** @type {number} */ at, /** @type {string} */ text) => [...text].forEach((letter, index) => view.setUint8(at + index, letter.charCodeAt(0)));
  word(0, 'RIFF');
  view.setUint32(4, bytes.length - 8, true);
  word(8, 'WAVEfmt ');
  view.setUint32(16, 18, true);
  view.setUint16(20, 3, true);
  view.setUint16(22, 1, true);
  view.setUint32(24, rateHz, true);
  view.setUint32(28, 4 * rateHz, true);
  view.setUint16(32, 4, true);
  view.setUint16(34, 32, true);
  view.setUint16(36, 0, true);
  // Files of floats state their number of samples.
  word(38, 'fact');
  view.setUint32(42, 4, true);
  view.setUint32(46, samples.length, true);
  word(50, 'data');
  view.setUint32(54, 4 * samples.length, true);
  for (let index = 0; index < samples.length; index += 1) view.setFloat32(58 + 4 * index, samples[index], true);
  return bytes;
}
