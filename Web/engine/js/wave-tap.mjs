import { HaptoFlowError } from './errors.mjs';

// The wave of a voice as it is played, for meters and for motors.

/** @typedef {{samples: Float32Array, counter: Int32Array, shared: {samples: SharedArrayBuffer, counter: SharedArrayBuffer} | null}} TapMemory */

/** Memory of `seconds` that the audio thread writes, or that the page fills from messages. */
function tapMemory(/** @type {number} */ frames, /** @type {boolean} */ isShared) {
  if (!isShared) return { samples: new Float32Array(frames), counter: new Int32Array(1), shared: null };
  const shared = { samples: new SharedArrayBuffer(4 * frames), counter: new SharedArrayBuffer(4) };
  return { samples: new Float32Array(shared.samples), counter: new Int32Array(shared.counter), shared };
}

/** What a voice's node writes while somebody listens; one for all taps of the voice. */
export class TapSource {
  /** @param {number} sampleRateHz @param {boolean} isShared */
  constructor(sampleRateHz, isShared) {
    this.sampleRateHz = sampleRateHz;
    /** @type {TapMemory} */
    this.memory = tapMemory(Math.ceil(60 * sampleRateHz), isShared);
    /** On the context's clock, of the first frame. */
    this.startSeconds = 0;
    this.last = 0;
    this.total = 0;
    /** Frames of the sources before this one. */
    this.offset = 0;
  }

  /** The node was made anew: what follows continues. @param {TapSource} before */
  continueFrom(before) {
    this.offset = before.written;
    this.total = this.offset;
  }

  /** On the context's clock. @param {number} frame of all sources' count */
  secondsOf(frame) {
    return this.startSeconds + (frame - this.offset) / this.sampleRateHz;
  }

  /** Frames written since the beginning; the counter itself has 32 bits. */
  get written() {
    const now = Atomics.load(this.memory.counter, 0);
    this.total += (now - this.last) >>> 0;
    this.last = now;
    return this.total;
  }

  /** Without shared memory. @param {Float32Array} block */
  write(block) {
    const { samples, counter } = this.memory;
    let at = (counter[0] >>> 0) % samples.length;
    for (const sample of block) {
      samples[at] = sample;
      at = at + 1 === samples.length ? 0 : at + 1;
    }
    counter[0] += block.length;
  }

  /**
   * Copies frames [first, first + count) of all sources' count, which must be in memory; those of an earlier source are lost
   * and become zeros.
   * @param {number} first
   * @param {Float32Array} into
   * @param {number} count
   */
  copy(first, into, count) {
    const { samples } = this.memory;
    const lost = Math.min(count, Math.max(0, this.offset - first));
    into.fill(0, 0, lost);
    let at = (first + lost - this.offset) % samples.length;
    for (let index = lost; index < count; index += 1) {
      into[index] = samples[at];
      at = at + 1 === samples.length ? 0 : at + 1;
    }
  }
}

/** One reader of a voice's wave. */
export class WaveTap {
  #voice;
  #begin;
  #read;
  #frames;
  #isClosed = false;

  /** @param {import('./voice.mjs').Voice} voice @param {number} seconds */
  constructor(voice, seconds) {
    this.#voice = voice;
    this.#begin = this.#source.written;
    this.#read = this.#begin;
    this.#frames = Math.ceil(seconds * this.#source.sampleRateHz);
  }

  get #source() {
    if (this.#isClosed) throw new HaptoFlowError('closed', 'the tap is closed');
    return /** @type {TapSource} */ (this.#voice.tapSource);
  }

  get sampleRateHz() {
    return this.#source.sampleRateHz;
  }

  get written() {
    return this.#source.written - this.#begin;
  }

  /** On the context's clock, of a frame of this tap's count. @param {number} frame */
  secondsOf(frame) {
    return this.#source.secondsOf(this.#begin + frame);
  }

  /** @param {Float32Array} into */
  latest(into) {
    const end = this.#source.written;
    const count = Math.min(into.length, end - this.#begin, this.#frames);
    into.fill(0, 0, into.length - count);
    this.#source.copy(end - count, count === into.length ? into : into.subarray(into.length - count), count);
  }

  /** @param {Float32Array} into */
  read(into) {
    const end = this.#source.written;
    this.#read = Math.max(this.#read, end - this.#frames);
    const count = Math.min(into.length, end - this.#read);
    this.#source.copy(this.#read, into, count);
    this.#read += count;
    return count;
  }

  close() {
    if (this.#isClosed) return;
    this.#isClosed = true;
    this.#voice.releaseTap();
  }
}
