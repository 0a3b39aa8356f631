import { readFile } from 'node:fs/promises';
import { createClip, readClip } from './clip.mjs';
import { learn, offlineCore, render } from './offline.mjs';
import { startRuntimeFrom } from './runtime.mjs';

export { decodePng } from './png.mjs';

const own = (/** @type {string} */ name) => new URL(name, import.meta.url);

/**
 * Opens a model in Node: see node.d.ts.
 * @param {import('./node.d.ts').OfflineOptions} [options]
 */
export async function openOffline({ model, onProgress } = {}) {
  const [wasm, script, runtimeWasm, shipped] = await Promise.all([
    readFile(own('engine.wasm')),
    import(own('ort-wasm-simd-threaded.mjs').href),
    readFile(own('ort-wasm-simd-threaded.wasm')),
    model ?? readFile(own('model.haptoflow')),
  ]);
  const module = await WebAssembly.compile(wasm);
  const core = offlineCore({ module, runtime: await startRuntimeFrom(script, runtimeWasm), model: shipped, onProgress });
  return {
    model: core.json('hapto_model_json'),
    render: (/** @type {any} */ options) => render(core, options),
    learn: (/** @type {any} */ options) => learn(core, options),
    createClip: (/** @type {any} */ options) => createClip(core, options),
    readClip: (/** @type {string} */ text) => readClip(core, text),
  };
}
