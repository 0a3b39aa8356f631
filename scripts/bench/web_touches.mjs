// Touches of a mouse on the live page, and how long each took to its first sample.

/** Within 60 dB of the touch's own peak, as `onset_ms` of the native benchmark. */
const audibleShare = 1e-3;
const listenMs = 160;

/** What the page does: it notes each press and every block of samples after it. */
function listenInPage({ audible, milliseconds }) {
  const [voice] = globalThis.haptoflowPage.voices;
  const tap = voice.waveTap({ seconds: 1 });
  const chunk = new Float32Array(48000);
  const turn = () => new Promise((resolve) => {
    const { port1, port2 } = new MessageChannel();
    port1.onmessage = () => {
      port1.close();
      resolve(undefined);
    };
    port2.postMessage(0);
  });
  const judge = async (began) => {
    const blocks = [];
    while (performance.now() - began < milliseconds) {
      await turn();
      const frames = tap.read(chunk);
      if (frames > 0) blocks.push({ atMs: performance.now(), samples: chunk.slice(0, frames) });
    }
    const loudest = (samples) => samples.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);
    const peak = Math.max(0, ...blocks.map(({ samples }) => loudest(samples)));
    const first = blocks.find(({ samples }) => loudest(samples) >= audible * peak);
    return peak > 0 && first ? first.atMs - began : null;
  };
  globalThis.touches = [];
  window.addEventListener('pointerdown', (event) => {
    // What sounded before the press is none of its samples.
    while (tap.read(chunk) > 0);
    globalThis.touches.push(judge(event.timeStamp));
  }, true);
}

/**
 * Presses the mouse at random places of the table, draws a little, and lets go.
 * @param {import('playwright-core').Page} page of the live page, in which nothing touches
 * @param {number} count
 * @returns {Promise<{timesMs: number[], missed: number}>} missed: touches without any sound
 */
export async function measureTouches(page, count) {
  await page.evaluate(listenInPage, { audible: audibleShare, milliseconds: listenMs });
  for (let touch = 0; touch < count; touch += 1) {
    const [x, z] = [0.46 * (Math.random() - 0.5), 0.32 * (Math.random() - 0.5)];
    const [from, to] = await page.evaluate((places) => places.map((place) => {
      const { clientX, clientY } = globalThis.haptoflowPage.view.pointOf(...place);
      return [clientX, clientY];
    }), /** @type {[number, number][]} */ ([[x, z], [x + 0.01, z]]));
    await page.mouse.move(from[0], from[1]);
    // In step with neither frames nor blocks, and after the last touch has faded.
    await page.waitForTimeout(150 + 50 * Math.random());
    await page.mouse.down();
    await page.mouse.move(to[0], to[1], { steps: 4 });
    await page.waitForTimeout(listenMs);
    await page.mouse.up();
  }
  const found = await page.evaluate(() => Promise.all(globalThis.touches));
  return { timesMs: found.filter((time) => time !== null), missed: found.filter((time) => time === null).length };
}
