import { distribution } from './distribution.mjs';
import { HaptoFlowError } from './errors.mjs';
import { Core, createMemory } from './module.mjs';
import { pause } from './pause.mjs';
import { heightsOfNormals, makeRelief, normalMapOf, usualShare, withHeights } from './relief.mjs';
import { loadedImages, optionsOf } from './scene-reliefs.mjs';

// What takes seconds: renders, learning, measuring. In a browser in a worker of its own (offline-worker.mjs), in Node here.

/**
 * An instance with a model, for the functions below.
 * @param {{module: WebAssembly.Module, runtime: import('./runtime.mjs').Runtime, model: Uint8Array, onProgress?: (share: number, doing: string) => void}} options
 */
export function offlineCore({ module, runtime, model, onProgress }) {
  const core = new Core(module, { memory: createMemory({ isLarge: true }), mayWait: true, runtime: runtime.imports, onProgress });
  runtime.attach(core);
  const bytes = core.copyIn(model);
  core.call('hapto_model_open', bytes, model.length);
  core.free(bytes);
  return core;
}

const texture = { texture: true, impact: false, edge: false };

const textOf = (/** @type {string | object} */ scene) => (typeof scene === 'string' ? scene : JSON.stringify(scene));

/**
 * The reliefs that the scene itself names and that are felt, with the radius of its tip.
 * @param {Core} core
 * @param {import('./haptoflow.d.ts').RenderOptions} options
 * @returns {{tipRadiusMetres: number, named: import('./scene-reliefs.mjs').NamedRelief[]}}
 */
function reliefsOf(core, { scene, reliefs = {}, effects = texture }) {
  const { tipRadiusMetres, reliefs: named } = core.json('hapto_scene_reliefs', textOf(scene));
  const isFelt = effects.relief !== false;
  return { tipRadiusMetres, named: named.filter((/** @type {{surface: string}} */ { surface }) => isFelt && !Object.hasOwn(reliefs, surface)) };
}

/**
 * The images that the render needs.
 * @param {Core} core
 * @param {import('./haptoflow.d.ts').RenderOptions & {sceneBase: string}} options
 */
export const imagesOf = (core, options) => loadedImages(reliefsOf(core, options).named, options);

/**
 * @param {Core} core
 * @param {import('./haptoflow.d.ts').RenderOptions} options
 * @returns {import('./haptoflow.d.ts').Render}
 */
export function render(core, options) {
  const { scene, stroke, quality = '', seed = 1, leadMs = 8, rateHz = 48000, effects = texture, listen = false, actuator = null, delayMs = 0, fullScaleMps2 = 200, materials = [], reliefs = {}, images = {} } = options;
  const { tipRadiusMetres, named } = reliefsOf(core, options);
  const own = named.map((each) => /** @type {const} */ ([each.surface, optionsOf(each, images, tipRadiusMetres)]));
  /** @type {{surface: string, number: number, along: number, across: number, share: number}[]} */
  const laid = [];
  try {
    for (const [surface, relief] of [...own, ...Object.entries(reliefs)]) {
      const [along, across] = relief.sizeMetres;
      const normals = normalMapOf(relief);
      const number = makeRelief(core, withHeights(relief, normals && heightsOfNormals(core, normals)));
      laid.push({ surface, number, along, across, share: relief.share ?? usualShare });
    }
    const figures = core.json('hapto_render', JSON.stringify({
      scene: textOf(scene),
      stroke, quality, seed, leadMs, rateHz, effects, listen, fullScaleMps2, materials,
      reliefs: laid,
      actuator: actuator ?? '',
      delaySeconds: delayMs / 1000,
    }));
    const first = core.exports.hapto_samples() >> 2;
    return { ...figures, fullScaleMps2, samples: core.f32.slice(first, first + core.exports.hapto_sample_count()) };
  } finally {
    for (const { number } of laid) core.call('hapto_relief_destroy', number);
  }
}

/** Copies floats in; 0 for none. */
function copyFloats(/** @type {Core} */ core, /** @type {Float32Array | undefined} */ numbers) {
  return numbers ? core.copyIn(new Uint8Array(numbers.buffer, numbers.byteOffset, numbers.byteLength)) : 0;
}

function recordingFrom(/** @type {Core} */ core, /** @type {any} */ recording) {
  if (!recording || (Array.isArray(recording) && recording.length === 0)) throw new HaptoFlowError('invalid-argument', 'recording: expected files or samples');
  if (Array.isArray(recording)) {
    return {
      files: recording.map(({ name, bytes }) => {
        const copy = bytes instanceof Uint8Array ? bytes : new Uint8Array(bytes);
        return { name, address: core.copyIn(copy), count: copy.length };
      }),
    };
  }
  const axisCount = recording.axisCount ?? 1;
  return {
    samples: {
      axisCount,
      count: Math.floor(recording.accelerationMps2.length / axisCount),
      sampleRateHz: recording.sampleRateHz,
      acceleration: copyFloats(core, recording.accelerationMps2),
      velocity: copyFloats(core, recording.velocityMps),
      force: copyFloats(core, recording.forceNewtons),
      constantVelocityMps: recording.constantVelocityMps ?? [0, 0],
      constantForceNewtons: recording.constantForceNewtons ?? 0,
    },
  };
}

/**
 * @param {Core} core
 * @param {import('./haptoflow.d.ts').LearnOptions} options
 * @returns {import('./haptoflow.d.ts').LearntMaterial}
 */
export function learn(core, options) {
  const { recording, wavFullScaleMps2 = 0, category = '', description = '', licence = '', quality = '', seed = 1, secondsLimit = 60 } = options;
  const name = options.name ?? (Array.isArray(recording) ? '' : /** @type {any} */ (recording).name);
  const learnt = core.json('hapto_learn', JSON.stringify({
    ...recordingFrom(core, recording), name, category, description, licence, quality, seed, secondsLimit, wavFullScaleMps2,
  }));
  return { ...learnt, notes: learnt.notes.split('\n').filter((/** @type {string} */ note) => note !== '') };
}

function timedSegment(/** @type {Core} */ core) {
  const began = performance.now();
  core.call('hapto_measure_segment');
  return performance.now() - began;
}

/**
 * Times tiers, hot and at the pace of use.
 * @param {Core} core
 * @param {{tiers: readonly string[], seconds: number}} options
 * @param {(share: number, doing: string) => void} onProgress
 * @returns {Promise<import('./haptoflow.d.ts').Measurement[]>}
 */
export async function measure(core, { tiers, seconds }, onProgress) {
  const rows = [];
  const paceMs = 1000 / 72;
  for (const [index, tier] of tiers.entries()) {
    onProgress(index / tiers.length, tier);
    core.call('hapto_measure_load', tier);
    for (let run = 0; run < 20; run += 1) timedSegment(core);
    const hot = [];
    for (const end = performance.now() + 500 * seconds; performance.now() < end;) hot.push(timedSegment(core));
    const paced = [];
    for (const end = performance.now() + 500 * seconds; performance.now() < end;) {
      await pause(paceMs);
      paced.push(timedSegment(core));
    }
    rows.push({ tier, hotMs: distribution(hot), pacedMs: distribution(paced) });
  }
  onProgress(1, 'done');
  return rows;
}
