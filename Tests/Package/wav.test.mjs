import assert from 'node:assert/strict';
import test from 'node:test';
import { commonGain, peakOf, readFloatWav, writePcm16Wav } from '../../scripts/demo/wav.mjs';

/** A float WAV with a chunk of odd size before its data, as audio editors write it. */
function floatWav(samples, rateHz, { format = 3, channels = 1, bits = 32 } = {}) {
  const data = Buffer.from(Float32Array.from(samples).buffer);
  const head = Buffer.alloc(36);
  head.write('RIFF', 0, 'latin1');
  head.writeUInt32LE(46 + data.length, 4);
  head.write('WAVEfmt ', 8, 'latin1');
  head.writeUInt32LE(16, 16);
  head.writeUInt16LE(format, 20);
  head.writeUInt16LE(channels, 22);
  head.writeUInt32LE(rateHz, 24);
  head.writeUInt16LE(bits, 34);
  const odd = Buffer.from('note\u0001\u0000\u0000\u0000x\u0000', 'latin1');
  const size = Buffer.alloc(8);
  size.write('data', 0, 'latin1');
  size.writeUInt32LE(data.length, 4);
  return Buffer.concat([head, odd, size, data]);
}

test('rate and samples of a float file are read, and unknown chunks are skipped', () => {
  const { rateHz, samples } = readFloatWav(floatWav([0, 0.5, -1], 48000), 'a.wav');
  assert.equal(rateHz, 48000);
  assert.deepEqual([...samples], [0, 0.5, -1]);
});

test('a file that is no WAV is refused by name', () => {
  assert.throws(() => readFloatWav(Buffer.from('not a sound file'), 'b.wav'), /b\.wav: expected a RIFF\/WAVE file/);
});

test('stereo and 16-bit files are refused, and the message states their format', () => {
  assert.throws(() => readFloatWav(floatWav([0, 0], 48000, { channels: 2 }), 'c.wav'), /2 channels/);
  assert.throws(() => readFloatWav(floatWav([0, 0], 48000, { format: 1, bits: 16 }), 'c.wav'), /16 bits/);
});

test('a file cut off in its data is refused', () => {
  const whole = floatWav([0, 0.5, -1, 0.25], 48000);
  assert.throws(() => readFloatWav(whole.subarray(0, whole.length - 4), 'd.wav'), /"data" chunk is cut off/);
});

test('16-bit output carries rate, length and scaled samples, and clips instead of wrapping', () => {
  const bytes = writePcm16Wav(Float32Array.from([0, 0.25, -0.25, 0.9]), 48000, 2);
  assert.equal(bytes.readUInt32LE(24), 48000);
  assert.equal(bytes.readUInt32LE(40), 8);
  assert.deepEqual([0, 1, 2, 3].map((index) => bytes.readInt16LE(44 + 2 * index)), [0, 16384, -16383, 32767]);
});

test('with the common gain the loudest signal peaks at -1 dBFS, and the ratios of the signals stay', () => {
  const loud = Float32Array.from([0.1, -0.4]);
  const quiet = Float32Array.from([0.04]);
  const gain = commonGain([quiet, loud]);
  assert.ok(Math.abs(20 * Math.log10(peakOf(loud) * gain) + 1) < 1e-6);
  assert.ok(Math.abs(peakOf(loud) / peakOf(quiet) - 10) < 1e-5);
});

test('silent signals have a gain of 1', () => {
  assert.equal(commonGain([new Float32Array(8)]), 1);
});
