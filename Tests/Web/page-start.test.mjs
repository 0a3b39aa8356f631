import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import path from 'node:path';
import { after, afterEach, before, describe, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { pageFolder } from '../../scripts/web/build.mjs';
import { launchChromium } from '../../scripts/web/chromium.mjs';
import { casesOf, hasBrowser, isLong } from './support/browser.mjs';
import { openLivePage } from './support/page.mjs';

// A page whose scripts do not start says so in plain HTML, and why where that can be known.

const limitMs = 5000;
const pause = (/** @type {number} */ milliseconds) => new Promise((resolve) => { setTimeout(resolve, milliseconds); });
/** @type {import('playwright-core').Browser} */
let browser;
/** @type {Awaited<ReturnType<typeof openLivePage>>} */
let opened;

/** What a reader sees of the page's words about itself; empty while the browser still waits for the page's style. */
const words = () => (document.readyState === 'loading' ? '' : [...document.querySelectorAll('#not-started, #message, noscript')]
  .filter((element) => element.checkVisibility({ visibilityProperty: true }) && element.getBoundingClientRect().height > 10)
  .map((element) => /** @type {HTMLElement} */ (element).innerText.trim()).join(' '));

/** Opens the page, and waits until a reader is told what is expected. */
async function told(expected, options) {
  opened = await openLivePage({ browser, waits: false, ...options });
  let found = '';
  for (const began = performance.now(); performance.now() - began < limitMs && !expected.test(found); await pause(50)) {
    found = await opened.page.evaluate(words).catch(() => '');
  }
  assert.match(found, expected);
}

const scripts = (/** @type {string} */ folder) => readdirSync(path.join(pageFolder(), folder)).filter((name) => name.endsWith('.mjs')).map((name) => path.posix.join(folder, name));
/** As a blocker does. */
const without = (/** @type {string[]} */ ...names) => ({ routes: Object.fromEntries(names.map((name) => [name, (/** @type {import('playwright-core').Route} */ route) => route.abort('blockedbyclient')])) });
const replaced = (/** @type {string} */ text) => () => Buffer.from(text);

describe('a page that does not start says so within 5 seconds:', { skip: !hasBrowser }, () => {
  before(async () => {
    browser = await launchChromium(['--disable-gpu']);
    // Stages the page.
    await (await openLivePage({ browser })).close();
  });
  afterEach(() => opened?.close());
  after(() => browser.close());

  for (const [type] of casesOf([['text/plain'], ['application/octet-stream'], ['']], ['text/plain'])) {
    test(`a server that sends modules as "${type}"`, async () => {
      await told(/server.*text\/javascript/, { mediaTypes: { '.mjs': type } });
    });
  }

  test('a server that knows no type and forbids guessing', async () => {
    await told(/has not started/, { mediaTypes: { '.mjs': 'text/plain', '.js': 'text/plain', '.css': 'text/plain' }, headers: { 'X-Content-Type-Options': 'nosniff' } });
  });

  test('a blocker that lets no script through', async () => {
    await told(/has not started.*blocker/s, without('**/*.mjs', '*.mjs', '*.js'));
  });

  test('a blocker in a browser without the page\'s style', async () => {
    await told(/has not started.*blocker/s, without('**/*.mjs', '*.mjs', '*.js', 'page.css'));
  });

  test('a script that never comes', async () => {
    await told(/has not started/, { routes: { 'hand/hand.mjs': () => {} } });
  });

  test('each script that a blocker takes away', async () => {
    const silent = [];
    // Others are loaded for tasks and outside browsers only.
    const loaded = ['.', 'engine', 'hand', 'panels', 'signal', 'table'].flatMap(scripts).filter((name) => !/\/(node|offline|offline-worker|effect-costs)\.mjs$/.test(name));
    for (const [name] of casesOf(loaded.map((each) => [each]), ['app.mjs', 'engine/worklet.mjs', 'hand/tip.mjs', 'panels/model.mjs'])) {
      // Playwright does not see what the audio thread asks for.
      await told(/could not be loaded|cannot be loaded|not started/, name.endsWith('worklet.mjs') ? { changes: { [name]: () => 404 } } : without(name)).catch((error) => silent.push(`${name}: ${error.message}`));
      await opened.close();
    }
    assert.deepEqual(silent, []);
  });

  for (const name of ['engine/engine.wasm', 'engine/ort-wasm-simd-threaded.wasm', 'engine/model.haptoflow']) {
    test(`a blocker that takes away ${name}`, async () => {
      await told(new RegExp(`could not be loaded.*${name}`), without(name));
    });
  }

  test('a script that a blocker has emptied', async () => {
    await told(/hand\.mjs/, { changes: { 'hand/hand.mjs': replaced('') } });
  });

  test('a browser that does not know the language of a script', async () => {
    await told(/too old/, { changes: { 'hand/tip.mjs': replaced('export class Tip { ###later; }') } });
  });

  test('a script that throws before the page begins', async () => {
    await told(/no such thing/, { changes: { 'hand/press.mjs': replaced('throw new Error("no such thing"); export class Press {} export const penForce = 0;') } });
  });

  test('a browser without modules', async () => {
    // As such a browser sees it: an unknown type of script, which it passes over.
    await told(/too old/, {
      before: () => { delete HTMLScriptElement.prototype.noModule; },
      changes: { 'index.html': (bytes) => Buffer.from(bytes.toString().replaceAll('type="module"', 'type="text/unknown"')) },
    });
  });

  test('a browser without JavaScript', async () => {
    opened = await openLivePage({ browser, waits: false, context: { javaScriptEnabled: false } });
    await opened.outer.locator('noscript').waitFor({ state: 'visible', timeout: limitMs });
    assert.match(await opened.outer.locator('noscript').innerText(), /JavaScript/);
  });

  test('a browser without WebAssembly', async () => {
    await told(/WebAssembly/, { before: () => { delete globalThis.WebAssembly; } });
  });

  test('a sandboxed frame whose server does not let it read', async () => {
    await told(/allow-same-origin/, { frame: 'sandbox="allow-scripts"', headers: { 'Cross-Origin-Resource-Policy': 'cross-origin' } });
  });

  test('a page that was opened as a file', async () => {
    opened = await openLivePage({ browser });
    await opened.page.goto(pathToFileURL(path.join(pageFolder(), 'index.html')).href);
    await opened.page.locator('#not-started').waitFor({ state: 'visible', timeout: limitMs });
    assert.match(await opened.page.locator('#not-started').innerText(), /file.*\.\/run play/s);
  });
});

test(`a page that starts says nothing of it${isLong ? ', and neither does a slow one once it has started' : ''}`, { skip: !hasBrowser }, async () => {
  const slow = await openLivePage({ routes: { 'hand/hand.mjs': (route) => void setTimeout(() => route.continue(), isLong ? 6000 : 0) } });
  try {
    assert.equal(await slow.page.locator('#not-started').count(), 0);
    assert.deepEqual(slow.complaints, []);
  } finally {
    await slow.close();
  }
});
