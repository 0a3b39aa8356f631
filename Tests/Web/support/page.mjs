import { existsSync } from 'node:fs';
import { pageFolder, stagePage } from '../../../scripts/web/build_page.mjs';
import { launchChromium } from '../../../scripts/web/chromium.mjs';
import { serve } from './server.mjs';

let isStaged = false;

/** The live page in Chromium, under a path of its own. Waits until it plays, unless told not to. */
export async function openLivePage({ isolated = true, viewport = { width: 1280, height: 860 }, colorScheme = 'light', reducedMotion = 'no-preference', changes = {}, waits = true } = {}) {
  if (!isStaged || !existsSync(pageFolder())) stagePage();
  isStaged = true;
  const server = await serve({ folders: { somewhere: pageFolder() }, isolated });
  for (const [name, change] of Object.entries(changes)) server.changes.set(`/somewhere/${name}`, change);
  const browser = await launchChromium(['--disable-gpu']);
  const context = await browser.newContext({ viewport, colorScheme: /** @type {any} */ (colorScheme), reducedMotion: /** @type {any} */ (reducedMotion) });
  const page = await context.newPage();
  /** @type {string[]} */
  const complaints = [];
  /** @type {string[]} */
  const strangers = [];
  /** Paths of what was loaded, within the page's folder. @type {Set<string>} */
  const loaded = new Set();
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  page.on('request', (request) => {
    if (/^(data|blob):/.test(request.url())) return;
    const { origin, pathname } = new URL(request.url());
    if (origin !== server.address) strangers.push(request.url());
    else if (pathname.startsWith('/somewhere/')) loaded.add(pathname.slice('/somewhere/'.length));
  });
  await page.goto(`${server.address}/somewhere/index.html`);
  if (waits) await page.waitForFunction(() => 'haptoflowPage' in globalThis, null, { timeout: 30000 });
  return {
    page, complaints, strangers, loaded,
    /** Where places of the table are in the window, now. */
    pointsOf: (/** @type {[number, number][]} */ places) => page.evaluate((wanted) => wanted.map(([x, z]) => {
      const { clientX, clientY } = globalThis.haptoflowPage.view.pointOf(x, z);
      return [clientX, clientY];
    }), places),
    close: async () => {
      await browser.close();
      await server.close();
    },
  };
}

/** Watches in the page what the tips touch and how strong it sounds, every 20 ms; `stop` returns it. */
export async function watch(/** @type {import('playwright-core').Page} */ page) {
  await page.evaluate(() => {
    const { tips } = globalThis.haptoflowPage;
    const taps = tips.map(({ voice }) => voice.waveTap());
    const seen = [];
    const wave = new Float32Array(1920);
    const timer = setInterval(() => {
      for (const [index, tap] of taps.entries()) {
        tap.latest(wave);
        const rms = 200 * Math.sqrt(wave.reduce((sum, sample) => sum + sample * sample, 0) / wave.length);
        seen.push({ tip: index, surface: tips[index].contact?.touching ? tips[index].contact.surfaceName : '', force: tips[index].place.forceNewtons, speed: tips[index].speedMps, rms });
      }
    }, 20);
    globalThis.stopWatching = () => {
      clearInterval(timer);
      taps.forEach((tap) => tap.close());
      return seen;
    };
  });
  return () => page.evaluate(() => globalThis.stopWatching());
}
