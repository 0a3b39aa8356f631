/**
 * A WAV file of one channel of 32-bit floats.
 * @param {Float32Array} samples @param {number} rateHz @returns {Uint8Array}
 */
export function wavBytes(samples, rateHz) {
  const bytes = new Uint8Array(58 + 4 * samples.length);
  const view = new DataView(bytes.buffer);
  const word = (/** @type {number} */ at, /** @type {string} */ text) => [...text].forEach((letter, index) => view.setUint8(at + index, letter.charCodeAt(0)));
  word(0, 'RIFF');
  view.setUint32(4, bytes.length - 8, true);
  word(8, 'WAVEfmt ');
  view.setUint32(16, 18, true);
  view.setUint16(20, 3, true);
  view.setUint16(22, 1, true);
  view.setUint32(24, rateHz, true);
  view.setUint32(28, 4 * rateHz, true);
  view.setUint16(32, 4, true);
  view.setUint16(34, 32, true);
  view.setUint16(36, 0, true);
  // Files of floats state their number of samples.
  word(38, 'fact');
  view.setUint32(42, 4, true);
  view.setUint32(46, samples.length, true);
  word(50, 'data');
  view.setUint32(54, 4 * samples.length, true);
  for (let index = 0; index < samples.length; index += 1) view.setFloat32(58 + 4 * index, samples[index], true);
  return bytes;
}
