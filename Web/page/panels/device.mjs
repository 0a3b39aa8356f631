import { distribution } from '../engine/distribution.mjs';
import { pause } from '../engine/pause.mjs';
import { find, shown } from '../dom.mjs';
import { sentenceOf } from '../messages.mjs';

const touches = 40;
const longestWaitMs = 90;

/** Lets messages of the audio thread in, without the rest that timers take. */
export function turn() {
  return new Promise((resolve) => {
    const channel = new MessageChannel();
    channel.port1.onmessage = () => {
      channel.port1.close();
      resolve(undefined);
    };
    channel.port2.postMessage(0);
  });
}

/**
 * Milliseconds from publishing a touch-down until the audio thread has rendered its first sample, for each of some touches. The
 * output's own latency follows.
 * @param {import('../../engine/js/haptoflow.d.ts').Voice} voice
 */
export async function touchToSampleMs(voice, count = touches) {
  const tap = voice.waveTap({ seconds: 1 });
  const wave = new Float32Array(Math.round(tap.sampleRateHz));
  const found = [];
  const state = { touching: true, velocityMps: /** @type {[number, number]} */ ([0.15, 0]), forceNewtons: 1, material: 'sandpaper' };
  for (let touch = 0; touch < count; touch += 1) {
    // Not in step with the audio thread's blocks.
    await pause(70 + 30 * Math.random());
    while (tap.read(wave) > 0);
    const began = performance.now();
    voice.publish(state);
    let hasSounded = false;
    while (!hasSounded && performance.now() - began < longestWaitMs) {
      await turn();
      const frames = tap.read(wave);
      for (let index = 0; index < frames && !hasSounded; index += 1) hasSounded = wave[index] !== 0;
    }
    if (hasSounded) found.push(performance.now() - began);
    voice.lift();
  }
  tap.close();
  return found;
}

/** Measures this device, as a row of the benchmark page and as JSON. */
export class DevicePanel {
  #haptics;
  #hand;
  #voice;
  #button = find('#measure');
  #progress = find('#measure-progress');
  #result = find('#measure-result');
  #row = find('#measure-row');
  #json = '';
  /** In the last stay in the headset; NaN before. */
  posesPerSecond = NaN;

  /** @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {import('../table/hand.mjs').Hand} hand @param {import('../../engine/js/haptoflow.d.ts').Voice} voice */
  constructor(haptics, hand, voice) {
    this.#haptics = haptics;
    this.#hand = hand;
    this.#voice = voice;
    this.#button.addEventListener('click', () => void this.measure());
    find('#copy-row').addEventListener('click', () => void this.#copy(this.#row.textContent));
    find('#copy-json').addEventListener('click', () => void this.#copy(this.#json));
  }

  async #copy(/** @type {string} */ text) {
    try {
      await navigator.clipboard.writeText(text);
      this.#progress.textContent = 'Copied.';
    } catch {
      this.#progress.textContent = 'The browser did not allow copying: select the text and copy it by hand.';
    }
  }

  async measure() {
    this.#button.disabled = true;
    this.#hand.releaseAll();
    try {
      await this.#haptics.resume();
      this.#progress.textContent = 'Touching …';
      const onset = await touchToSampleMs(this.#voice);
      const tiers = await this.#haptics.measure({
        seconds: 2,
        onProgress: (share, doing) => {
          this.#progress.textContent = `${doing} (${Math.round(100 * share)} %)`;
        },
      });
      this.#show(tiers, onset);
      this.#progress.textContent = 'Done. Run it on an idle device: other programs change the figures.';
    } catch (error) {
      this.#progress.textContent = sentenceOf(error);
    }
    this.#button.disabled = false;
  }

  #show(/** @type {import('../../engine/js/haptoflow.d.ts').Measurement[]} */ tiers, /** @type {number[]} */ onset) {
    const statistics = this.#haptics.statistics();
    const delays = this.#hand.eventDelaysMs;
    const report = {
      date: new Date().toISOString().slice(0, 10),
      userAgent: navigator.userAgent,
      cores: navigator.hardwareConcurrency,
      model: this.#haptics.model.name,
      sharing: statistics.sharing,
      sampleRateHz: statistics.sampleRateHz,
      baseLatencyMs: statistics.baseLatencyMs,
      outputLatencyMs: statistics.outputLatencyMs,
      outputUnderruns: statistics.outputUnderruns,
      posesPerSecond: this.posesPerSecond,
      touchToSampleMs: distribution(onset),
      eventToPublishMs: distribution(delays),
      tiers,
    };
    const times = tiers.map(({ tier, hotMs, pacedMs }) => `${tier} ${shown(hotMs.median, 2)} / ${shown(pacedMs.median, 2)} (${shown(pacedMs.percentile99, 2)})`).join(', ');
    const latency = `${shown(statistics.baseLatencyMs, 1)} + ${shown(statistics.outputLatencyMs, 1)}`;
    const touch = `${shown(report.touchToSampleMs.median, 1)} (${shown(report.touchToSampleMs.percentile99, 1)})`;
    const events = delays.length > 0 ? `${shown(report.eventToPublishMs.median, 1)} (${shown(report.eventToPublishMs.percentile99, 1)})` : '–';
    // The browser's own words for itself may hold the character that parts columns.
    const name = navigator.userAgent.replaceAll('|', '/');
    this.#row.textContent = `| ${name} | ${report.cores} | ${report.sharing} | ${times} | ${latency} | ${touch} | ${events} | ${shown(report.posesPerSecond, 0)} | ${report.date} |`;
    this.#json = JSON.stringify(report, null, 2);
    find('#measure-json').textContent = this.#json;
    this.#result.hidden = false;
  }
}
