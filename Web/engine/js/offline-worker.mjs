import { createClip, readClip } from './clip.mjs';
import { plainError } from './errors.mjs';
import { measureEffects } from './effect-costs.mjs';
import { Core, createMemory } from './module.mjs';
import { imagesOf, learn, measure, offlineCore, render } from './offline.mjs';
import { heightsOfNormals } from './relief.mjs';
import { startRuntime } from './runtime.mjs';

// A worker for one task.

const onProgress = (/** @type {number} */ share, /** @type {string} */ doing) => postMessage({ progress: { share, doing } });

globalThis.onmessage = async (/** @type {MessageEvent<any>} */ { data: { module, onnxRuntime, model, task, options } }) => {
  try {
    if (task === 'heights') {
      const heights = heightsOfNormals(new Core(module, { memory: createMemory({ isLarge: true }), mayWait: true }), options.map);
      postMessage({ result: heights }, { transfer: [/** @type {ArrayBuffer} */ (heights.buffer)] });
      return;
    }
    if (task === 'clip') {
      const core = new Core(module, { memory: createMemory({ isLarge: true }), mayWait: true });
      const clip = options.text === undefined ? createClip(core, options.wave) : readClip(core, options.text);
      postMessage({ result: clip }, { transfer: [/** @type {ArrayBuffer} */ (clip.amplitude.buffer), /** @type {ArrayBuffer} */ (clip.frequencyHz.buffer)] });
      return;
    }
    const core = offlineCore({ module, model, runtime: await startRuntime(onnxRuntime), onProgress });
    if (task === 'render') {
      const result = render(core, { ...options, images: await imagesOf(core, options) });
      postMessage({ result }, { transfer: [/** @type {ArrayBuffer} */ (result.samples.buffer)] });
    } else if (task === 'learn') {
      postMessage({ result: learn(core, options) });
    } else if (task === 'effects') {
      postMessage({ result: measureEffects(core) });
    } else {
      const tiers = options.tiers ?? core.json('hapto_model_json').tiers.map((/** @type {{name: string}} */ { name }) => name);
      postMessage({ result: await measure(core, { tiers, seconds: options.seconds }, onProgress) });
    }
  } catch (error) {
    postMessage({ error: plainError(error) });
  }
};
