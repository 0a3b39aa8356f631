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
