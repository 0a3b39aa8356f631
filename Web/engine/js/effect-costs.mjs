import { effectMask, field, fieldCount } from './contact-fields.mjs';
import { openClip } from './clip.mjs';
import { makeRelief } from './relief.mjs';

// What each effect adds to a block: a voice plays the same stroke with it and without it, in turns, and the quickest of each
// count, since other programs only ever make a run slower.

const sketchQuality = 4;
const blockFrames = 128;
const rateHz = 48000;
const blocksPerState = 5;
const statesPerRun = 60;
const runs = 7;

const texture = { texture: true, impact: false, edge: false, relief: false };
/** Ribs 2 mm apart. */
const ribs = { columns: 128, rows: 1, heightsMetres: Float32Array.from({ length: 128 }, (_, index) => [0, 5e-5, 1e-4, 5e-5][index % 4]), sizeMetres: /** @type {[number, number]} */ ([0.064, 0.064]), depthMetres: 1e-4 };
const speedMps = 0.15;

/** A second of 160 Hz. */
const clip = JSON.stringify({ version: { major: 1, minor: 0, patch: 0 }, signals: { continuous: { envelopes: { amplitude: [{ time: 0, amplitude: 0.3 }, { time: 1, amplitude: 0.3 }] } } } });

/** @type {{effect: string, effects?: object, set?: [string, number], actuator?: string, clip?: string}[]} */
const subjects = [
  { effect: 'impact', effects: { ...texture, impact: true } },
  { effect: 'edge', effects: { ...texture, edge: true } },
  { effect: 'relief', effects: { ...texture, relief: true } },
  { effect: 'clip', clip },
  { effect: 'delay', set: ['delay', 0.02] },
  { effect: 'compensation', actuator: 'voice-coil' },
  { effect: 'listen', set: ['listen', 1] },
];

class Player {
  /** @param {import('./module.mjs').Core} core */
  constructor(core) {
    this.core = core;
    this.fields = core.allocate(8 * fieldCount);
    this.samples = core.allocate(4 * blockFrames);
    this.counter = 0;
    this.relief = makeRelief(core, ribs);
  }

  /** A voice with what a subject asks for. */
  open(/** @type {{set?: [string, number], actuator?: string}} */ { set, actuator }) {
    const voice = this.core.call('hapto_voice_create', rateHz);
    if (set) this.core.call('hapto_voice_set', voice, ...set);
    if (actuator) this.core.call('hapto_voice_set_actuator', voice, actuator, actuator.length);
    return voice;
  }

  /** Milliseconds of the blocks of one run, without publishing and inference. */
  play(/** @type {number} */ voice, /** @type {number} */ effects) {
    const { core } = this;
    let spent = 0;
    const mapsPerState = (speedMps * blocksPerState * blockFrames) / rateHz / ribs.sizeMetres[0];
    for (let state = 0; state < statesPerRun; state += 1) {
      const at = this.fields >> 3;
      this.counter += state % 10 === 0 ? 1 : 0;
      const values = { touching: 1, touchCounter: this.counter, labelCount: 1, weights: 1, velocity: speedMps, force: 1, approachSpeed: 0.2, effects, edgeCounter: this.counter, edgeHeight: 0.001, spatialScale: 1, relief: this.relief, reliefPlace: state * mapsPerState, reliefShare: 0.5 };
      for (const [name, value] of Object.entries(values)) core.f64[at + /** @type {any} */ (field)[name]] = value;
      core.call('hapto_voice_publish', voice, this.fields);
      core.call('hapto_engine_turn', 0);
      const began = performance.now();
      for (let block = 0; block < blocksPerState; block += 1) core.exports.hapto_voice_render(voice, this.samples, blockFrames, rateHz);
      spent += performance.now() - began;
    }
    return spent;
  }
}

/**
 * @param {import('./module.mjs').Core} core with a model
 * @returns {import('./haptoflow.d.ts').EffectMeasurement[]}
 */
export function measureEffects(core) {
  core.call('hapto_engine_create', sketchQuality, 72, 200, 1, 8);
  const player = new Player(core);
  const perBlock = 1000 / (statesPerRun * blocksPerState);
  const plain = player.open({});
  const plainMask = effectMask(texture);
  player.play(plain, plainMask);
  let own = Infinity;
  const rows = subjects.map((subject) => {
    const voice = player.open(subject);
    const mask = effectMask(subject.effects ?? texture);
    const loop = subject.clip ? openClip(core, subject.clip) : 0;
    if (loop !== 0) core.call('hapto_voice_play_clip', voice, loop, 1, 1);
    player.play(voice, mask);
    let [off, on] = [Infinity, Infinity];
    for (let run = 0; run < runs; run += 1) {
      off = Math.min(off, player.play(plain, plainMask));
      on = Math.min(on, player.play(voice, mask));
    }
    own = Math.min(own, off);
    core.call('hapto_voice_destroy', voice);
    if (loop !== 0) core.call('hapto_clip_close', loop);
    return { effect: subject.effect, microsecondsPerBlock: Math.max(0, on - off) * perBlock };
  });
  core.call('hapto_engine_close');
  return /** @type {any} */ ([{ effect: 'texture', microsecondsPerBlock: own * perBlock }, ...rows]);
}
