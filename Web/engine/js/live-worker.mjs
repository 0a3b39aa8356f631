import { openClip } from './clip.mjs';
import { Core, createMemory } from './module.mjs';
import { asHaptoFlowError, plainError } from './errors.mjs';
import { makeRelief } from './relief.mjs';
import { startRuntime } from './runtime.mjs';

// The worker of a live engine: it loads model and tiers, generates segments, and where memory is not shared renders, too.
// Between messages it waits inside the module for contact states; `Mail` tells it to come back for a message.

const ringChunk = 256;
const byteLength = (/** @type {string} */ text) => new TextEncoder().encode(text).length;
/** Words of the shared control block. */
export const control = { mail: 0, beat: 1, words: 2 };

/** @typedef {import('./live.mjs').WorkerRequest} WorkerRequest */

/** One voice whose blocks go through a port to the audio thread. */
class Ring {
  constructor(/** @type {Core} */ core, /** @type {number} */ voice, /** @type {MessagePort} */ port, /** @type {number} */ rateHz, /** @type {number} */ ahead) {
    this.core = core;
    this.voice = voice;
    this.port = port;
    this.rateHz = rateHz;
    this.ahead = ahead;
    this.written = 0;
    this.consumed = 0;
    this.samples = core.allocate(4 * ringChunk);
  }

  /** Renders a block into the ring. Returns false once the voice is closed and has faded. */
  write() {
    const isHeard = this.core.exports.hapto_voice_render(this.voice, this.samples, ringChunk, this.rateHz) === 0;
    const block = this.core.f32.slice(this.samples >> 2, (this.samples >> 2) + ringChunk);
    this.port.postMessage(block, [block.buffer]);
    this.written += ringChunk;
    return isHeard;
  }

  /** Renders until the ring is full. */
  fill() {
    while (this.written - this.consumed < this.ahead) {
      this.write();
      // Inference for what the next block will need.
      if (this.core.call('hapto_engine_turn', 0) === 0) throw new Error('the engine has ended');
    }
  }

  /** Renders the fade of the closed voice. */
  close() {
    while (this.write());
    this.port.close();
    this.core.free(this.samples);
  }
}

class LiveWorker {
  /** @type {Core | null} */
  #core = null;
  /** @type {Int32Array | null} set with shared memory */
  #control = null;
  /** @type {Map<number, Ring>} */
  #rings = new Map();
  #isLooping = false;
  #isClosed = false;
  #fields = 0;

  get core() {
    return /** @type {Core} */ (this.#core);
  }

  /** @param {WorkerRequest} request */
  async answer(request) {
    switch (request.type) {
      case 'start': return this.#start(request);
      case 'quality': return this.core.call('hapto_engine_set_quality', request.quality);
      case 'material': return this.#addMaterial(request);
      case 'relief': return makeRelief(this.core, request.relief);
      case 'destroy-relief': return this.core.call('hapto_relief_destroy', request.number);
      case 'clip': return openClip(this.core, request.text);
      case 'close-clip': return this.core.call('hapto_clip_close', request.clip);
      case 'play-clip': return this.core.call('hapto_voice_play_clip', request.voice, request.clip, request.gain, request.isLoop ? 1 : 0);
      case 'open-voice': return this.#openVoice(request);
      case 'close-voice': return this.#closeVoice(request.voice);
      case 'ring': return this.#lengthenRing(request);
      case 'set': return this.core.call('hapto_voice_set', request.voice, request.name, request.value);
      case 'actuator': return this.#setActuator(request);
      case 'publish': return this.#publish(request);
      case 'statistics': return this.statistics(request.voices);
      case 'ping': return this.core.memory.buffer.byteLength;
      case 'close': return this.#close();
      default: throw new Error('unknown request');
    }
  }

  async #start(/** @type {any} */ { module, memory, control: words, onnxRuntime, model, options }) {
    const runtime = await startRuntime(onnxRuntime);
    this.#core = new Core(module, { memory: memory ?? createMemory(), mayWait: true, runtime: runtime.imports });
    runtime.attach(this.core);
    postMessage({ progress: { share: 0.6, doing: 'reading the model' } });
    const bytes = this.core.copyIn(model);
    try {
      this.core.call('hapto_model_open', bytes, model.length);
    } finally {
      this.core.free(bytes);
    }
    postMessage({ progress: { share: 0.7, doing: 'loading the network' } });
    this.core.call('hapto_engine_create', options.quality, options.updateRateHz, options.fullScaleMps2, options.seed, options.leadMs);
    this.#fields = this.core.allocate(8 * 64);
    this.#control = words;
    return {
      model: this.core.json('hapto_model_json'),
      page: this.#control ? this.core.createThread() : null,
      audio: this.#control ? this.core.createThread() : null,
    };
  }

