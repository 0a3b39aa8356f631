import { usableContext } from './audio-context.mjs';
import { requireWave } from './clip.mjs';
import { LabelIndices } from './contact-fields.mjs';
import { asHaptoFlowError, HaptoFlowError, requireNotAborted } from './errors.mjs';
import { engineModule, modelBytes, placesOf } from './files.mjs';
import { Live } from './live.mjs';
import { Core, createMemory } from './module.mjs';
import { OutputWatch } from './output-watch.mjs';
import { decodeImage } from './decode-image.mjs';
import { fullRelief, mostTexels, normalMapOf, Relief, withHeights } from './relief.mjs';
import { Scene } from './scene.mjs';
import { loadedImages, optionsOf } from './scene-reliefs.mjs';
import { runTask } from './task.mjs';
import { Voice } from './voice.mjs';

export { HaptoFlowError };

/** @typedef {import('./haptoflow.d.ts').CreateOptions} CreateOptions */
/** @typedef {import('./haptoflow.d.ts').Quality} Quality */

const qualities = { auto: 0, draft: 1, standard: 2, sketch: 4 };
const defaultRingFrames = 2048;
const watchMs = 100;
const pingEveryMs = 1000;
const pingLimitMs = 4000;
const mostRecoveriesAMinute = 3;

/** @param {Quality} quality */
function qualityNumber(quality) {
  const number = qualities[quality];
  if (number === undefined) throw new HaptoFlowError('invalid-argument', `quality "${quality}": expected ${Object.keys(qualities).join(', ')}`);
  return number;
}

/** Made and posted for trial: a browser may have the name alone. */
function canShare() {
  if (globalThis.crossOriginIsolated !== true) return false;
  try {
    const { port1 } = new MessageChannel();
    port1.postMessage(new SharedArrayBuffer(4));
    port1.close();
    return true;
  } catch {
    return false;
  }
}

const isolation = 'Cross-Origin-Opener-Policy: same-origin and Cross-Origin-Embedder-Policy: require-corp';

function whyNotShared() {
  if (canShare()) return '';
  return globalThis.crossOriginIsolated === true
    ? 'this browser shares no memory between threads, although the page came with the headers for it'
    : `this page may not share memory between threads: serve it with the headers ${isolation}`;
}

/** @param {CreateOptions['sharing']} wanted */
function sharingOf(wanted = 'auto') {
  const note = whyNotShared();
  if (wanted === 'shared' && note !== '') throw new HaptoFlowError('invalid-argument', note);
  if (wanted === 'ring') return { isShared: false, note: 'the page chose the ring' };
  return { isShared: note === '', note };
}

/** Where the images of a scene are, for a worker too. @param {string | URL} [base] */
const sceneBaseOf = (base = '.') => new URL(base, globalThis.document?.baseURI).href;

/** The engine; see haptoflow.d.ts. */
export class HaptoFlow extends EventTarget {
  #options;
  #places;
  #module;
  #modelBytes;
  #isShared;
  #sharingNote;
  #ownsContext;
  /** Of an own context; who gives one chooses its output. @type {OutputWatch | null} */
  #outputWatch;
  /** @type {Live} */
  #live;
  /** @type {any} */
  #model = null;
  #labels = /** @type {any[]} */ ([]);
  #indices = new LabelIndices();
  #contactCore;
  /** @type {Set<Voice>} */
  #voices = new Set();
  /** Texts of added materials by name, for recoveries. @type {Map<string, string>} */
  #materials = new Map();
  /** Reliefs by their own numbers, and the numbers that the present engine has for those. @type {Map<number, Relief>} */
  #reliefs = new Map();
  /** @type {Map<number, number>} */
  #reliefNumbers = new Map();
  #newestRelief = 0;
  /** What the present engine has of clips. @type {WeakMap<import('./haptoflow.d.ts').Clip, {address: number, loaded: Promise<number>}>} */
  #clips = new WeakMap();
  /** @type {Quality} */
  #quality;
  /** @type {any} the worker's last statistics */
  #lastStatistics = null;
  /** @type {ReturnType<typeof setInterval> | undefined} */
  #watch;
  #lastPing = 0;
  #isPinging = false;
  /** @type {Map<Voice, string>} */
  #silences = new Map();
  #tier = '';
  /** @type {number[]} times of recoveries */
  #recoveries = [];
  #recoveryCount = 0;
  /** @type {Promise<void> | null} */
  #recovering = null;
  #isClosed = false;

