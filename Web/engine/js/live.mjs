import { asHaptoFlowError, HaptoFlowError } from './errors.mjs';
import { Core, createMemory } from './module.mjs';
import { pause } from './pause.mjs';
import { startWorker } from './start-worker.mjs';

/** @typedef {{type: string} & Record<string, any>} WorkerRequest what live-worker.mjs answers, by its type */

/** As in live-worker.mjs. */
const control = { mail: 0, beat: 1, words: 2 };

/**
 * One life of an engine: a worker and, with shared memory, the page's instance in that memory. After a fault a new one is
 * made; it is never repaired.
 */
export class Live {
  #worker;
  /** @type {Map<number, {resolve: (result: any) => void, reject: (error: HaptoFlowError) => void, isQuick: boolean}>} */
  #waiting = new Map();
  #nextId = 1;
  #onLost;
  /** @type {(share: number, doing: string) => void} */
  #onProgress = () => {};
  #isEnded = false;

  /**
   * @param {{places: import('./files.mjs').Places, module: WebAssembly.Module, isShared: boolean, onLost: (error: HaptoFlowError) => void}} options
   */
  constructor({ places, module, isShared, onLost }) {
    this.module = module;
    this.isShared = isShared;
    this.places = places;
    this.#onLost = onLost;
    this.memory = isShared ? createMemory() : null;
    this.words = isShared ? new Int32Array(new SharedArrayBuffer(4 * control.words)) : null;
    /** @type {Core | null} of the page; null without shared memory */
    this.core = null;
    /** @type {{address: number} | null} */
    this.audioThread = null;
    this.#worker = startWorker('live-worker.mjs', places, 'haptoflow', (error) => this.#lose(error));
    this.#worker.onmessage = ({ data }) => this.#take(data);
  }

  /** The worker; for tests that end it. */
  get worker() {
    return this.#worker;
  }

  /**
   * Starts the engine.
   * @param {{model: Uint8Array, options: object, onProgress: (share: number, doing: string) => void}} settings
   * @returns {Promise<any>} the model as JSON
   */
  async start({ model, options, onProgress }) {
    this.#onProgress = onProgress;
    const { places, module, words } = this;
    const memory = this.memory ?? undefined;
    const { model: json, page, audio } = await this.ask({
      type: 'start', module, memory: memory ?? null, control: words, onnxRuntime: places.onnxRuntime, model, options,
    });
    if (this.memory) {
      this.core = new Core(module, { memory: this.memory, thread: page, isPage: true });
      this.audioThread = audio;
    }
    return json;
  }

  #take(/** @type {any} */ { id, result, error, progress, lost }) {
    if (progress) this.#onProgress(progress.share, progress.doing);
    if (lost) this.#lose(asHaptoFlowError(lost, 'worker-lost'));
    const waiting = this.#waiting.get(id);
    if (!waiting) return;
    this.#waiting.delete(id);
    if (error) waiting.reject(asHaptoFlowError(error));
    else waiting.resolve(result);
  }

  #lose(/** @type {HaptoFlowError} */ error) {
    if (this.#isEnded) return;
    this.end(error);
    this.#onLost(error);
  }

  /**
   * Asks the worker.
   * @param {WorkerRequest} request
   * @param {Transferable[]} [transfer]
   * @returns {Promise<any>}
   */
  ask(request, transfer = []) {
    if (this.#isEnded) return Promise.reject(new HaptoFlowError('closed', 'the engine is closed'));
    const id = this.#nextId++;
    const answer = new Promise((resolve, reject) => {
      this.#waiting.set(id, { resolve, reject, isQuick: request.type === 'ping' || request.type === 'statistics' });
    });
    this.#post(id, request, transfer);
    return answer;
  }

  /** Tells the worker without waiting for an answer. @param {WorkerRequest} request */
  tell(request) {
    if (!this.#isEnded) this.#post(0, request, []);
  }

  #post(/** @type {number} */ id, /** @type {object} */ request, /** @type {Transferable[]} */ transfer) {
    this.#worker.postMessage({ id, request }, transfer);
    if (this.words) {
      Atomics.add(this.words, control.mail, 1);
      // Before the engine exists the worker does not wait.
      this.core?.exports.hapto_engine_wake();
    }
  }

  /** Whether the worker has something to do that can take long, such as loading a tier. */
  get isBusy() {
    return [...this.#waiting.values()].some(({ isQuick }) => !isQuick);
  }

  /** Whether the worker answers within a time. @param {number} milliseconds */
  async answers(milliseconds) {
    let hasAnswered = false;
    const answer = this.ask({ type: 'ping' }).then(() => {
      hasAnswered = true;
    }, () => {});
    // Where the page itself stood still, answer and alarm are due at once: the answer is let go first.
    await Promise.race([answer, pause(milliseconds).then(() => pause(200))]);
    return hasAnswered;
  }

  /** Ends the worker at once. @param {HaptoFlowError} [error] for those who wait */
  end(error = new HaptoFlowError('closed', 'the engine is closed')) {
    this.#isEnded = true;
    this.#worker.terminate();
    for (const { reject } of this.#waiting.values()) reject(error);
    this.#waiting.clear();
  }
}
