import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { hasBrowser, isLong, openLivePage } from './support/browser.mjs';

// Nothing has to be scrolled aside, whatever is open, at any width and zoom.

/** @type {Awaited<ReturnType<typeof openLivePage>>} */
let opened;

/** Opens all that can be opened, with long texts. */
function openAll() {
  const name = 'grillePorteMoustiquaireGalvaniséeÀMaillesFines_no_space_anywhere_0123456789';
  const { haptics, palette, compare, device } = globalThis.haptoflowPage;
  const labels = [...haptics.labels, { name, index: haptics.labels.length, isAdded: true }];
  Object.defineProperty(haptics, 'labels', { configurable: true, get: () => labels });
  palette.refresh();
  palette.choose(name);
  compare.refresh();
  const set = (selector, text) => {
    const element = document.querySelector(selector);
    element.hidden = false;
    element.textContent = text;
  };
  const address = `https://a-rather-long-name-of-a-host.example.org/${'path'.repeat(30)}/model.haptoflow`;
  set('#message-text', `The model of the materials could not be loaded: ${address}: 404; check the address of the model.`);
  document.querySelector('#message').dataset.kind = 'error';
  const line = (feature) => Object.assign(document.createElement('li'), { textContent: `${feature}: this page may not use it: its server (Permissions-Policy) forbids it.` });
  document.querySelector('#missing').append(...['Rumble of a gamepad', 'Vibration of this phone', 'Headset'].map(line));
  set('#measure-row', `| ${navigator.userAgent} | 2 | shared | sketch 0.02 / 0.10 (1.92) | ${'x'.repeat(200)} |`);
  set('#measure-json', JSON.stringify({ userAgent: navigator.userAgent, long: 'y'.repeat(300) }, null, 2));
  set('#measure-progress', address);
  set('#learn-result', `“${name}” is in the palette: paint an object with it. ${address}`);
  set('#relief-lay', `Lay it on: ${name}`);
  set('#relief-remove', `Take it off: ${name}`);
  set('#relief-note', `“${name}.png” lies on ${name}: 60 × 45 mm, 0.4 mm deep. ${address}`);
  set('#record-note', 'A picture was laid or taken off meanwhile: before that, another relief was felt.');
  set('#learn-doing', `fitting ${name} (50 %)`);
  set('#compare-state', `B: ${name} on ${name}`);
  set('#output-note', `Gamepad: ${name} (STANDARD GAMEPAD Vendor: 045e Product: 02ea).`);
  set('#quality-note', `Loading ${name} …`);
  set('#record-time', '599.9 s recorded');
  set('#reading-name', `Sandpaper sheet · ${name}`);
  set('#reading-numbers', '1234 mm/s · 2.0 N');
  for (const cell of document.querySelectorAll('[data-runs]')) cell.textContent = '12,345,678';
  document.querySelector('[data-tier="auto"]').textContent = 'now standard';
  for (const selector of ['#message', '#missing', '#record-files', '#learn-progress', '#learn-save', '#start', '#start-button', '#measure-result', '#enter-vr']) document.querySelector(selector).hidden = false;
  set('#start-text', 'The page cannot go on.');
  for (const details of document.querySelectorAll('details')) details.open = true;
  device.posesPerSecond = 72;
}

/** How far the page is wider than its window, and what sticks out of it. */
function tooWide() {
  const width = document.documentElement.clientWidth;
  const zoom = Number(getComputedStyle(document.documentElement).zoom) || 1;
  const out = [...document.querySelectorAll('body *')].filter((element) => {
    if (!element.checkVisibility() || element.closest('.unseen, .skip')) return false;
    const { left, right, width: own } = element.getBoundingClientRect();
    return own > 0 && (right > width + 1 || left < -1);
  });
  // Text that is cut off within its own box has to be scrolled too.
  const cut = [...document.querySelectorAll('button, p, pre, td, th, output, h1, h2, h3, figcaption, li, label, span')].filter((element) => element.checkVisibility() && !element.closest('.unseen, .skip, .chip') && element.clientWidth > 0 && element.scrollWidth > element.clientWidth + 1);
  return {
    page: document.documentElement.scrollWidth - width, zoom,
    out: out.slice(0, 5).map((element) => `${element.tagName}#${element.id}.${element.className} to ${Math.round(element.getBoundingClientRect().right)} of ${width}`),
    cut: cut.slice(0, 5).map((element) => `${element.tagName}#${element.id}.${element.className} ${element.scrollWidth} in ${element.clientWidth}: ${element.textContent.slice(0, 30)}`),
  };
}

