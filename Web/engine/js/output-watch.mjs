import { pause } from './pause.mjs';

// When the only output of a context is unplugged, Chromium stops the context for good: not even `resume` starts it again, though
// another output is there. So the context is told to play to no output, which keeps motors and pictures going, and once a second
// whether there is an output to play to.

const lookEveryMs = 1000;
/** An output that has just gone may still be listed, and a context on it says that it runs. Its time stands still, though, if not at once. */
const settlingMs = 1000;
const proofMs = 300;

/** Keeps a context running without its output, and gives it the next one. */
export class OutputWatch {
  #context;
  #onChange;
  /** @type {ReturnType<typeof setInterval> | undefined} */
  #timer;
  #isLooking = false;
  #hasLost = false;
  #errors = 0;

  /** @param {any} context @param {(state: 'lost' | 'stopped' | 'back') => void} onChange */
  constructor(context, onChange) {
    this.#context = context;
    this.#onChange = onChange;
    context.addEventListener('error', this.#onError);
  }

  /** Whether the context plays to no output, because it lost its own. */
  get hasLost() {
    return this.#hasLost;
  }

  #onError = () => {
    this.#errors += 1;
    if (this.#hasLost) return;
    this.#hasLost = true;
    if (!this.#context.setSinkId) {
      this.#onChange('stopped');
      return;
    }
    this.#onChange('lost');
    void this.#playTo({ type: 'none' });
    this.#timer = setInterval(() => void this.#look(), lookEveryMs);
  };

  /** @returns {Promise<boolean>} whether the context took that output */
  async #playTo(/** @type {string | {type: 'none'}} */ output) {
    try {
      await this.#context.setSinkId(output);
    } catch {
      return false;
    }
    // It may wait for an output that never comes.
    void this.#context.resume().catch(() => {});
    return true;
  }

  async #playsToNextOutput() {
    const errorsBefore = this.#errors;
    if (!await this.#playTo('')) return false;
    await pause(settlingMs);
    const before = this.#context.currentTime;
    await pause(proofMs);
    return this.#errors === errorsBefore && this.#context.currentTime > before;
  }

  async #look() {
    if (this.#isLooking) return;
    this.#isLooking = true;
    // Chromium takes note of a new output when it is asked for all.
    const devices = await navigator.mediaDevices?.enumerateDevices().catch(() => []);
    const isBack = devices?.some(({ kind }) => kind === 'audiooutput') === true && await this.#playsToNextOutput();
    if (isBack) {
      clearInterval(this.#timer);
      this.#hasLost = false;
      this.#onChange('back');
    } else if (this.#context.sinkId === '' || this.#context.state !== 'running') {
      await this.#playTo({ type: 'none' });
    }
    this.#isLooking = false;
  }

  close() {
    clearInterval(this.#timer);
    this.#context.removeEventListener('error', this.#onError);
  }
}
