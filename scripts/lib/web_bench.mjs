import { distribution } from '../../Web/engine/js/distribution.mjs';

// Writes the results of `npm run bench:web` as Markdown tables.

/** @typedef {{tier: string, hotMs: import('../../Web/engine/js/haptoflow.d.ts').Distribution, pacedMs: import('../../Web/engine/js/haptoflow.d.ts').Distribution}} BrowserTier */
/** @typedef {{touchesMs: {shared: number[], ring: number[]}, missed: {shared: number, ring: number}, browser: BrowserTier[], native: any}} Round native: a report of `haptoflow bench` */

const ms = (value) => value.toFixed(2);

/** Ratios of each round, and their middle: `middle (least to most)`. */
export function spread(ratios) {
  const { minimum, median, worst } = distribution(ratios);
  return `${median.toFixed(1)} (${minimum.toFixed(1)} to ${worst.toFixed(1)})`;
}

function touchRow(name, times, missed) {
  const { count, median, percentile99, worst } = distribution(times);
  return `| ${name} | ${count} | ${missed} | ${median.toFixed(1)} | ${percentile99.toFixed(1)} | ${worst.toFixed(1)} |`;
}

function nativeRow(rounds) {
  const { block_frames: frames, p50, p99, worst, count, missed } = rounds.at(-1).native.onset_ms;
  return `| the native engine: from publishing a touch-down, blocks of ${frames} frames | ${count} | ${missed} | ${p50.toFixed(1)} | ${p99.toFixed(1)} | ${worst.toFixed(1)} |`;
}

function tierRow(rounds, tier) {
  const cells = ['hot', 'paced'].flatMap((pace) => {
    const browser = rounds.map((round) => round.browser.find((each) => each.tier === tier)[`${pace}Ms`].median);
    const native = rounds.map((round) => (pace === 'hot' ? round.native.inference_ms[tier] : round.native.inference_ms[tier].paced).p50);
    return [ms(distribution(browser).median), ms(distribution(native).median), spread(browser.map((time, round) => time / native[round]))];
  });
  return `| ${tier} | ${cells.join(' | ')} |`;
}

/** Above the rows of *Measure this device* (Web/page/panels/device.mjs). */
const deviceHeader = [
  '| browser | cores | memory | ms for a segment: hot / paced (99th percentile of paced) | latency that the browser states: base + output, ms | touch to first sample rendered (99th percentile), ms | pointer event to engine (99th percentile), ms | poses per second in the headset | date |',
  '|---|---|---|---|---|---|---|---|---|',
];

/**
 * @param {Round[]} rounds
 * @param {{machine: string, browserName: string, outputLatencyMs: number, deviceRow: string}} where
 */
export function webTables(rounds, { machine, browserName, outputLatencyMs, deviceRow }) {
  const all = (way) => rounds.flatMap(({ touchesMs }) => touchesMs[way]);
  const missed = (way) => rounds.reduce((sum, round) => sum + round.missed[way], 0);
  return [
    `${machine}; ${browserName}; ${rounds.length} rounds, in each the browser and the native engine in turns.`,
    '',
    '| from a touch to its first sample, ms | touches | without sound | median | 99th percentile | worst |',
    '|---|---|---|---|---|---|',
    touchRow('pointer event to its sample rendered, shared memory', all('shared'), missed('shared')),
    touchRow('pointer event to its sample rendered, ring', all('ring'), missed('ring')),
    nativeRow(rounds),
    '',
    `To be heard, a sample takes the output's latency in addition; the browser states ${outputLatencyMs.toFixed(1)} ms for it. The goal is 15 ms at the 99th percentile with shared memory.`,
    '',
    '| one segment, ms (medians) | browser, hot | native, hot | ratio: middle (least to most of the rounds) | browser, paced | native, paced | ratio |',
    '|---|---|---|---|---|---|---|',
    ...rounds[0].browser.map(({ tier }) => tierRow(rounds, tier)),
    '',
    'The goal is at most 3 times the native time.',
    '',
    'The row of *Measure this device* on the same machine:',
    '',
    ...deviceHeader,
    deviceRow,
  ].join('\n');
}

// Touches of a mouse on the live page, and how long each took to its first sample.

/** Within 60 dB of the touch's own peak, as `onset_ms` of the native benchmark. */
const audibleShare = 1e-3;
const strokeMs = 160;
const watchMs = 500;

