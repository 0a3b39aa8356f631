import { effectMask, field, fieldCount, LabelIndices, writeState } from './contact-fields.mjs';
import { asHaptoFlowError, HaptoFlowError } from './errors.mjs';
import { MotorTap } from './motor-tap.mjs';
import { TapSource, WaveTap } from './wave-tap.mjs';

/** By haptoflow_silence. */
export const silenceNames = /** @type {const} */ (['none', 'rest', 'stale', 'muted', 'paused', 'panic', 'rate', 'closing', 'worker-dead', 'turned-down']);

/** A ring that was empty grows by this much, once for each stall. */
const ringStepFrames = 1024;
const longestRingFrames = 8192;
const stallMs = 250;

/** A closed voice falls silent within 5 ms and the blocks that a device asks for at once. */
const fadeMs = 30;

/**
 * @typedef {object} VoiceHost what a voice needs of its engine
 * @property {AudioContext} context
 * @property {LabelIndices} indices
 * @property {import('./module.mjs').Core} contactCore the page's own instance
 * @property {number} ringFrames
 * @property {number} fullScaleMps2
 * @property {() => import('./live.mjs').Live} live
 * @property {(number: number) => number} reliefNumber the present engine's number of a relief; 0 for none
 * @property {(clip: import('./haptoflow.d.ts').Clip) => number} clipAddress in the present engine; 0 until it is loaded
 * @property {(clip: import('./haptoflow.d.ts').Clip) => Promise<number>} loadClip
 * @property {(error: HaptoFlowError) => void} onFault
 * @property {(voice: Voice) => void} forget
 */

/** The signal of one tip; see haptoflow.d.ts. */
export class Voice {
  /** @type {import('./haptoflow.d.ts').EffectChoice} */
  effects = {};
  /** The values that differ from the engine's own, to be set again after a recovery. @type {Map<string, number>} */
  #settings = new Map();
  /** @type {string | null} */
  #actuator = null;
  #host;
  #node;
  #index = -1;
  /** @type {AudioWorkletNode | null} */
  #worklet = null;
  #fields = new Float64Array(fieldCount);
  /** Address of the fields in the engine's memory, with shared memory. */
  #address = 0;
  #taps = 0;
  /** @type {TapSource | null} */
  tapSource = null;
  #ringUnderruns = 0;
  #ringFrames;
  #grownMs = -Infinity;
  #isClosed = false;
  #isTouching = false;
  /** Of a clip that loads, only the newest wish is fulfilled. */
  #clipWishes = 0;
  /** @type {any} what the worker told last, without shared memory */
  lastStatistics = null;

  /** @param {VoiceHost} host */
  constructor(host) {
    this.#host = host;
    this.#ringFrames = host.ringFrames;
    this.#node = new GainNode(host.context, { gain: 1, channelCount: 1, channelCountMode: 'explicit' });
  }

  /** @returns {AudioNode} */
  get node() {
    return this.#node;
  }

  get index() {
    return this.#index;
  }

  get isClosed() {
    return this.#isClosed;
  }

  /** Its engine is lost: until `attach`, what it knows of that engine's memory would be written into the next one's. */
  lose() {
    this.#index = -1;
    this.#address = 0;
  }

