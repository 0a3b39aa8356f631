import assert from 'node:assert/strict';
import { test } from 'node:test';
import { MotorTap } from '../../Web/engine/js/motor-tap.mjs';
import { pageCore } from './support/engine.mjs';

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
