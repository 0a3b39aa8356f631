import { execFileSync } from 'node:child_process';
import { existsSync, mkdtempSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { LabelIndices } from '../../../Web/engine/js/contact-fields.mjs';
import { Core, createMemory } from '../../../Web/engine/js/module.mjs';
import { offlineCore } from '../../../Web/engine/js/offline.mjs';
import { startRuntimeFrom } from '../../../Web/engine/js/runtime.mjs';
import { Scene } from '../../../Web/engine/js/scene.mjs';

export const repository = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..', '..', '..');
export const engineFolder = path.join(repository, 'Web', 'dist', 'engine');

const bytesOf = (/** @type {string} */ name) => readFileSync(path.join(engineFolder, name));

export const modelBytes = bytesOf('model.haptoflow');
export const engineModule = new WebAssembly.Module(bytesOf('engine.wasm'));
export const startOrt = async () => startRuntimeFrom(await import(path.join(engineFolder, 'ort-wasm-simd-threaded.mjs')), bytesOf('ort-wasm-simd-threaded.wasm'));

/** An instance with the shipped model, or with other bytes. */
export async function coreWithModel({ model = modelBytes, onProgress } = {}) {
  return offlineCore({ module: engineModule, runtime: await startOrt(), model, onProgress });
}

/** An instance as a page has it: no model, no ONNX Runtime. */
export const pageCore = () => new Core(engineModule, { memory: createMemory(), isPage: true });

export const sample = (/** @type {string} */ name) => readFileSync(path.join(repository, 'Samples~', 'HeadlessScenes', name), 'utf8');
export const samplePath = (/** @type {string} */ name) => path.join(repository, 'Samples~', 'HeadlessScenes', name);

const commandLine = path.join(repository, 'build', 'native', process.platform === 'win32' ? 'haptoflow.exe' : 'haptoflow');
/** False skips what is compared with the native command line. */
export const hasCommandLine = existsSync(commandLine);

/**
 * Runs the command line; `words` gets a folder that exists during the call of `read`.
 * @template Result
 * @param {(folder: string) => string[]} words
 * @param {(folder: string, output: string) => Result} read
 */
export function native(words, read) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-web-'));
  try {
    return read(folder, execFileSync(commandLine, words(folder), { encoding: 'utf8' }));
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** The samples of a WAV file of 32-bit floats. @param {string} file */
export function wavSamples(file) {
  const bytes = readFileSync(file);
  let at = 12;
  while (bytes.toString('latin1', at, at + 4) !== 'data') at += 8 + bytes.readUInt32LE(at + 4);
  const count = bytes.readUInt32LE(at + 4) / 4;
  return Float32Array.from({ length: count }, (_, index) => bytes.readFloatLE(at + 8 + 4 * index));
}

/** Opens scenes with the shipped model's labels, as a page does. */
export async function sceneOpener() {
  const { labels } = (await coreWithModel()).json('hapto_model_json');
  const indices = new LabelIndices();
  indices.set(labels);
  const core = pageCore();
  return { labels, open: (/** @type {string | object} */ scene) => new Scene(core, indices, labels, scene) };
}

/** A made recording: noise whose level follows the speed, along a turning path. */
export function recording(seconds) {
  const rateHz = 2000;
  let state = 1;
  const random = () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296 - 0.5;
  };
  let noise = 0;
  const rows = Array.from({ length: seconds * rateHz }, (_, index) => {
    const time = index / rateHz;
    const speed = 0.12 + 0.09 * Math.sin((2 * Math.PI * time) / 1.7);
    noise = 0.6 * noise + random();
    return [time, 20 * speed ** 0.7 * noise, speed * Math.cos(time / 2), speed * Math.sin(time / 2), 1].map((number) => number.toFixed(5)).join(',');
  });
  return `time_s,acceleration_mps2,velocity_x_mps,velocity_y_mps,force_newtons\n${rows.join('\n')}\n`;
}
