import { existsSync } from 'node:fs';
import path from 'node:path';
import { after } from 'node:test';
import { pageFolder, stagePage } from '../../../scripts/lib/web_build.mjs';
import { chromiumPath, launchChromium } from '../../../scripts/lib/chromium.mjs';
import { engineFolder, repository } from './engine.mjs';
import { serve } from './server.mjs';

/** False skips the tests that need a browser. */
export const hasBrowser = chromiumPath !== undefined;

/** Whether this is the long form, `./run test --all`. */
export const isLong = process.env.HAPTOFLOW_LONG_TESTS === '1';

/** The rows of a table of cases that run: all in the long form, by default those of these names. */
export const casesOf = (/** @type {any[][]} */ rows, /** @type {string[]} */ daily) => (isLong ? rows : rows.filter(([name]) => daily.includes(name)));

/** One browser for all pages of a file. @type {Promise<import('playwright-core').Browser> | undefined} */
let browser;
after(async () => (await browser)?.close());

/** A page in a context of its own, and what it complains of. */
async function openTab(/** @type {import('playwright-core').BrowserContextOptions} */ options) {
  browser ??= launchChromium(['--disable-gpu']);
  const context = await (await browser).newContext(options);
  /** @type {string[]} */
  const complaints = [];
  const page = await context.newPage();
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  return { context, page, complaints };
}

/**
 * A page in Chromium with the engine beside it.
 * @param {{isolated?: boolean, engine?: string, name?: string, folders?: Record<string, string>, viewport?: {width: number, height: number}}} [options]
 *   engine: the folder of its files; name: of the page in Tests/Web/support; folders: what it needs besides
 */
export async function openPage({ isolated = true, engine = engineFolder, name = 'live', folders = {}, viewport } = {}) {
  const server = await serve({ folders: { engine, pages: path.join(repository, 'Tests', 'Web', 'support'), ...folders }, isolated });
  const { context, page, complaints } = await openTab({ viewport });
  await page.goto(`${server.address}/pages/${name}.html`);
  await page.waitForFunction(() => 'HaptoFlow' in globalThis);
  return {
    page, context, server, complaints,
    close: async () => {
      await context.close();
      await server.close();
    },
  };
}

// The runner puts the page together before files run beside each other, so that none takes it from another.
let isStaged = process.env.HAPTOFLOW_PAGE_IS_STAGED === '1';

/** The live page's folder, put together once. */
export function stagedPage() {
  if (!isStaged || !existsSync(pageFolder())) stagePage();
  isStaged = true;
  return pageFolder();
}

/** A page in Chromium with the live page's parts and an emulated Quest. */
export const openHeadsetPage = (/** @type {object} */ options = {}) => openPage({
  name: 'xr',
  folders: { somewhere: stagedPage(), iwer: path.join(repository, 'node_modules', 'iwer', 'build') },
  ...options,
});

/**
 * The live page in Chromium, under a path of its own. Waits until it plays, unless told not to.
 * @param {object} [options]
 * @param {boolean} [options.isolated] @param {{width: number, height: number}} [options.viewport] @param {string} [options.colorScheme]
 * @param {string} [options.reducedMotion] @param {Record<string, (bytes: Buffer) => Buffer | number>} [options.changes] @param {boolean} [options.waits]
 * @param {Record<string, string>} [options.headers] of every file besides @param {Record<string, string>} [options.mediaTypes] by a file's ending
 * @param {(() => void) | (() => void)[]} [options.before] runs in the page before its first script @param {string} [options.script] a file that runs before it
 * @param {string} [options.frame] attributes of a frame in a page of another origin, in which the live page then stands
 * @param {Record<string, (route: import('playwright-core').Route) => any>} [options.routes] what becomes of files, by their names
 * @param {import('playwright-core').BrowserContextOptions} [options.context] further options of Playwright's browser context
 */
export async function openLivePage({
  isolated = true, viewport = { width: 1280, height: 860 }, colorScheme = 'light', reducedMotion = 'no-preference', changes = {}, waits = true,
  headers = {}, mediaTypes = {}, script, before, frame, routes = {}, context: more = {},
} = {}) {
  const place = '/somewhere/index.html';
  const server = await serve({ folders: { somewhere: stagedPage() }, isolated, headers, mediaTypes });
  server.documents.set('/outer.html', `<!doctype html><iframe src="${server.address}${place}" ${frame} style="width: 1200px; height: 800px"></iframe>`);
  for (const [name, change] of Object.entries(changes)) server.changes.set(`/somewhere/${name}`, change);
  const { context, page: outer, complaints } = await openTab({ viewport, colorScheme: /** @type {any} */ (colorScheme), reducedMotion: /** @type {any} */ (reducedMotion), ...more });
  if (script) await context.addInitScript({ path: script });
  for (const each of [before ?? []].flat()) await context.addInitScript(each);
  for (const [name, handle] of Object.entries(routes)) await context.route(`**/somewhere/${name}`, handle);
  /** @type {string[]} */
  const strangers = [];
  /** Paths of what was loaded, within the page's folder. @type {Set<string>} */
  const loaded = new Set();
  outer.on('request', (request) => {
    if (/^(data|blob):/.test(request.url())) return;
    const { origin, pathname } = new URL(request.url());
    if (origin !== server.address) strangers.push(request.url());
    else if (pathname.startsWith('/somewhere/')) loaded.add(pathname.slice('/somewhere/'.length));
  });
  const close = async () => {
    await context.close();
    await server.close();
  };
  // The frame's page is of another origin.
  await outer.goto(frame === undefined ? `${server.address}${place}` : `${server.address.replace('127.0.0.1', 'localhost')}/outer.html`, { waitUntil: waits || frame !== undefined ? 'load' : 'commit' });
  const page = frame === undefined ? outer : /** @type {import('playwright-core').Page} */ (/** @type {unknown} */ (outer.frames()[1]));
  if (waits) {
    await page.waitForFunction(() => 'haptoflowPage' in globalThis, null, { timeout: 30000 }).catch(async (error) => {
      const said = await page.evaluate(() => document.body.innerText.slice(0, 400));
      await close();
      throw new Error(`${error.message}; the page says: ${said}`);
    });
  }
  return {
    /** In a frame, the frame. */
    page, outer, complaints, strangers, loaded,
    /** Where places of the table are in the window, now. */
    pointsOf: (/** @type {[number, number][]} */ places) => page.evaluate((wanted) => wanted.map(([x, z]) => {
      const { clientX, clientY } = globalThis.haptoflowPage.view.pointOf(x, z);
      return [clientX, clientY];
    }), places),
    close,
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
