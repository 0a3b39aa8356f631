import assert from 'node:assert/strict';
import { test } from 'node:test';
import { hasBrowser, openPage } from './support/browser.mjs';

const minutes = 10;

test(`${minutes} minutes of strokes leave no underrun, no sample that is not finite, and no more memory`, { skip: !hasBrowser, timeout: (minutes + 2) * 60000 }, async () => {
  const opened = await openPage();
  try {
    const devtools = await opened.context.newCDPSession(opened.page);
    await devtools.send('Performance.enable');
    const heapBytes = async () => {
      await devtools.send('HeapProfiler.collectGarbage');
      const { metrics } = await devtools.send('Performance.getMetrics');
      return metrics.find(({ name }) => name === 'JSHeapUsedSize').value;
    };
    await opened.page.evaluate(async () => {
      const { haptics, voice, events } = await globalThis.tools.started();
      Object.assign(globalThis, { haptics, voice, events, tap: voice.waveTap(), motor: voice.motorTap() });
    });
    // Strokes of 2 to 4 s on every label, a tap now and then, a pause between.
    const play = (seconds) => opened.page.evaluate(async (limit) => {
      const { hand, pause } = globalThis.tools;
      const { voice, haptics, motor } = globalThis;
      const began = performance.now();
      globalThis.stroke ??= 0;
      let taps = 0;
      while (performance.now() - began < 1000 * limit) {
        globalThis.stroke += 1;
        const { name } = haptics.labels[globalThis.stroke % haptics.labels.length];
        const phase = globalThis.stroke;
        await hand(voice, 2 + (phase % 3), (now) => ({
          touching: true, material: name, touchCounter: phase, approachSpeedMps: 0.1, forceNewtons: 1 + 0.8 * Math.sin(now + phase),
          velocityMps: [0.3 * Math.sin(1.7 * now + phase), 0.1 * Math.cos(0.9 * now)],
        }));
        voice.lift();
        motor.peak();
        await pause(300);
        taps += 1;
      }
      return taps;
    }, seconds);
    await play(20);
    const before = { heap: await heapBytes(), memory: await opened.page.evaluate(() => globalThis.haptics.statistics().memoryBytes) };
    await play(60 * minutes - 20);
    const after = { heap: await heapBytes(), memory: await opened.page.evaluate(() => globalThis.haptics.statistics().memoryBytes) };
    const { voice, engine, events } = await opened.page.evaluate(() => ({ voice: globalThis.voice.statistics(), engine: globalThis.haptics.statistics(), events: globalThis.events }));
    console.log(JSON.stringify({ before, after, voice: { ...voice, effects: undefined }, tiers: engine.tiers }));
    assert.equal(voice.underruns, 0);
    assert.equal(voice.nonFiniteSamples, 0);
    assert.equal(voice.failures, 0);
    assert.equal(engine.recoveries, 0);
    assert.deepEqual(events.filter(({ type }) => type === 'error'), []);
    assert.equal(after.memory, before.memory);
    assert.ok(after.heap < before.heap + 1e6, `the page's heap grew from ${before.heap} to ${after.heap} bytes`);
    assert.ok(voice.renderedFrames > 0.95 * 60 * minutes * engine.sampleRateHz);
  } finally {
    await opened.close();
  }
});
