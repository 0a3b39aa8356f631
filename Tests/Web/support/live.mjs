import { HaptoFlow } from '../engine/haptoflow.mjs';

// What tests call in the page. `hand` publishes strokes at the pace of a display.

globalThis.HaptoFlow = HaptoFlow;

export const pause = (milliseconds) => new Promise((resolve) => {
  setTimeout(resolve, milliseconds);
});

/** Publishes `state(seconds)` every 8 ms for a time. */
async function hand(voice, seconds, state) {
  const began = performance.now();
  for (let now = 0; now < seconds; now = (performance.now() - began) / 1000) {
    voice.publish(state(now));
    await pause(8);
  }
}

/** A slide of changing speed. */
const slide = (material, force = 1) => (seconds) => ({ touching: true, material, velocityMps: [0.12 + 0.06 * Math.sin(7 * seconds), 0.02], forceNewtons: force });

async function started(options = {}) {
  const haptics = await HaptoFlow.create(options);
  await haptics.resume();
  const voice = await haptics.openVoice();
  const events = [];
  for (const type of ['error', 'recovered', 'silent', 'quality', 'context']) {
    haptics.addEventListener(type, ({ detail }) => events.push({ type, ...detail, voice: undefined, error: detail.error && { code: detail.error.code, message: detail.error.message } }));
  }
  return { haptics, voice, events };
}

const rms = (samples) => Math.sqrt(samples.reduce((sum, sample) => sum + sample * sample, 0) / samples.length);

Object.assign(globalThis, { tools: { pause, hand, slide, started, rms } });