  static get canShareMemory() {
    return canShare();
  }

  /** @param {CreateOptions} [options] */
  static async create(options = {}) {
    const { signal, onProgress = () => {} } = options;
    requireNotAborted(signal);
    qualityNumber(options.quality ?? 'standard');
    const sharing = sharingOf(options.sharing);
    const places = placesOf(options);
    onProgress(0, 'loading');
    const [module, model] = await Promise.all([
      engineModule(places, signal),
      modelBytes(options.model, places, signal, (share) => onProgress(0.4 * share, 'loading the model')),
    ]);
    requireNotAborted(signal);
    const context = usableContext(options.context);
    const haptics = new HaptoFlow({ options, places, module, model, context, ...sharing });
    const abort = () => void haptics.close();
    signal?.addEventListener('abort', abort);
    try {
      await haptics.#start(onProgress);
      requireNotAborted(signal);
      onProgress(1, 'ready');
      return haptics;
    } catch (error) {
      await haptics.close();
      requireNotAborted(signal);
      throw asHaptoFlowError(error);
    } finally {
      signal?.removeEventListener('abort', abort);
    }
  }

  /** @param {import('./haptoflow.d.ts').RenderOptions} options */
  static async render(options) {
    return runTask('render', { ...options, sceneBase: sceneBaseOf(options.sceneBase) });
  }

  static get mostTexels() {
    return mostTexels;
  }

  /**
   * @param {Blob} file
   * @param {{mostPixels?: number}} [options]
   */
  static decodeImage(file, options) {
    return decodeImage(file, options);
  }

  /** @param {import('./haptoflow.d.ts').LearnOptions} options */
  static learn(options) {
    return runTask('learn', options);
  }

  /**
   * Use `create`.
   * @param {{options: CreateOptions, places: import('./files.mjs').Places, module: WebAssembly.Module, model: Uint8Array, context: AudioContext, isShared: boolean, note: string}} parts
   */
  constructor({ options, places, module, model, context, isShared, note }) {
    super();
    this.#options = options;
    this.#places = places;
    this.#module = module;
    this.#modelBytes = model;
    this.#isShared = isShared;
    this.#sharingNote = note;
    this.#quality = options.quality ?? 'standard';
    this.context = context;
    this.#ownsContext = options.context === undefined;
    this.output = new GainNode(context);
    const { destination = context.destination } = options;
    if (destination) this.output.connect(destination);
    this.#contactCore = new Core(module, { memory: createMemory(), isPage: true });
    this.#live = this.#newLive();
    context.addEventListener('statechange', this.#onContextState);
    this.#outputWatch = this.#ownsContext ? new OutputWatch(context, (state) => this.#emit('device', { state })) : null;
  }

  #onContextState = () => {
    this.#emit('context', { state: this.context.state });
  };

