import FFT from 'fft.js';
import { PNG } from 'pngjs';

const windowSamplesAt48kHz = 4096;
const columnsPerSecond = 100;

/**
 * Amplitude spectrum over time: a sine of amplitude A shows as A in its bin (Hann window, 85 ms).
 * @param {Float32Array} samples @param {number} rateHz @param {number} topHz highest frequency kept
 * @returns {{columns: number, rows: number, hzPerRow: number, amplitudes: Float32Array}} row-major by column, low frequencies first
 */
export function spectrogram(samples, rateHz, topHz) {
  const size = 2 ** Math.round(Math.log2((windowSamplesAt48kHz * rateHz) / 48000));
  const fft = new FFT(size);
  const window = Float64Array.from({ length: size }, (_, index) => 0.5 - 0.5 * Math.cos((2 * Math.PI * index) / size));
  const scale = 2 / window.reduce((sum, value) => sum + value, 0);
  const hzPerRow = rateHz / size;
  const rows = Math.floor(topHz / hzPerRow) + 1;
  const columns = Math.max(1, Math.round((samples.length / rateHz) * columnsPerSecond));
  const amplitudes = new Float32Array(columns * rows);
  const frame = new Float64Array(size);
  const spectrum = fft.createComplexArray();
  for (let column = 0; column < columns; column += 1) {
    const begin = Math.round(((column + 0.5) * samples.length) / columns - size / 2);
    for (let index = 0; index < size; index += 1) frame[index] = (samples[begin + index] ?? 0) * window[index];
    fft.realTransform(spectrum, frame);
    for (let row = 0; row < rows; row += 1) {
      amplitudes[column * rows + row] = scale * Math.hypot(spectrum[2 * row], spectrum[2 * row + 1]);
    }
  }
  return { columns, rows, hzPerRow, amplitudes };
}

/** 20 log10 of an amplitude; -Infinity for none. */
export const decibels = (amplitude) => 20 * Math.log10(amplitude);

// Matplotlib's "inferno" (CC0) at 17 even steps: lightness rises steadily, so stronger always looks brighter.
const inferno = [
  [0, 0, 4], [11, 7, 36], [33, 12, 74], [61, 9, 101], [87, 16, 110], [113, 25, 110], [138, 34, 106], [163, 44, 97],
  [188, 55, 84], [210, 70, 68], [228, 90, 49], [241, 115, 29], [249, 142, 9], [252, 172, 17], [249, 203, 53],
  [242, 234, 105], [252, 255, 164],
];

/** Red, green, blue (0-255) of a value from 0 to 1. */
export function colourOf(share) {
  const place = Math.max(0, Math.min(1, share)) * (inferno.length - 1);
  const lower = Math.min(Math.floor(place), inferno.length - 2);
  return inferno[lower].map((value, channel) => Math.round(value + (place - lower) * (inferno[lower + 1][channel] - value)));
}

/** The spectrogram as PNG bytes, time to the right, frequency upwards, [bottomDb, topDb] over the colour map. */
export function spectrogramPng({ columns, rows, amplitudes }, bottomDb, topDb) {
  const image = new PNG({ width: columns, height: rows, colorType: 2 });
  for (let column = 0; column < columns; column += 1) {
    for (let row = 0; row < rows; row += 1) {
      const share = (decibels(amplitudes[column * rows + row]) - bottomDb) / (topDb - bottomDb);
      const at = 4 * ((rows - 1 - row) * columns + column);
      [image.data[at], image.data[at + 1], image.data[at + 2]] = colourOf(share);
      image.data[at + 3] = 255;
    }
  }
  return PNG.sync.write(image, { colorType: 2, inputColorType: 6 });
}