  #addMaterial(/** @type {any} */ { text, replaced }) {
    this.core.call('hapto_material_add', text, byteLength(text), replaced);
    return this.core.json('hapto_labels_json');
  }

  #openVoice(/** @type {any} */ { rateHz, port, ringFrames }) {
    const voice = this.core.call('hapto_voice_create', rateHz);
    if (!port) return { voice, samples: this.core.allocate(4 * 4096) };
    const ring = new Ring(this.core, voice, port, rateHz, ringFrames);
    this.#rings.set(voice, ring);
    port.onmessage = (/** @type {MessageEvent} */ { data }) => {
      ring.consumed = data;
      this.#guarded(() => ring.fill());
    };
    this.#guarded(() => ring.fill());
    return { voice, samples: 0 };
  }

  #lengthenRing(/** @type {any} */ { voice, frames }) {
    const ring = this.#rings.get(voice);
    if (!ring) return;
    ring.ahead = frames;
    this.#guarded(() => ring.fill());
  }

  #closeVoice(/** @type {number} */ voice) {
    try {
      return this.core.call('hapto_voice_destroy', voice);
    } finally {
      this.#rings.get(voice)?.close();
      this.#rings.delete(voice);
    }
  }

  #setActuator(/** @type {any} */ { voice, profile }) {
    return this.core.call('hapto_voice_set_actuator', voice, profile ?? 0, profile === null ? 0 : byteLength(profile));
  }

  #publish(/** @type {any} */ { voice, fields }) {
    this.core.f64.set(fields, this.#fields >> 3);
    this.core.call('hapto_voice_publish', voice, this.#fields);
    this.core.call('hapto_engine_turn', 0);
    return 0;
  }

  statistics(/** @type {number[]} */ voices) {
    return {
      engine: this.core.json('hapto_engine_statistics'),
      voices: voices.map((voice) => this.core.json('hapto_voice_statistics', voice)),
      memoryBytes: this.core.memory.buffer.byteLength,
    };
  }

  #close() {
    this.#isClosed = true;
    const done = this.core.call('hapto_engine_close');
    for (const ring of this.#rings.values()) ring.close();
    this.#rings.clear();
    return done;
  }

  /** Marks a request as handled, and waits for contact states until the next. */
  handled() {
    if (!this.#control) return;
    Atomics.sub(this.#control, control.mail, 1);
    if (!this.#isLooping && !this.#isClosed) this.#guarded(() => this.#loop());
  }

  #loop() {
    const words = /** @type {Int32Array} */ (this.#control);
    this.#isLooping = true;
    try {
      while (Atomics.load(words, control.mail) === 0) {
        if (this.core.call('hapto_engine_turn', Infinity) === 0) throw new Error('the engine has ended');
        Atomics.add(words, control.beat, 1);
      }
    } finally {
      this.#isLooping = false;
    }
  }

  /** A failure outside an answer is the worker's end. */
  #guarded(/** @type {() => void} */ action) {
    try {
      action();
    } catch (error) {
      postMessage({ lost: plainError(asHaptoFlowError(error, 'worker-lost')) });
    }
  }
}

const worker = new LiveWorker();
/** Requests are answered one after the other: the first one starts the engine. */
let queue = Promise.resolve();

globalThis.onmessage = (/** @type {MessageEvent<{id: number, request: WorkerRequest}>} */ { data: { id, request } }) => {
  queue = queue.then(async () => {
    try {
      const result = await worker.answer(request);
      if (id !== 0) postMessage({ id, result });
    } catch (error) {
      if (error instanceof WebAssembly.RuntimeError) {
        postMessage({ lost: plainError(asHaptoFlowError(error, 'worker-lost')) });
        return;
      }
      postMessage({ id, error: plainError(error) });
    }
    worker.handled();
  });
};
