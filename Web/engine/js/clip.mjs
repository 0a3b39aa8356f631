import { HaptoFlowError } from './errors.mjs';

// Clips: what other tools and devices play. The engine's C++ makes, reads and writes them; see haptoflow.d.ts.

/** By haptoflow_clip_format. */
export const clipFormats = /** @type {const} */ (['haptic', 'ahap', 'hjif']);

/** The engine makes points this far apart; read ones lie anywhere. */
const curveStepSeconds = 0.004;
/** Of wave features. */
const waveRateHz = 2000;
/** For a rate that is no multiple of it. */
const usualRateHz = 48000;

/** @typedef {import('./module.mjs').Core} Core */
/** @typedef {import('./haptoflow.d.ts').Clip} Clip */
/** @typedef {import('./haptoflow.d.ts').ClipOptions} ClipOptions */

const byteLength = (/** @type {string} */ text) => new TextEncoder().encode(text).length;

/** @param {ClipOptions} options @throws HaptoFlowError "invalid-argument" */
export function requireWave({ samples, rateHz, fullScaleMps2 = 200 }) {
  if (!(samples instanceof Float32Array)) throw new HaptoFlowError('invalid-argument', 'samples: expected a Float32Array');
  if (!(rateHz >= 8000 && rateHz <= 192000)) throw new HaptoFlowError('invalid-argument', `rateHz is ${rateHz}; expected 8000 to 192000`);
  if (!(fullScaleMps2 > 0 && fullScaleMps2 <= 1000)) throw new HaptoFlowError('invalid-argument', `fullScaleMps2 is ${fullScaleMps2}; expected above 0 to 1000, and 1 for samples in m/s^2`);
}

/**
 * Copies a wave in m/s^2 into an instance, to be freed; of a rate that the features do not take, at 48 kHz by straight lines,
 * as motor-tap.mjs does.
 * @param {Core} core @param {ClipOptions} options
 */
function copyWave(core, { samples, rateHz, fullScaleMps2 = 200 }) {
  const copiedHz = rateHz % waveRateHz === 0 ? rateHz : usualRateHz;
  const step = rateHz / copiedHz;
  const count = Math.floor(samples.length / step);
  const address = core.allocate(Math.max(4, 4 * count));
  const target = core.f32.subarray(address >> 2, (address >> 2) + count);
  for (let index = 0; index < count; index += 1) {
    const left = Math.floor(index * step);
    const right = Math.min(left + 1, samples.length - 1);
    target[index] = fullScaleMps2 * (samples[left] + (index * step - left) * (samples[right] - samples[left]));
  }
  return { address, count, copiedHz };
}

/** What is done with an open clip. @template Result @param {Core} core @param {number} clip @param {(clip: number) => Result} action */
function withClip(core, clip, action) {
  try {
    return action(clip);
  } finally {
    core.call('hapto_clip_close', clip);
  }
}

/** The clip in every format. @param {Core} core @param {number} clip @returns {Record<typeof clipFormats[number], string>} */
function filesOf(core, clip) {
  // The command line's date is that of UTC, too.
  const date = new Date().toISOString().slice(0, 10);
  return /** @type {any} */ (Object.fromEntries(clipFormats.map((name, format) => [name, core.text('hapto_clip_text', clip, format, date)])));
}

function curvesOf(/** @type {Core} */ core, /** @type {number} */ clip, /** @type {number} */ seconds) {
  const count = Math.max(2, Math.round(seconds / curveStepSeconds) + 1);
  const address = core.allocate(8 * count);
  try {
    core.call('hapto_clip_curves', clip, count, address, address + 4 * count);
    const at = address >> 2;
    return { amplitude: core.f32.slice(at, at + count), frequencyHz: core.f32.slice(at + count, at + 2 * count) };
  } finally {
    core.free(address);
  }
}

/**
 * Reads a clip file's text.
 * @param {Core} core @param {string} text @param {Clip['files']} [files] where they exist already
 * @returns {Clip}
 * @throws HaptoFlowError
 */
export function readClip(core, text, files) {
  if (typeof text !== 'string') throw new HaptoFlowError('invalid-argument', 'text: expected the text of a .haptic, .ahap or .hjif file');
  const length = byteLength(text);
  return withClip(core, core.call('hapto_clip_read', text, length), (clip) => {
    const figures = core.json('hapto_clip_json', clip);
    return {
      ...figures,
      transients: core.json('hapto_clip_transients', text, length),
      ...curvesOf(core, clip, figures.seconds),
      files: files ?? filesOf(core, clip),
      text,
    };
  });
}

/**
 * Makes the clip of a wave.
 * @param {Core} core @param {ClipOptions} options
 * @returns {Clip} as its .haptic file says
 * @throws HaptoFlowError
 */
export function createClip(core, options) {
  requireWave(options);
  const { isLoop = false, title = '', description = '', source = '' } = options;
  const { address, count, copiedHz } = copyWave(core, options);
  let clip = 0;
  try {
    clip = core.call('hapto_clip_create', address, count, copiedHz, isLoop ? 1 : 0, title, description, source);
  } finally {
    core.free(address);
  }
  const files = withClip(core, clip, () => filesOf(core, clip));
  return readClip(core, files.haptic, files);
}

/**
 * Opens a clip for the voices of a live engine. Returns its address.
 * @param {Core} core @param {string} text
 */
export function openClip(core, text) {
  const clip = core.call('hapto_clip_read', text, byteLength(text));
  try {
    core.call('hapto_clip_prepare', clip);
    return clip;
  } catch (error) {
    core.call('hapto_clip_close', clip);
    throw error;
  }
}
