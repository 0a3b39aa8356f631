import { HaptoFlowError } from './errors.mjs';

/**
 * What to ask of a browser on a device. The audio thread takes a two-hundredth of a block, so that the smallest buffer will do;
 * but Android's may be no multiple of a block, and Chromium makes it one for "interactive" alone.
 * @param {string} userAgent
 * @returns {AudioContextLatencyCategory | number}
 */
export const latencyHintOf = (userAgent) => (/Android/.test(userAgent) ? 'interactive' : 0);

/**
 * Returns the page's own context, or makes one with the shortest latency that suits the device.
 * @param {AudioContext | undefined} given
 * @throws HaptoFlowError "audio-unavailable"
 */
export function usableContext(given) {
  if (given) return given;
  try {
    return new AudioContext({ sampleRate: 48000, latencyHint: latencyHintOf(navigator.userAgent) });
  } catch (error) {
    throw new HaptoFlowError('audio-unavailable', `this browser gives no audio context: ${/** @type {Error} */ (error).message}`);
  }
}