  #emit(/** @type {string} */ type, /** @type {object} */ detail) {
    this.dispatchEvent(new CustomEvent(type, { detail }));
  }

  #newLive() {
    return new Live({ places: this.#places, module: this.#module, isShared: this.#isShared, onLost: (error) => void this.#recover(error) });
  }

  /** Of every ring, until it has to grow. */
  get #firstRingFrames() {
    return this.#options.ringFrames ?? defaultRingFrames;
  }

  get #engineOptions() {
    const { updateRateHz = 72, fullScaleMps2 = 200, seed = 1, leadMs = 0 } = this.#options;
    return { quality: qualityNumber(this.#quality), updateRateHz, fullScaleMps2, seed, leadMs };
  }

  async #start(/** @type {(share: number, doing: string) => void} */ onProgress) {
    const worklet = this.context.audioWorklet;
    if (!worklet) throw new HaptoFlowError('audio-unavailable', 'this page has no audio worklet: it must come from https or from localhost');
    const address = new URL('worklet.mjs', this.#places.base);
    const [model] = await Promise.all([
      this.#live.start({ model: this.#modelBytes, options: this.#engineOptions, onProgress }),
      worklet.addModule(address).catch((error) => {
        throw new HaptoFlowError('engine-unreachable', `${address}: ${error.message}`);
      }),
    ]);
    this.#model = model;
    this.#setLabels(model.labels);
    this.#watch = setInterval(() => this.#look(), watchMs);
  }

  #setLabels(/** @type {any[]} */ labels) {
    this.#labels = labels;
    this.#indices.set(labels);
  }

  get model() {
    return this.#model;
  }

  get labels() {
    return this.#labels;
  }

  get quality() {
    return this.#quality;
  }

  get voices() {
    return [...this.#voices];
  }

  #requireOpen() {
    if (this.#isClosed) throw new HaptoFlowError('closed', 'the engine is closed');
  }

  /** Waits for a recovery that runs, then asks the worker. */
  async #ask(/** @type {any} */ request) {
    this.#requireOpen();
    await this.#recovering;
    return this.#live.ask(request);
  }

  /** @param {Quality} quality */
  async setQuality(quality) {
    await this.#ask({ type: 'quality', quality: qualityNumber(quality) });
    this.#quality = quality;
  }

  /** @param {Partial<import('./haptoflow.d.ts').Voice>} [options] */
  async openVoice(options = {}) {
    this.#requireOpen();
    await this.#recovering;
    const voice = new Voice({
      context: this.context,
      indices: this.#indices,
      contactCore: this.#contactCore,
      ringFrames: this.#firstRingFrames,
      fullScaleMps2: this.#options.fullScaleMps2 ?? 200,
      live: () => this.#live,
      reliefNumber: (number) => this.#reliefNumbers.get(number) ?? 0,
      clipAddress: (clip) => this.#clips.get(clip)?.address ?? 0,
      loadClip: (clip) => this.#loadClip(clip),
      onFault: (error) => void this.#recover(error),
      forget: (closed) => {
        this.#voices.delete(closed);
        this.#silences.delete(closed);
      },
    });
    await voice.attach();
    Object.assign(voice, options);
    voice.node.connect(this.output);
    this.#voices.add(voice);
    return voice;
  }

  /** @param {string | object} material */
  async addMaterial(material) {
    const text = typeof material === 'string' ? material : JSON.stringify(material);
    const known = new Map(this.#labels.map((label) => [label.name, label]));
    const name = nameOf(text);
    const before = known.get(name);
    if (before && !before.isAdded) throw new HaptoFlowError('invalid-argument', `the material is called "${name}", which is a label of the model: change the key "name"`);
    const labels = await this.#ask({ type: 'material', text, replaced: before ? before.index : -1 });
    this.#materials.set(name, text);
    this.#setLabels(labels);
    return labels.find((/** @type {any} */ label) => label.name === name);
  }

  /** @param {import('./haptoflow.d.ts').ReliefOptions | import('./haptoflow.d.ts').ReliefImageOptions} options */
  async createRelief(options) {
    const normals = normalMapOf(options);
    const full = fullRelief(withHeights(options, normals && await runTask('heights', { ...this.#taskOptions, map: normals })));
    const number = await this.#ask({ type: 'relief', relief: full });
    this.#newestRelief += 1;
    const relief = new Relief(full, this.#newestRelief, (destroyed) => this.#destroyRelief(destroyed));
    this.#reliefs.set(relief.number, relief);
    this.#reliefNumbers.set(relief.number, number);
    return relief;
  }

  #destroyRelief(/** @type {Relief} */ relief) {
    const number = this.#reliefNumbers.get(relief.number);
    this.#reliefs.delete(relief.number);
    this.#reliefNumbers.delete(relief.number);
    if (number !== undefined) this.#live.tell({ type: 'destroy-relief', number });
  }

  /** @param {import('./haptoflow.d.ts').ClipOptions} options @returns {Promise<import('./haptoflow.d.ts').Clip>} */
  async createClip(options) {
    requireWave(options);
    return runTask('clip', { ...this.#taskOptions, wave: { fullScaleMps2: this.#options.fullScaleMps2, ...options } });
  }

  /** @param {string} text @returns {Promise<import('./haptoflow.d.ts').Clip>} */
  async readClip(text) {
    return runTask('clip', { ...this.#taskOptions, text: String(text) });
  }

  async #loadClip(/** @type {import('./haptoflow.d.ts').Clip} */ clip) {
    this.#requireOpen();
    await this.#recovering;
    let found = this.#clips.get(clip);
    if (!found) {
      const made = { address: 0, loaded: this.#live.ask({ type: 'clip', text: clip.text }) };
      found = made;
      this.#clips.set(clip, made);
      made.loaded.then((address) => {
        made.address = address;
      }, () => this.#clips.delete(clip));
    }
    return found.loaded;
  }

  /** @param {import('./haptoflow.d.ts').Clip} clip */
  forgetClip(clip) {
    const live = this.#live;
    const found = this.#clips.get(clip);
    this.#clips.delete(clip);
    found?.loaded.then((address) => live.tell({ type: 'close-clip', clip: address }), () => {});
  }

  /** @param {string | object} scene */
  loadScene(scene) {
    this.#requireOpen();
    return new Scene(this.#contactCore, this.#indices, this.#labels, scene);
  }

  /**
   * @param {Scene} scene
   * @param {{images?: Readonly<Record<string, import('./haptoflow.d.ts').ReliefImage>>, sceneBase?: string | URL, signal?: AbortSignal}} [options]
   */
  async loadReliefs(scene, { images, sceneBase, signal } = {}) {
    const named = scene.surfaces.filter(({ relief }) => relief).map(({ index, name, relief }) => ({ index, surface: name, relief }));
    const all = await loadedImages(named, { images, sceneBase: sceneBaseOf(sceneBase), signal });
    /** @type {Relief[]} */
    const made = [];
    try {
      for (const each of named) {
        requireNotAborted(signal);
        made.push(await this.createRelief(optionsOf(each, all, scene.tipRadiusMetres)));
      }
      named.forEach(({ index, relief }, at) => scene.setRelief(index, made[at], { share: relief.share }));
      return made;
    } catch (error) {
      for (const relief of made) relief.destroy();
      throw error;
    }
  }

  get #taskOptions() {
    return { base: this.#places.base, onnxRuntime: this.#places.onnxRuntime, model: this.#modelBytes, module: this.#module };
  }

  /** @param {any} options */
  async render(options) {
    return runTask('render', { materials: [...this.#materials.values()], ...this.#taskOptions, ...options, sceneBase: sceneBaseOf(options.sceneBase) });
  }

  /** @param {any} options */
  learn(options) {
    return runTask('learn', { ...this.#taskOptions, ...options });
  }

  /** @param {any} [options] */
  measure({ tiers, seconds = 2, signal, onProgress } = {}) {
    return runTask('measure', { ...this.#taskOptions, tiers, seconds, signal, onProgress });
  }

  /** @param {{signal?: AbortSignal}} [options] */
  measureEffects({ signal } = {}) {
    return runTask('effects', { ...this.#taskOptions, signal });
  }

  /** @returns {import('./haptoflow.d.ts').Statistics} */
  statistics() {
    this.#requireOpen();
    const { core } = this.#live;
    const found = core ? core.json('hapto_engine_statistics') : (this.#lastStatistics?.engine ?? {});
    const { context } = this;
    return {
      sharing: this.#isShared ? 'shared' : 'ring',
      sharingNote: this.#sharingNote,
      ringFrames: this.#isShared ? 0 : Math.max(this.#firstRingFrames, ...this.voices.map(({ ringFrames }) => ringFrames)),
      quality: this.#quality,
      ...found,
      recoveries: this.#recoveryCount,
      memoryBytes: core ? core.memory.buffer.byteLength : (this.#lastStatistics?.memoryBytes ?? NaN),
      sampleRateHz: context.sampleRate,
      baseLatencyMs: 1000 * (context.baseLatency ?? NaN),
      outputLatencyMs: 1000 * (context.outputLatency ?? NaN),
      hasLostOutput: this.#outputWatch?.hasLost ?? false,
      outputUnderruns: /** @type {any} */ (context).playbackStats?.underrunEvents ?? NaN,
    };
  }

  async resume() {
    await this.context.resume();
  }

  panic() {
    for (const voice of this.#voices) voice.panic();
  }

  /** Looks at the voices a few times a second, and whether the worker lives. */
  #look() {
    if (this.#recovering || this.#isClosed) return;
    void this.#ping();
    if (!this.#live.core) void this.#fetchStatistics();
    for (const voice of this.#voices) {
      const reason = voice.silence;
      // A tip in the air need not be published.
      const shown = reason === 'rest' || (reason === 'stale' && !voice.isTouching) ? 'none' : reason;
      if ((this.#silences.get(voice) ?? 'none') !== shown) {
        this.#silences.set(voice, shown);
        this.#emit('silent', { voice, reason: shown });
      }
    }
    const { tier } = this.statistics();
    if (tier !== undefined && tier !== this.#tier) {
      this.#tier = tier;
      this.#emit('quality', { tier });
    }
  }

  async #fetchStatistics() {
    const live = this.#live;
    const voices = [...this.#voices];
    try {
      const found = await live.ask({ type: 'statistics', voices: voices.map(({ index }) => index) });
      this.#lastStatistics = found;
      voices.forEach((voice, index) => {
        voice.lastStatistics = found.voices[index];
      });
    } catch {
      // The worker says itself when it is lost; a voice may just have been closed.
    }
  }

  async #ping() {
    // A hidden page's timers and workers may stand still for seconds.
    if (this.#isPinging || this.#live.isBusy || globalThis.document?.visibilityState === 'hidden' || performance.now() - this.#lastPing < pingEveryMs) return;
    this.#isPinging = true;
    const live = this.#live;
    const isAlive = await live.answers(pingLimitMs);
    this.#isPinging = false;
    this.#lastPing = performance.now();
    if (!isAlive && live === this.#live && !this.#isClosed) {
      live.end(new HaptoFlowError('worker-lost', 'the worker does not answer'));
      void this.#recover(new HaptoFlowError('worker-lost', `the worker did not answer for ${pingLimitMs / 1000} s`));
    }
  }

  /** Makes a new engine with the same voices, materials and reliefs. */
  async #recover(/** @type {HaptoFlowError} */ error) {
    if (this.#isClosed || this.#recovering) return;
    if (!this.#model) return;
    const began = performance.now();
    this.#recoveries = this.#recoveries.filter((time) => began - time < 60000);
    if (this.#recoveries.length >= mostRecoveriesAMinute) {
      this.#emit('error', { error: new HaptoFlowError('worker-lost', `${error.message}; it failed ${mostRecoveriesAMinute} times within a minute and stays silent: reload the page`), isFatal: true });
      await this.close();
      return;
    }
    this.#recoveries.push(began);
    this.#emit('error', { error, isFatal: false });
    this.#recovering = this.#startAgain();
    try {
      await this.#recovering;
      this.#recoveryCount += 1;
      this.#recovering = null;
      this.#emit('recovered', { reason: error.message, milliseconds: performance.now() - began });
    } catch (failure) {
      this.#recovering = null;
      this.#emit('error', { error: asHaptoFlowError(failure), isFatal: true });
      await this.close();
    }
  }

  async #startAgain() {
    this.#live.end();
    for (const voice of this.#voices) voice.lose();
    this.#reliefNumbers.clear();
    this.#clips = new WeakMap();
    this.#live = this.#newLive();
    await this.#live.start({ model: this.#modelBytes, options: this.#engineOptions, onProgress: () => {} });
    // In the order of their indices, which scenes hold.
    for (const text of this.#materials.values()) await this.#live.ask({ type: 'material', text, replaced: -1 });
    for (const [number, relief] of this.#reliefs) this.#reliefNumbers.set(number, await this.#live.ask({ type: 'relief', relief }));
    for (const voice of this.#voices) await voice.attach();
  }

  async close() {
    if (this.#isClosed) return;
    this.#isClosed = true;
    clearInterval(this.#watch);
    this.context.removeEventListener('statechange', this.#onContextState);
    this.#outputWatch?.close();
    for (const voice of this.#voices) voice.detach();
    this.#voices.clear();
    this.output.disconnect();
    // A busy worker is not waited for.
    this.#live.end();
    if (this.#ownsContext && this.context.state !== 'closed') await this.context.close();
  }

  /** For tests: the worker, to end it. */
  get [Symbol.for('haptoflow.worker')]() {
    return this.#live.worker;
  }
}

/** The name in a material file's text. */
function nameOf(/** @type {string} */ text) {
  try {
    const { name } = JSON.parse(text);
    if (typeof name === 'string') return name;
  } catch (error) {
    throw new HaptoFlowError('MATERIAL_INVALID', `the material is not valid JSON: ${/** @type {Error} */ (error).message}`);
  }
  throw new HaptoFlowError('MATERIAL_INVALID', 'the material: missing key "name"');
}
