import { HaptoFlowError } from './errors.mjs';

/** @typedef {{base: string, onnxRuntime: string}} Places addresses of folders, ending with a slash */

/** @param {string | URL} folder */
const asFolder = (folder) => String(folder).replace(/\/?$/, '/');

/**
 * Absolute addresses of the folders of the engine's files.
 * @param {{base?: string | URL, onnxRuntime?: string | URL}} locations
 * @returns {Places}
 */
export function placesOf({ base, onnxRuntime }) {
  const here = new URL('./', import.meta.url).href;
  const page = globalThis.document?.baseURI ?? here;
  const own = base === undefined ? here : new URL(asFolder(base), page).href;
  return { base: own, onnxRuntime: onnxRuntime === undefined ? own : new URL(asFolder(onnxRuntime), page).href };
}

/**
 * The bytes of a file.
 * @param {string | URL} address
 * @param {{code: string, remedy: string, signal?: AbortSignal, onShare?: (share: number) => void}} options
 * @returns {Promise<Uint8Array>}
 * @throws HaptoFlowError with `code` that names the address, what the server said and the remedy
 */
export async function bytesOf(address, { code, remedy, signal, onShare }) {
  let answer;
  try {
    answer = await fetch(address, { signal });
  } catch (error) {
    if (signal?.aborted) throw new HaptoFlowError('aborted', 'aborted by the caller');
    throw new HaptoFlowError(code, `${address}: no answer (${/** @type {Error} */ (error).message}); ${remedy}`);
  }
  if (!answer.ok) throw new HaptoFlowError(code, `${address}: ${`${answer.status} ${answer.statusText}`.trim()}; ${remedy}`);
  try {
    const total = Number(answer.headers.get('content-length'));
    if (!onShare || !answer.body || !(total > 0)) return new Uint8Array(await answer.arrayBuffer());
    return await collected(answer.body, total, onShare);
  } catch (error) {
    if (signal?.aborted) throw new HaptoFlowError('aborted', 'aborted by the caller');
    throw new HaptoFlowError(code, `${address}: the connection broke (${/** @type {Error} */ (error).message}); try again`);
  }
}

async function collected(/** @type {ReadableStream<Uint8Array>} */ body, /** @type {number} */ total, /** @type {(share: number) => void} */ onShare) {
  const parts = [];
  let count = 0;
  const reader = body.getReader();
  for (let part = await reader.read(); !part.done; part = await reader.read()) {
    parts.push(part.value);
    count += part.value.length;
    onShare(Math.min(1, count / total));
  }
  const bytes = new Uint8Array(count);
  let at = 0;
  for (const part of parts) {
    bytes.set(part, at);
    at += part.length;
  }
  return bytes;
}

/**
 * The compiled engine.
 * @param {Places} places
 * @param {AbortSignal} [signal]
 */
export async function engineModule(places, signal) {
  const address = new URL('engine.wasm', places.base);
  const remedy = 'the folder of haptoflow.mjs must hold engine.wasm, or `base` name the folder that does';
  if (typeof WebAssembly !== 'object') throw new HaptoFlowError('engine-unreachable', 'this browser has no WebAssembly, or it is switched off: use another browser, or allow it for this page');
  const bytes = await bytesOf(address, { code: 'engine-unreachable', remedy, signal });
  try {
    return await WebAssembly.compile(/** @type {BufferSource} */ (bytes));
  } catch (error) {
    const { message } = /** @type {Error} */ (error);
    if (bytes.length > 0 && WebAssembly.validate(/** @type {BufferSource} */ (bytes))) {
      throw new HaptoFlowError('engine-unreachable', `${address}: this page may not compile WebAssembly (${message}); its Content-Security-Policy must have script-src with 'wasm-unsafe-eval'`);
    }
    throw new HaptoFlowError('engine-unreachable', `${address}: is not the engine (${message}); ${remedy}. If it does: this browser lacks what it is compiled for, which is WebAssembly with SIMD, exceptions and shared memory`);
  }
}

/**
 * The bytes of a model, given or at an address.
 * @param {string | URL | ArrayBuffer | Uint8Array | undefined} model
 * @param {Places} places
 * @param {AbortSignal} [signal]
 * @param {(share: number) => void} [onShare]
 */
export async function modelBytes(model, places, signal, onShare) {
  if (model instanceof ArrayBuffer) return new Uint8Array(model);
  if (model instanceof Uint8Array) return model;
  const page = globalThis.document?.baseURI ?? places.base;
  const address = model === undefined ? new URL('model.haptoflow', places.base) : new URL(model, page);
  return bytesOf(address, { code: 'model-unreachable', remedy: 'check the address of the model', signal, onShare });
}
