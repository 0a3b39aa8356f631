import assert from 'node:assert/strict';
import test from 'node:test';
import { PNG } from 'pngjs';
import { colourOf, spectrogram, spectrogramPng } from '../../scripts/demo/spectrogram.mjs';

const rateHz = 48000;
const tone = (hz, amplitude, seconds) =>
  Float32Array.from({ length: seconds * rateHz }, (_, index) => amplitude * Math.sin((2 * Math.PI * hz * index) / rateHz));
const columnOf = ({ rows, amplitudes }, column) => [...amplitudes.subarray(column * rows, (column + 1) * rows)];

test('a tone peaks in its own bin with its own amplitude', () => {
  const picture = spectrogram(tone(234.375, 0.5, 1), rateHz, 1000);
  const middle = columnOf(picture, 50);
  const peak = Math.max(...middle);
  assert.equal(middle.indexOf(peak), Math.round(234.375 / picture.hzPerRow));
  assert.ok(Math.abs(peak - 0.5) < 0.005, `amplitude ${peak}`);
});

test('the picture covers 0 to the top frequency, 100 columns a second', () => {
  const picture = spectrogram(tone(100, 1, 2), rateHz, 1000);
  assert.equal(picture.columns, 200);
  assert.ok((picture.rows - 1) * picture.hzPerRow <= 1000 && picture.rows * picture.hzPerRow > 1000);
});

test('a tone that starts half-way begins in the middle column', () => {
  const samples = tone(500, 1, 2);
  samples.fill(0, 0, rateHz);
  const picture = spectrogram(samples, rateHz, 1000);
  const row = Math.round(500 / picture.hzPerRow);
  assert.ok(columnOf(picture, 90)[row] < 0.01);
  assert.ok(columnOf(picture, 110)[row] > 0.9);
});

test('the colour map grows lighter at every step', () => {
  const luminance = ([red, green, blue]) => 0.2126 * red + 0.7152 * green + 0.0722 * blue;
  const steps = Array.from({ length: 33 }, (_, index) => luminance(colourOf(index / 32)));
  steps.slice(1).forEach((value, index) => assert.ok(value > steps[index], `step ${index + 1}`));
});

test('values beyond the scale have the colours of its ends', () => {
  assert.deepEqual(colourOf(-Infinity), colourOf(0));
  assert.deepEqual(colourOf(7), colourOf(1));
});

test('the image has low frequencies at the bottom and the strongest bin in the brightest colour', () => {
  const picture = { columns: 1, rows: 3, hzPerRow: 1, amplitudes: Float32Array.from([1, 0, 0]) };
  const image = PNG.sync.read(spectrogramPng(picture, -60, 0));
  const pixel = (row) => [...image.data.subarray(4 * row, 4 * row + 3)];
  assert.deepEqual([image.width, image.height], [1, 3]);
  assert.deepEqual(pixel(2), colourOf(1));
  assert.deepEqual(pixel(0), colourOf(0));
});