  /** Makes the voice in the present engine; after a fault, again. */
  async attach() {
    const { context } = this.#host;
    const live = this.#host.live();
    const channel = live.isShared ? null : new MessageChannel();
    const { voice, samples } = await live.ask(
      { type: 'open-voice', rateHz: context.sampleRate, port: channel?.port1 ?? null, ringFrames: this.#ringFrames },
      channel ? [channel.port1] : [],
    );
    this.#index = voice;
    this.#address = live.core ? live.core.allocate(8 * fieldCount) : 0;
    const processorOptions = live.isShared ? { module: live.module, memory: live.memory, thread: live.audioThread, voice, samples } : {};
    this.#worklet?.disconnect();
    this.#worklet?.port.postMessage({ close: true });
    this.#worklet = this.#makeNode(live.isShared ? 'haptoflow-shared' : 'haptoflow-ring', processorOptions, channel);
    this.#worklet.connect(this.#node);
    for (const [name, value] of this.#settings) this.#tellSetting(name, value);
    if (this.#actuator !== null) await live.ask({ type: 'actuator', voice, profile: this.#actuator });
    if (this.#taps > 0) this.#openTap();
  }

  #makeNode(/** @type {string} */ name, /** @type {any} */ processorOptions, /** @type {MessageChannel | null} */ channel) {
    const node = new AudioWorkletNode(this.#host.context, name, { numberOfInputs: 0, outputChannelCount: [1], processorOptions });
    // Ports cannot be among the options in every browser.
    if (channel) node.port.postMessage({ blocks: channel.port2 }, [channel.port2]);
    node.onprocessorerror = () => this.#host.onFault(new HaptoFlowError('worker-lost', 'the engine failed on the audio thread'));
    node.port.onmessage = ({ data }) => this.#takeFromAudio(data);
    return node;
  }

  #takeFromAudio(/** @type {any} */ { late, wave, frame }) {
    if (late !== undefined) this.#takeLateBlock(late);
    if (wave) this.tapSource?.write(wave);
    if (frame !== undefined && this.tapSource) this.tapSource.startSeconds = frame / this.tapSource.sampleRateHz;
  }

  /** A device that calls in bursts, or a busy one, needs a longer ring. */
  #takeLateBlock(/** @type {number} */ count) {
    this.#ringUnderruns = count;
    const now = performance.now();
    if (now - this.#grownMs < stallMs || this.#ringFrames >= longestRingFrames) return;
    this.#grownMs = now;
    this.#ringFrames = Math.min(longestRingFrames, this.#ringFrames + ringStepFrames);
    this.#host.live().tell({ type: 'ring', voice: this.#index, frames: this.#ringFrames });
  }

  /** Of the ring, without shared memory. */
  get ringFrames() {
    return this.#ringFrames;
  }

  #requireOpen() {
    if (this.#isClosed) throw new HaptoFlowError('closed', 'the voice is closed');
  }

  #set(/** @type {string} */ name, /** @type {number} */ value, /** @type {number} */ lowest, /** @type {number} */ highest) {
    this.#requireOpen();
    if (!(value >= lowest && value <= highest)) throw new HaptoFlowError('invalid-argument', `${name} is ${value}; expected ${lowest} to ${highest}`);
    this.#settings.set(name, value);
    this.#tellSetting(name, value);
  }

  #tellSetting(/** @type {string} */ name, /** @type {number} */ value) {
    // `attach` sets them all.
    if (this.#index < 0) return;
    const live = this.#host.live();
    if (live.core) live.core.call('hapto_voice_set', this.#index, name, value);
    else live.tell({ type: 'set', voice: this.#index, name, value });
  }

  #setting(/** @type {string} */ name, /** @type {number} */ usual) {
    return this.#settings.get(name) ?? usual;
  }

  get gain() { return this.#setting('gain', 1); }
  set gain(value) { this.#set('gain', value, 0, 1); }
  get ceiling() { return this.#setting('ceiling', 1); }
  set ceiling(value) { this.#set('ceiling', value, 0, 1); }
  get muted() { return this.#setting('muted', 0) !== 0; }
  set muted(value) { this.#set('muted', value ? 1 : 0, 0, 1); }
  get paused() { return this.#setting('paused', 0) !== 0; }
  set paused(value) { this.#set('paused', value ? 1 : 0, 0, 1); }
  get listen() { return this.#setting('listen', 0) !== 0; }
  set listen(value) { this.#set('listen', value ? 1 : 0, 0, 1); }
  get delayMs() { return 1000 * this.#setting('delay', 0); }
  set delayMs(value) { this.#set('delay', value / 1000, 0, 0.5); }

  get actuator() {
    return this.#actuator;
  }

  set actuator(profile) {
    this.#requireOpen();
    this.#actuator = profile;
    if (this.#index < 0) return;
    this.#host.live().ask({ type: 'actuator', voice: this.#index, profile }).catch((error) => this.#host.onFault(asHaptoFlowError(error)));
  }

  /** @param {import('./haptoflow.d.ts').ContactState} state */
  publish(state) {
    this.#requireOpen();
    if (state.material !== undefined) this.#host.indices.write(state.material, this.#fields);
    writeState(state, effectMask(this.effects), this.#fields);
    this.publishFields(this.#fields);
  }

  /** Publishes the fields that begin at `first`. @param {Float64Array} numbers @param {number} [first] */
  publishFields(numbers, first = 0) {
    this.#isTouching = numbers[first + field.touching] !== 0;
    if (this.#index < 0) return;
    const { core } = this.#host.live();
    if (core) {
      const shared = core.f64;
      const at = this.#address >> 3;
      // A view for `set` would be garbage of every frame.
      for (let index = 0; index < fieldCount; index += 1) shared[at + index] = numbers[first + index];
      shared[at + field.relief] = this.#host.reliefNumber(numbers[first + field.relief]);
      core.exports.hapto_voice_publish(this.#index, this.#address);
    } else {
      const fields = numbers.slice(first, first + fieldCount);
      fields[field.relief] = this.#host.reliefNumber(fields[field.relief]);
      this.#host.live().tell({ type: 'publish', voice: this.#index, fields });
    }
  }

  lift() {
    this.#requireOpen();
    this.#fields[field.touching] = 0;
    this.publishFields(this.#fields);
  }

  panic() {
    this.#requireOpen();
    this.#tellSetting('panic', 1);
  }

  /** @param {import('./haptoflow.d.ts').Clip} clip @param {{gain?: number, isLoop?: boolean}} [options] */
  async playClip(clip, { gain = 1, isLoop = false } = {}) {
    this.#requireOpen();
    if (!(gain >= 0 && gain <= 4)) throw new HaptoFlowError('invalid-argument', `gain is ${gain}; expected 0 to 4`);
    this.#clipWishes += 1;
    const wish = this.#clipWishes;
    let address = this.#host.clipAddress(clip);
    if (address === 0) {
      address = await this.#host.loadClip(clip);
      if (wish !== this.#clipWishes || this.#isClosed) return;
    }
    this.#tellClip(address, gain, isLoop);
  }

  stopClip() {
    this.#requireOpen();
    this.#clipWishes += 1;
    this.#tellClip(0, 0, false);
  }

  #tellClip(/** @type {number} */ clip, /** @type {number} */ gain, /** @type {boolean} */ isLoop) {
    if (this.#index < 0) return;
    const live = this.#host.live();
    if (live.core) live.core.call('hapto_voice_play_clip', this.#index, clip, gain, isLoop ? 1 : 0);
    else live.tell({ type: 'play-clip', voice: this.#index, clip, gain, isLoop });
  }

  /** Of the newest state. */
  get isTouching() {
    return this.#isTouching;
  }

  /** @returns {import('./haptoflow.d.ts').SilenceReason} */
  get silence() {
    const { context } = this.#host;
    if (context.state !== 'running') return 'context';
    const { core } = this.#host.live();
    const number = core && this.#index >= 0 ? core.call('hapto_voice_silence', this.#index) : (this.lastStatistics?.silence ?? 1);
    return silenceNames[number] ?? 'rest';
  }

  /** @returns {import('./haptoflow.d.ts').VoiceStatistics} */
  statistics() {
    this.#requireOpen();
    const { core } = this.#host.live();
    const found = core && this.#index >= 0 ? core.json('hapto_voice_statistics', this.#index) : this.lastStatistics;
    return { ...found, silence: this.silence, ringUnderruns: this.#ringUnderruns };
  }

  #openTap() {
    const { context } = this.#host;
    const { isShared } = this.#host.live();
    const before = this.tapSource;
    this.tapSource = new TapSource(context.sampleRate, isShared);
    if (before) this.tapSource.continueFrom(before);
    this.tapSource.startSeconds = context.currentTime;
    this.#worklet?.port.postMessage({ tap: this.tapSource.memory.shared ?? {} });
  }

  /** @param {{seconds?: number}} [options] */
  waveTap({ seconds = 2 } = {}) {
    this.#requireOpen();
    if (!(seconds > 0 && seconds <= 60)) throw new HaptoFlowError('invalid-argument', `seconds is ${seconds}; expected above 0 to 60`);
    this.#taps += 1;
    if (this.#taps === 1) this.#openTap();
    return new WaveTap(this, seconds);
  }

  releaseTap() {
    this.#taps -= 1;
    if (this.#taps > 0) return;
    this.#worklet?.port.postMessage({ tap: null });
    this.tapSource = null;
  }

  /** @param {import('./haptoflow.d.ts').MotorOptions} [options] */
  motorTap(options = {}) {
    const { contactCore, fullScaleMps2 } = this.#host;
    return new MotorTap(contactCore, this.waveTap({ seconds: 1 }), fullScaleMps2, options);
  }

  async close() {
    if (this.#isClosed) return;
    this.#isClosed = true;
    this.#host.forget(this);
    const live = this.#host.live();
    await live.ask({ type: 'close-voice', voice: this.#index }).catch(() => {});
    // Until the fade is played, behind what a ring holds.
    const queuedMs = live.isShared ? 0 : (1000 * this.#ringFrames) / this.#host.context.sampleRate;
    await new Promise((resolve) => setTimeout(resolve, fadeMs + queuedMs));
    this.detach();
  }

  /** Takes the nodes away. */
  detach() {
    this.#isClosed = true;
    this.#worklet?.port.postMessage({ close: true });
    this.#worklet?.disconnect();
    this.#node.disconnect();
  }
}
