// What listens to a voice: the wave as it is played, and points for motors.
import assert from 'node:assert/strict';
import test from 'node:test';
import { MotorTap } from '../../Web/engine/js/motor-tap.mjs';
import { TapSource, WaveTap } from '../../Web/engine/js/wave-tap.mjs';
import { pageCore } from './support/engine.mjs';

const rateHz = 1000;

/** A voice whose node writes blocks of one value. */
function voiceOf() {
  const voice = { tapSource: new TapSource(rateHz, false), releaseTap() {} };
  const play = (value, frames = 128) => voice.tapSource.write(new Float32Array(frames).fill(value));
  const restart = (startSeconds) => {
    const next = new TapSource(rateHz, false);
    next.continueFrom(voice.tapSource);
    next.startSeconds = startSeconds;
    voice.tapSource = next;
  };
  return { voice, play, restart };
}

test('a tap that was open when the engine started again reads what sounds afterwards', () => {
  const { voice, play, restart } = voiceOf();
  const tap = new WaveTap(voice, 2);
  play(0.5);
  const read = new Float32Array(64);
  assert.equal(tap.read(read), 64);
  restart(7);
  play(0.25);
  const rest = new Float32Array(512);
  assert.equal(tap.read(rest), 192);
  // What the lost node had written and nobody read is silence.
  assert.deepEqual([rest[0], rest[63], rest[64], rest[191]], [0, 0, 0.25, 0.25]);
  const newest = new Float32Array(200);
  tap.latest(newest);
  assert.deepEqual([newest[71], newest[72], newest[199]], [0, 0.25, 0.25]);
});

test('a tap opened after the engine started again beside an older one reads from its own beginning', () => {
  const { voice, play, restart } = voiceOf();
  const older = new WaveTap(voice, 2);
  play(0.5);
  restart(7);
  play(0.25);
  const tap = new WaveTap(voice, 2);
  play(0.75);
  const read = new Float32Array(256);
  assert.equal(tap.read(read), 128);
  assert.equal(read[0], 0.75);
  assert.equal(older.written, 384);
});

test('after a restart the time of a frame is that of the new node', () => {
  const { voice, play, restart } = voiceOf();
  const tap = new WaveTap(voice, 2);
  play(0.5);
  restart(7);
  play(0.25);
  assert.equal(tap.secondsOf(128), 7);
  assert.equal(tap.secondsOf(tap.written), 7.128);
});

test('a tap reads across the end of the memory and keeps what it remembers', () => {
  const { voice, play } = voiceOf();
  const tap = new WaveTap(voice, 2);
  for (let block = 0; block < 480; block += 1) play(block % 2 === 0 ? 0.5 : -0.5);
  const read = new Float32Array(4000);
  assert.equal(tap.read(read), 2000);
  assert.equal(read[1999], -0.5);
});

const core = pageCore();

/** A tap of a sine of 200 Hz that stops after a second. */
function sineTap(sampleRateHz, amplitude) {
  let at = 0;
  return {
    sampleRateHz,
    secondsOf: (frame) => 10 + frame / sampleRateHz,
    read(into) {
      const count = Math.min(into.length, 1.5 * sampleRateHz - at);
      for (let index = 0; index < count; index += 1) into[index] = at + index < sampleRateHz ? amplitude * Math.sin((2 * Math.PI * 200 * (at + index)) / sampleRateHz) : 0;
      at += count;
      return count;
    },
    close() {},
  };
}

for (const rateHz of [44100, 48000]) {
  test(`at ${rateHz} Hz a sine of 4 m/s^2 gives points of its amplitude and frequency, then none`, () => {
    const motor = new MotorTap(core, sineTap(rateHz, 4 / 200), 200, {});
    const points = motor.read();
    assert.ok(Math.abs(points.length - 1.5 / 0.005) <= 4, `${points.length} points`);
    const middle = points.filter(({ timeSeconds }) => timeSeconds > 10.3 && timeSeconds < 10.9);
    assert.ok(middle.length > 100);
    for (const point of middle) {
      assert.ok(Math.abs(point.amplitudeMps2 - 4) < 0.4, `${point.amplitudeMps2}`);
      assert.ok(Math.abs(point.frequencyHz - 200) < 10, `${point.frequencyHz}`);
      assert.ok(point.share > 0 && point.share < 1);
    }
    assert.ok(points.at(-1).share < 0.01);
    motor.close();
  });
}

test('the peak is the largest share since the last call, and a louder wave has a larger one', () => {
  const quiet = new MotorTap(core, sineTap(48000, 1 / 200), 200, {});
  const loud = new MotorTap(core, sineTap(48000, 8 / 200), 200, {});
  const [first, second] = [quiet.peak(), loud.peak()];
  assert.ok(first > 0 && second > first && second < 1);
  assert.ok(loud.peak() < 0.01);
});
