import assert from 'node:assert/strict';
import { readdirSync } from 'node:fs';
import path from 'node:path';
import { describe, test } from 'node:test';
import { pathToFileURL } from 'node:url';
import { pageFolder } from '../../scripts/lib/web_build.mjs';
import { hasBrowser, isLong, openLivePage, stagedPage } from './support/browser.mjs';

// A page whose scripts do not start says so in plain HTML, and why where that can be known; one that cannot go on says so itself.

// Patience with a busy machine; the page's own limits are in its scripts.
const limitMs = 60000;
const pause = (/** @type {number} */ milliseconds) => new Promise((resolve) => { setTimeout(resolve, milliseconds); });

/** What a reader sees of the page's words about itself; empty while the browser still waits for the page's style. */
const words = () => (document.readyState === 'loading' ? '' : [...document.querySelectorAll('#not-started, #message, noscript')]
  .filter((element) => element.checkVisibility({ visibilityProperty: true }) && element.getBoundingClientRect().height > 10)
  .map((element) => /** @type {HTMLElement} */ (element).innerText.trim()).join(' '));

/** Opens the page, and waits until a reader is told what is expected. */
async function told(/** @type {RegExp} */ expected, /** @type {object} */ options, hasButton = false) {
  const opened = await openLivePage({ waits: false, ...options });
  try {
    let found = '';
    for (const began = performance.now(); performance.now() - began < limitMs && !expected.test(found); await pause(50)) {
      found = await opened.page.evaluate(words).catch(() => '');
    }
    assert.match(found, expected);
    if (hasButton) assert.ok(await opened.page.getByRole('button', { name: 'Try again' }).isVisible());
  } finally {
    await opened.close();
  }
}

/** As a blocker does. */
const without = (/** @type {string[]} */ ...names) => ({ routes: Object.fromEntries(names.map((name) => [name, (/** @type {import('playwright-core').Route} */ route) => route.abort('blockedbyclient')])) });
const replaced = (/** @type {string} */ text) => () => Buffer.from(text);
// Playwright does not see what the audio thread asks for.
const withoutScript = (/** @type {string} */ name) => (name.endsWith('worklet.mjs') ? { changes: { [name]: () => 404 } } : without(name));
const scripts = (/** @type {string} */ folder) => readdirSync(path.join(stagedPage(), folder)).filter((name) => name.endsWith('.mjs')).map((name) => path.posix.join(folder, name));
/** Others are loaded for tasks and outside browsers only. */
const loadedScripts = () => ['.', 'engine', 'panels', 'table'].flatMap(scripts).filter((name) => !/\/(node|offline|offline-worker|effect-costs)\.mjs$/.test(name));

/** Several at once, since some take seconds until the page gives up waiting. */
describe('a page that does not start says so:', { skip: !hasBrowser, concurrency: 3 }, () => {
  for (const [what, expected, options] of /** @type {[string, RegExp, object][]} */ ([
    ['a script that never comes', /has not started/, { routes: { 'table/hand.mjs': () => {} } }],
    ['a blocker that lets no script through', /has not started.*blocker/s, without('**/*.mjs', '*.mjs', '*.js')],
    ['a blocker in a browser without the page\'s style', /has not started.*blocker/s, without('**/*.mjs', '*.mjs', '*.js', 'page.css')],
    ['a server that knows no type and forbids guessing', /has not started/, { mediaTypes: { '.mjs': 'text/plain', '.js': 'text/plain', '.css': 'text/plain' }, headers: { 'X-Content-Type-Options': 'nosniff' } }],
    ...(isLong ? ['text/plain', 'application/octet-stream', ''] : ['text/plain']).map((type) => [`a server that sends modules as "${type}"`, /server.*text\/javascript/, { mediaTypes: { '.mjs': type } }]),
    ['a script that a blocker has emptied', /hand\.mjs/, { changes: { 'table/hand.mjs': replaced('') } }],
    ['a browser that does not know the language of a script', /too old/, { changes: { 'table/tip.mjs': replaced('export class Tip { ###later; }') } }],
    ['a script that throws before the page begins', /no such thing/, { changes: { 'table/press.mjs': replaced('throw new Error("no such thing"); export class Press {} export const penForce = 0;') } }],
    // As such a browser sees it: an unknown type of script, which it passes over.
    ['a browser without modules', /too old/, {
      before: () => { delete HTMLScriptElement.prototype.noModule; },
      changes: { 'index.html': (/** @type {Buffer} */ bytes) => Buffer.from(bytes.toString().replaceAll('type="module"', 'type="text/unknown"')) },
    }],
    ['a browser without WebAssembly', /WebAssembly/, { before: () => { delete globalThis.WebAssembly; } }],
    ['a sandboxed frame whose server does not let it read', /allow-same-origin/, { frame: 'sandbox="allow-scripts"', headers: { 'Cross-Origin-Resource-Policy': 'cross-origin' } }],
  ])) {
    test(what, () => told(expected, options));
  }

  for (const name of isLong ? loadedScripts() : ['app.mjs', 'engine/worklet.mjs', 'table/tip.mjs', 'panels/model.mjs']) {
    test(`a blocker that takes away ${name}`, () => told(/could not be loaded|cannot be loaded|not started/, withoutScript(name)));
  }

  for (const name of ['engine/engine.wasm', 'engine/ort-wasm-simd-threaded.wasm', 'engine/model.haptoflow']) {
    test(`a blocker that takes away ${name}`, () => told(new RegExp(`could not be loaded.*${name}`), without(name)));
  }

  for (const [what, changes, expected] of /** @type {[string, Record<string, any>, RegExp][]} */ ([
    ['a missing model', { 'engine/model.haptoflow': () => 404 }, /model .*could not be loaded.*404/i],
    ['a model that was cut short', { 'engine/model.haptoflow': (bytes) => bytes.subarray(0, 100000) }, /model is damaged/],
    ['a missing scene', { 'table/workbench.json': () => 404 }, /workbench\.json.*404/],
  ])) {
    test(`${what}, with a way to try again`, () => told(expected, { changes }, true));
  }

  test('a browser without JavaScript', async () => {
    const opened = await openLivePage({ waits: false, context: { javaScriptEnabled: false } });
    await opened.outer.locator('noscript').waitFor({ state: 'visible', timeout: limitMs });
    assert.match(await opened.outer.locator('noscript').innerText(), /JavaScript/);
    await opened.close();
  });

  test('a page that was opened as a file', async () => {
    const opened = await openLivePage({ waits: false });
    await opened.page.goto(pathToFileURL(path.join(pageFolder(), 'index.html')).href);
    await opened.page.locator('#not-started').waitFor({ state: 'visible', timeout: limitMs });
    assert.match(await opened.page.locator('#not-started').innerText(), /file.*\.\/run play/s);
    await opened.close();
  });
});

test(`a page that starts says nothing of it${isLong ? ', and neither does a slow one once it has started' : ''}`, { skip: !hasBrowser }, async () => {
  const slow = await openLivePage({ routes: { 'table/hand.mjs': (route) => void setTimeout(() => route.continue(), isLong ? 6000 : 0) } });
  try {
    assert.equal(await slow.page.locator('#not-started').count(), 0);
    assert.deepEqual(slow.complaints, []);
  } finally {
    await slow.close();
  }
});
