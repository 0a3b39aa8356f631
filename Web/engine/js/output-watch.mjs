// A context whose output was unplugged stops for good in Chromium: not even `resume` starts it when there is another one. Without
// an output it is given none, so that it goes on for motors and pictures, and takes the next that there is.

const lookEveryMs = 1000;

/** Keeps a context running without its output, and gives it the next one. */
export class OutputWatch {
  #context;
  #onChange;
  /** @type {ReturnType<typeof setInterval> | undefined} */
  #timer;
  #isChanging = false;
  #hasLost = false;

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
    if (this.#hasLost) return;
    this.#hasLost = true;
    if (!this.#context.setSinkId) {
      this.#onChange('stopped');
      return;
    }
    this.#onChange('lost');
    void this.#change({ type: 'none' });
    this.#timer = setInterval(() => void this.#look(), lookEveryMs);
  };

  /** @returns {Promise<boolean>} whether the context runs on that output */
  async #change(/** @type {string | {type: 'none'}} */ output) {
    if (this.#isChanging) return false;
    this.#isChanging = true;
    try {
      await this.#context.setSinkId(output);
      await this.#context.resume();
      return true;
    } catch {
      return false;
    } finally {
      this.#isChanging = false;
    }
  }

  async #look() {
    if (this.#context.sinkId === '') {
      // The first attempt to go on without an output failed.
      await this.#change({ type: 'none' });
      return;
    }
    // Chromium takes note of a new output when it is asked for all.
    const devices = await navigator.mediaDevices?.enumerateDevices().catch(() => []);
    if (!devices?.some(({ kind }) => kind === 'audiooutput') || !(await this.#change(''))) return;
    clearInterval(this.#timer);
    this.#hasLost = false;
    this.#onChange('back');
  }

  close() {
    clearInterval(this.#timer);
    this.#context.removeEventListener('error', this.#onError);
  }
}
