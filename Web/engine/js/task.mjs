import { asHaptoFlowError, HaptoFlowError, requireNotAborted } from './errors.mjs';
import { engineModule, modelBytes, placesOf } from './files.mjs';
import { startWorker } from './start-worker.mjs';

/**
 * Runs a task of offline.mjs in a worker of its own, which a signal ends at once.
 * @param {'render' | 'learn' | 'measure' | 'effects' | 'heights' | 'clip'} task
 * @param {any} options
 * @returns {Promise<any>}
 */
export async function runTask(task, { signal, onProgress = () => {}, base, onnxRuntime, model, module, ...options }) {
  requireNotAborted(signal);
  const places = placesOf({ base, onnxRuntime });
  onProgress(0, 'loading');
  const [compiled, bytes] = await Promise.all([module ?? engineModule(places, signal), modelBytes(model, places, signal)]);
  requireNotAborted(signal);
  /** @type {Worker | undefined} */
  let worker;
  try {
    return await new Promise((resolve, reject) => {
      signal?.addEventListener('abort', () => reject(new HaptoFlowError('aborted', 'aborted by the caller')));
      worker = startWorker('offline-worker.mjs', places, `haptoflow ${task}`, reject);
      worker.onmessage = ({ data: { progress, result, error } }) => {
        if (progress) onProgress(progress.share, progress.doing);
        else if (error) reject(asHaptoFlowError(error));
        else resolve(result);
      };
      worker.postMessage({ module: compiled, onnxRuntime: places.onnxRuntime, model: bytes, task, options });
    });
  } finally {
    worker?.terminate();
  }
}