/**
 * What the page does. It notes when blocks of samples were rendered, and how loud each is: with shared memory by a worker that
 * looks at the audio thread's counter, since the page itself may be drawing; else as its messages come.
 */
async function watchInPage() {
  const { turn } = await import('./panels/device.mjs');
  const [voice] = globalThis.haptoflowPage.voices;
  const tap = voice.waveTap({ seconds: 1 });
  const { shared } = voice.tapSource.memory;

  function lookAtCounter() {
    globalThis.onmessage = ({ data: { counter, samples, milliseconds } }) => {
      const [count, wave] = [new Int32Array(counter), new Float32Array(samples)];
      const sleep = new Int32Array(new SharedArrayBuffer(4));
      const blocks = [];
      const began = performance.now();
      let seen = Atomics.load(count, 0) >>> 0;
      while (performance.now() - began < milliseconds) {
        Atomics.wait(sleep, 0, 0, 0.1);
        const now = Atomics.load(count, 0) >>> 0;
        if (now === seen) continue;
        const atMs = performance.timeOrigin + performance.now();
        let peak = 0;
        for (; seen < now; seen += 1) peak = Math.max(peak, Math.abs(wave[seen % wave.length]));
        blocks.push({ atMs, peak });
      }
      postMessage(blocks);
    };
  }

  async function lookAtMessages(milliseconds) {
    const chunk = new Float32Array(48000);
    const blocks = [];
    while (tap.read(chunk) > 0);
    for (const began = performance.now(); performance.now() - began < milliseconds;) {
      await turn();
      const frames = tap.read(chunk);
      if (frames > 0) blocks.push({ atMs: performance.timeOrigin + performance.now(), peak: chunk.subarray(0, frames).reduce((most, sample) => Math.max(most, Math.abs(sample)), 0) });
    }
    return blocks;
  }

  const worker = shared && new Worker(URL.createObjectURL(new Blob([`(${lookAtCounter})()`], { type: 'text/javascript' })));
  globalThis.watchBlocks = (milliseconds) => {
    globalThis.pressedMs = NaN;
    globalThis.watched = worker
      ? new Promise((resolve) => {
        worker.onmessage = ({ data }) => resolve(data);
        worker.postMessage({ ...shared, milliseconds });
      })
      : lookAtMessages(milliseconds);
  };
  window.addEventListener('pointerdown', (event) => {
    globalThis.pressedMs = performance.timeOrigin + event.timeStamp;
  }, true);
}

/** From a press to its first audible block; null where nothing sounded. */
export function timeOf({ pressedMs, blocks }) {
  const after = blocks.filter(({ atMs }) => atMs > pressedMs);
  const peak = Math.max(0, ...after.map((block) => block.peak));
  return peak > 0 ? after.find((block) => block.peak >= audibleShare * peak).atMs - pressedMs : null;
}

/**
 * Presses the mouse at random places of the table, draws a little, and lets go.
 * @param {import('playwright-core').Page} page of the live page, in which nothing touches
 * @param {number} count
 * @returns {Promise<{timesMs: number[], missed: number}>} missed: touches without any sound
 */
export async function measureTouches(page, count) {
  await page.evaluate(watchInPage);
  const found = [];
  for (let touch = 0; touch < count; touch += 1) {
    const [x, z] = [0.46 * (Math.random() - 0.5), 0.32 * (Math.random() - 0.5)];
    const [from, to] = await page.evaluate((places) => places.map((place) => {
      const { clientX, clientY } = globalThis.haptoflowPage.view.pointOf(...place);
      return [clientX, clientY];
    }), /** @type {[number, number][]} */ ([[x, z], [x + 0.01, z]]));
    await page.mouse.move(from[0], from[1]);
    await page.evaluate((milliseconds) => globalThis.watchBlocks(milliseconds), watchMs);
    // In step with neither frames nor blocks, and after the last touch has faded.
    await page.waitForTimeout(150 + 50 * Math.random());
    await page.mouse.down();
    await page.mouse.move(to[0], to[1], { steps: 4 });
    await page.waitForTimeout(strokeMs);
    await page.mouse.up();
    found.push(timeOf(await page.evaluate(async () => ({ blocks: await globalThis.watched, pressedMs: globalThis.pressedMs }))));
  }
  return { timesMs: found.filter((time) => time !== null), missed: found.filter((time) => time === null).length };
}
