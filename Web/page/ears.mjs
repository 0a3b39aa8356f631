// Makes waves for a hand audible. A texture at its true level lies some 40 dB below full scale. The engine's own `listen` would do
// it, but changes the wave that motors, pictures and recordings get, too: ears have a branch of their own.

const brighter = { type: 'highshelf', frequency: 600, gain: 12 };
const gain = 10;
const even = { threshold: -30, knee: 20, ratio: 6, attack: 0.003, release: 0.1 };
/** From -1 to 1; what lies beyond stays at the ends. */
const bend = Float32Array.from({ length: 257 }, (_, index) => Math.tanh(1.5 * (index / 128 - 1)));

/** One branch for all voices; the waves themselves stay as they are. */
export class Ears {
  #input;
  #destination;

  /** @param {AudioContext} context @param {AudioNode} destination */
  constructor(context, destination) {
    this.#input = new BiquadFilterNode(context, /** @type {any} */ (brighter));
    this.#destination = destination;
    this.#input.connect(new GainNode(context, { gain })).connect(new DynamicsCompressorNode(context, even)).connect(new WaveShaperNode(context, { curve: bend })).connect(destination);
  }

  /** @param {import('../engine/js/haptoflow.d.ts').Voice} voice it sounds here instead of in the engine's output */
  take(voice) {
    voice.node.disconnect();
    voice.node.connect(this.#input);
  }

  /** @param {import('../engine/js/haptoflow.d.ts').Voice} voice it sounds at its true level */
  release(voice) {
    voice.node.disconnect();
    voice.node.connect(this.#destination);
  }
}
