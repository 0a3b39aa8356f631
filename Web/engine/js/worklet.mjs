import { Core } from './module.mjs';

// The audio thread. With shared memory the engine renders here; else blocks of the worker are played from a queue. Nothing in
// `process` allocates or waits; what it needs is made in the constructors.

const blockFrames = 4096;
/** @type {WeakMap<WebAssembly.Memory, Core>} */
const cores = new WeakMap();

/** Advanced with every block, by one of the voices: the thread has no other clock whose reading makes no garbage. */
const clock = new Float64Array([Date.now()]);
let clockFrame = 0;

/** The instance of an engine on this thread: one for all its voices. */
function coreOf(/** @type {{module: WebAssembly.Module, memory: WebAssembly.Memory, thread: {address: number}}} */ { module, memory, thread }) {
  let core = cores.get(memory);
  if (!core) {
    core = new Core(module, { memory, thread, clock });
    cores.set(memory, core);
  }
  return core;
}

/** The wave as it is played, for the page: see WaveTap. */
class Tap {
  constructor(/** @type {{counter: SharedArrayBuffer, samples: SharedArrayBuffer}} */ { counter, samples }) {
    this.counter = new Int32Array(counter);
    this.samples = new Float32Array(samples);
    this.at = 0;
  }

  write(/** @type {Float32Array} */ block) {
    const { samples } = this;
    for (let index = 0; index < block.length; index += 1) {
      samples[this.at] = block[index];
      this.at = this.at + 1 === samples.length ? 0 : this.at + 1;
    }
    Atomics.add(this.counter, 0, block.length);
  }
}

class SharedVoice extends AudioWorkletProcessor {
  constructor(/** @type {any} */ options) {
    super();
    const given = options.processorOptions;
    this.voice = given.voice;
    this.samples = given.samples;
    const core = coreOf(given);
    this.render = core.exports.hapto_voice_render;
    this.buffer = core.memory.buffer;
    this.view = new Float32Array(this.buffer, this.samples, 128);
    this.isOpen = true;
    /** @type {Tap | null} */
    this.tap = null;
    this.port.onmessage = ({ data }) => {
      if (data.tap !== undefined) {
        this.tap = data.tap && new Tap(data.tap);
        this.port.postMessage({ frame: currentFrame });
      }
      if (data.close) this.isOpen = false;
    };
  }

  process(/** @type {Float32Array[][]} */ inputs, /** @type {Float32Array[][]} */ outputs) {
    const block = outputs[0][0];
    if (currentFrame !== clockFrame) {
      clockFrame = currentFrame;
      clock[0] += (1000 * block.length) / sampleRate;
    }
    // Only a device with another block length ends here, once.
    if (block.length !== this.view.length) this.view = new Float32Array(this.buffer, this.samples, Math.min(block.length, blockFrames));
    this.render(this.voice, this.samples, this.view.length, sampleRate);
    block.set(this.view);
    if (this.tap !== null) this.tap.write(block);
    return this.isOpen;
  }
}

class RingVoice extends AudioWorkletProcessor {
  constructor() {
    super();
    /** @type {Float32Array[]} */
    this.blocks = [];
    this.at = 0;
    this.consumed = 0;
    this.told = 0;
    this.late = 0;
    this.isStarted = false;
    this.isOpen = true;
    this.isTapped = false;
    /** @type {MessagePort | null} */
    this.blocksPort = null;
    this.port.onmessage = ({ data }) => {
      if (data.blocks) {
        this.blocksPort = data.blocks;
        data.blocks.onmessage = (/** @type {MessageEvent} */ event) => this.blocks.push(event.data);
      }
      if (data.tap !== undefined) {
        this.isTapped = data.tap !== null;
        this.port.postMessage({ frame: currentFrame });
      }
      if (data.close) this.isOpen = false;
    };
  }

  process(/** @type {Float32Array[][]} */ inputs, /** @type {Float32Array[][]} */ outputs) {
    const out = outputs[0][0];
    let filled = 0;
    while (filled < out.length && this.blocks.length > 0) {
      const block = this.blocks[0];
      const count = Math.min(out.length - filled, block.length - this.at);
      for (let index = 0; index < count; index += 1) out[filled + index] = block[this.at + index];
      filled += count;
      this.at += count;
      if (this.at === block.length) {
        this.blocks.shift();
        this.at = 0;
        if (this.isTapped) this.port.postMessage({ wave: block }, [block.buffer]);
      }
    }
    this.consumed += filled;
    this.isStarted ||= filled > 0;
    if (filled < out.length && this.isStarted) {
      this.late += 1;
      this.port.postMessage({ late: this.late });
    }
    if (this.consumed - this.told >= 256) {
      this.told = this.consumed;
      this.blocksPort?.postMessage(this.consumed);
    }
    return this.isOpen;
  }
}

registerProcessor('haptoflow-shared', SharedVoice);
registerProcessor('haptoflow-ring', RingVoice);