const twoFrames = () => new Promise((resolve) => { requestAnimationFrame(() => requestAnimationFrame(resolve)); });

describe('with all panels open nothing has to be scrolled aside', { skip: !hasBrowser }, () => {
  before(async () => {
    opened = await openLivePage();
    await opened.page.evaluate(openAll);
  });
  after(() => opened.close());

  /** @type {string[]} */
  let wide = [];
  async function look(/** @type {string} */ what) {
    await opened.page.evaluate(twoFrames);
    const found = await opened.page.evaluate(tooWide);
    if (found.page > 0 || found.out.length > 0 || found.cut.length > 0) wide.push(`${what}: ${JSON.stringify(found)}`);
  }
  const judge = () => {
    const found = wide.join('\n');
    wide = [];
    assert.equal(found, '');
  };

  test('at every width from 320 pixels up, and down to 80: a window of 320 at 400 %', async () => {
    const all = [80, 107, 160, 213, 240, 320, 321, 359, 360, 375, 414, 479, 480, 481, 540, 600, 639, 640, 700, 768, 820, 912, 999, 1000, 1001, 1024, 1100, 1280, 1440, 1920, 2560, 3840];
    for (const width of isLong ? all : [80, 160, 320, 360, 480, 481, 640, 999, 1000, 1280, 1920]) {
      await opened.page.setViewportSize({ width, height: 720 });
      await look(`${width} pixels`);
    }
    judge();
  });

  test('in low windows', async () => {
    for (const [width, height] of [[320, 180], [640, 200], [844, 390], [1280, 240]]) {
      await opened.page.setViewportSize({ width, height });
      await look(`${width} by ${height} pixels`);
    }
    judge();
  });

  test('at 50 to 400 % by the style, in which widths of the window do not follow', async () => {
    for (const width of [320, 640, 1280, 1920]) {
      await opened.page.setViewportSize({ width, height: 720 });
      for (const zoom of isLong ? [0.5, 0.67, 0.8, 0.9, 1.1, 1.25, 1.5, 1.75, 2, 2.5, 3, 4] : [0.5, 4]) {
        await opened.page.evaluate((factor) => { document.documentElement.style.zoom = String(factor); }, zoom);
        await look(`${width} pixels at ${100 * zoom} %`);
      }
    }
    await opened.page.evaluate(() => { document.documentElement.style.zoom = ''; });
    judge();
  });

  test('with letters of twice the size', async () => {
    for (const width of [320, 640, 1280]) {
      await opened.page.setViewportSize({ width, height: 720 });
      await opened.page.evaluate(() => { document.documentElement.style.fontSize = '32px'; });
      await look(`${width} pixels`);
    }
    await opened.page.evaluate(() => { document.documentElement.style.fontSize = ''; });
    judge();
  });
});

if (isLong) test('on a telephone of 320 pixels, whose window grows with what sticks out, nothing does', { skip: !hasBrowser }, async () => {
  const phone = await openLivePage({ viewport: { width: 320, height: 568 }, context: { isMobile: true, hasTouch: true, deviceScaleFactor: 2 } });
  try {
    await phone.page.evaluate(openAll);
    await phone.page.evaluate(twoFrames);
    const found = await phone.page.evaluate(tooWide);
    assert.deepEqual([found.page, found.out, found.cut], [0, [], []]);
    assert.equal(await phone.page.evaluate(() => innerWidth), 320);
  } finally {
    await phone.close();
  }
});
