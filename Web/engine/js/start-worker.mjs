import { HaptoFlowError } from './errors.mjs';

/**
 * The script of a worker that imports another one. It is a plain script, since Chromium starts no module from a blob in a sandboxed
 * frame; what comes before the import is done is kept for it.
 * @param {URL} address
 */
const importing = (address) => `
const early = [];
onmessage = (event) => early.push(event);
import(${JSON.stringify(address.href)}).then(() => early.forEach((event) => onmessage(event)), (error) => setTimeout(() => { throw error; }));
`;

/**
 * Starts a worker of the engine. A page of another origin than the script's, as each in a sandboxed frame is, may not name the script,
 * but may import it.
 * @param {string} script
 * @param {import('./files.mjs').Places} places
 * @param {string} name for the browser's tools
 * @param {(error: HaptoFlowError) => void} onFailure "worker-lost": the script cannot be loaded, or threw
 * @throws HaptoFlowError "worker-lost" where the browser starts none
 */
export function startWorker(script, places, name, onFailure) {
  const address = new URL(script, places.base);
  try {
    const isOwn = address.origin === globalThis.origin;
    const worker = isOwn
      ? new Worker(address, { type: 'module', name })
      : new Worker(URL.createObjectURL(new Blob([importing(address)], { type: 'text/javascript' })), { name });
    worker.onerror = (event) => {
      event.preventDefault?.();
      onFailure(new HaptoFlowError('worker-lost', `${address}: the worker failed (${event.message || 'it cannot be loaded'})`));
    };
    return worker;
  } catch (error) {
    throw new HaptoFlowError('worker-lost', `${address}: this browser starts no worker (${/** @type {Error} */ (error).message})`);
  }
}
