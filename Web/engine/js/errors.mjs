/** Every error of this package; see haptoflow.d.ts for the codes. */
export class HaptoFlowError extends Error {
  /**
   * @param {string} code
   * @param {string} message
   */
  constructor(code, message) {
    super(message);
    this.name = 'HaptoFlowError';
    this.code = code;
  }
}

/**
 * An error that came as a message from another thread, or anything that was thrown, as a HaptoFlowError.
 * @param {unknown} error
 * @param {string} [code] for what carries none
 */
export function asHaptoFlowError(error, code = 'INTERNAL_ERROR') {
  if (error instanceof HaptoFlowError) return error;
  const found = /** @type {{code?: unknown, message?: unknown}} */ (error ?? {});
  return new HaptoFlowError(typeof found.code === 'string' ? found.code : code, String(found.message ?? error));
}

/**
 * What postMessage carries of an error.
 * @param {unknown} error
 */
export const plainError = (error) => {
  const { code, message } = asHaptoFlowError(error);
  return { code, message };
};

/**
 * @param {AbortSignal | undefined} signal
 * @throws HaptoFlowError with the code "aborted"
 */
export function requireNotAborted(signal) {
  if (signal?.aborted) throw new HaptoFlowError('aborted', 'aborted by the caller');
}
