// An audio worklet's globals, so that its processors run in Node.

/** @type {Map<string, any>} */
const processors = new Map();

class Processor {
  constructor() {
    /** @type {any[]} */
    this.sent = [];
    this.port = { onmessage: (/** @type {any} */ event) => event, postMessage: (/** @type {any} */ message) => void this.sent.push(message) };
  }
}

Object.assign(globalThis, {
  AudioWorkletProcessor: Processor,
  registerProcessor: (/** @type {string} */ name, /** @type {any} */ type) => processors.set(name, type),
  sampleRate: 48000,
  currentFrame: 0,
});

await import('../../../Web/engine/js/worklet.mjs');

/** @param {string} name @param {object} processorOptions @returns {any} */
export const makeProcessor = (name, processorOptions) => new (processors.get(name))({ processorOptions });
