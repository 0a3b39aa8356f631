import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { gzipSync } from 'node:zlib';
import { pageFolder } from '../../scripts/lib/web_build.mjs';
import { hasBrowser, isLong, openLivePage, watch } from './support/browser.mjs';
import { hasCommandLine, native, repository, wavSamples } from './support/engine.mjs';

const documentation = readFileSync(path.join(repository, 'Documentation~', 'in-the-browser.md'), 'utf8');
/** @type {Awaited<ReturnType<typeof openLivePage>>} */
let opened;
const pause = (/** @type {number} */ milliseconds) => opened.page.waitForTimeout(milliseconds);
const inPage = (action, argument) => opened.page.evaluate(action, argument);
const text = (/** @type {string} */ selector) => opened.page.locator(selector).innerText();

/** Presses the mouse and draws through places of the table. */
async function draw(/** @type {[number, number][]} */ places) {
  const { mouse } = opened.page;
  const way = places.flatMap((from, leg) => {
    const to = places[leg + 1] ?? from;
    const steps = Math.max(1, Math.ceil(Math.hypot(to[0] - from[0], to[1] - from[1]) / 0.004));
    return Array.from({ length: steps }, (_, step) => /** @type {[number, number]} */ ([from[0] + ((to[0] - from[0]) * step) / steps, from[1] + ((to[1] - from[1]) * step) / steps]));
  });
  const [first, ...others] = await opened.pointsOf(way);
  await mouse.move(first[0], first[1]);
  await mouse.down();
  for (const [x, y] of others) {
    await mouse.move(x, y);
    await pause(10);
  }
}
const rub = /** @type {(x: number, z: number) => [number, number][]} */ ((x, z) => [[x - 0.03, z], [x + 0.03, z], [x - 0.03, z], [x + 0.03, z]]);
const loudest = (seen, surface) => Math.max(0, ...seen.filter((each) => each.surface === surface).map(({ rms }) => rms));
const isQuiet = () => opened.page.waitForFunction(() => globalThis.haptoflowPage.scope.rmsMps2 === 0, null, { timeout: 20000 });

describe('the live page', { skip: !hasBrowser }, () => {
  before(async () => {
    opened = await openLivePage();
  });
  after(() => opened.close());

  test('opening loads at most 8 MB compressed, which is what the documentation says, and nothing of the headset', () => {
    const files = [...opened.loaded].map((name) => readFileSync(path.join(pageFolder(), ...name.split('/'))));
    const megabytes = (/** @type {Buffer[]} */ all) => all.reduce((sum, bytes) => sum + bytes.length, 0) / 1e6;
    const gzipped = megabytes(files.map((bytes) => gzipSync(bytes)));
    assert.ok(gzipped < 8, `${gzipped} MB`);
    assert.ok(![...opened.loaded].some((name) => /^(xr|three)\//.test(name)));
    const said = documentation.match(/^Opening the page loads some (\d+) files, ([\d.]+) MB; with gzip ([\d.]+) MB/m)?.slice(1).map(Number) ?? [];
    [files.length, megabytes(files), gzipped].forEach((figure, index) => assert.ok(Math.abs(figure - said[index]) < 0.05 * figure, `${figure}, and the documentation says ${said[index]}`));
  });

  test('a stroke of the mouse over two objects sounds on each, and is silent after lift-off', async () => {
    const stop = await watch(opened.page);
    await draw([[-0.22, -0.112], [-0.15, -0.112], [-0.09, -0.112], [-0.03, -0.112]]);
    await opened.page.mouse.up();
    await isQuiet();
    const seen = await stop();
    assert.ok(loudest(seen, 'sandpaper sheet') > 0.1, `${loudest(seen, 'sandpaper sheet')}`);
    assert.ok(loudest(seen, 'jute mat') > 0.1, `${loudest(seen, 'jute mat')}`);
    assert.equal(await inPage(() => globalThis.haptoflowPage.tips[0].isDown), false);
  });

  test('the mouse held still presses harder, up to two newtons', async () => {
    await draw([[0.185, 0], [0.19, 0]]);
    await pause(1600);
    const force = await inPage(() => globalThis.haptoflowPage.tips[0].place.forceNewtons);
    await opened.page.mouse.up();
    assert.ok(force > 1.9 && force <= 2, `${force}`);
  });

  test('arrow keys draw, and the tip lifts when they are released', async () => {
    const stop = await watch(opened.page);
    await opened.page.locator('#table').focus();
    await opened.page.keyboard.down('ArrowRight');
    await pause(900);
    await opened.page.keyboard.up('ArrowRight');
    await isQuiet();
    const seen = await stop();
    assert.ok(loudest(seen, 'desk') > 0.05);
    assert.ok(Math.max(...seen.map(({ speed }) => speed)) > 0.08);
    assert.equal(seen.at(-1).surface, '');
  });

  test('a preset stroke plays from the keyboard, and stops by Escape', async () => {
    const stop = await watch(opened.page);
    await opened.page.getByRole('button', { name: 'Across the table' }).press('Enter');
    await pause(1500);
    await opened.page.locator('#table').press('Escape');
    await isQuiet();
    const seen = await stop();
    assert.ok(loudest(seen, 'desk') > 0.05, `${loudest(seen, 'desk')}`);
    assert.equal(await inPage(() => globalThis.haptoflowPage.hand.isPlaying), false);
  });

  test('two fingers are two voices', async () => {
    const devtools = await opened.page.context().newCDPSession(opened.page);
    const touch = async (/** @type {string} */ type, /** @type {[number, number][]} */ places) => {
      const points = await opened.pointsOf(places);
      await devtools.send('Input.dispatchTouchEvent', { type: /** @type {any} */ (type), touchPoints: points.map(([x, y], id) => ({ x, y, id })) });
    };
    const stop = await watch(opened.page);
    await touch('touchStart', [[-0.2, 0.112], [0.16, -0.112]]);
    for (let step = 1; step < 50; step += 1) {
      await touch('touchMove', [[-0.2 + 0.0008 * step, 0.112], [0.16 + 0.0008 * step, -0.112]]);
      await pause(10);
    }
    await touch('touchEnd', []);
    await isQuiet();
    const seen = await stop();
    const sounding = (tip, surface) => Math.max(0, ...seen.filter((each) => each.tip === tip && each.surface === surface).map(({ rms }) => rms));
    assert.ok(sounding(0, 'glass plate') > 0.01, `${sounding(0, 'glass plate')}`);
    assert.ok(sounding(1, 'carpet square') > 0.01, `${sounding(1, 'carpet square')}`);
  });

  test('a pen presses by its pressure, and its tilt is recorded', async () => {
    const devtools = await opened.page.context().newCDPSession(opened.page);
    const pen = async (/** @type {string} */ type, /** @type {number} */ force, /** @type {number} */ x) => {
      const [[left, top]] = await opened.pointsOf([[x, 0.112]]);
      await devtools.send('Input.dispatchMouseEvent', { type: /** @type {any} */ (type), x: left, y: top, button: 'left', buttons: type === 'mouseReleased' ? 0 : 1, clickCount: 1, pointerType: 'pen', force, tiltX: 30 });
    };
    await inPage(() => {
      globalThis.haptoflowPage.tips[0].rows = [];
    });
    await pen('mousePressed', 0.2, -0.2);
    const forces = [];
    for (const pressure of [0.25, 0.5, 1]) {
      await pen('mouseMoved', pressure, -0.2 + 0.02 * pressure);
      await pause(40);
      forces.push(await inPage(() => globalThis.haptoflowPage.tips[0].contact.forceNewtons));
    }
    await pen('mouseReleased', 0, -0.18);
    const leans = await inPage(() => {
      const [tip] = globalThis.haptoflowPage.tips;
      const { rows } = tip;
      tip.rows = null;
      return rows.map(({ orientation }) => orientation && orientation[3] < 0.99);
    });
    assert.deepEqual(forces.map((force) => Math.round(100 * force) / 100), [0.5, 1, 2]);
    assert.ok(leans.length > 3 && leans.every(Boolean), `${leans}`);
  });

  test('a recording renders to the labels that were heard, here and at the command line', async () => {
    await inPage(() => {
      globalThis.heard = [];
      const { tips } = globalThis.haptoflowPage;
      globalThis.timer = setInterval(() => tips[0].contact?.touching && globalThis.heard.push(tips[0].contact.surfaceName), 5);
    });
    await opened.page.locator('#speed').fill('2');
    await opened.page.locator('#record').click();
    await opened.page.getByRole('button', { name: 'Along the front' }).click();
    await opened.page.waitForFunction(() => globalThis.haptoflowPage.hand.isPlaying);
    await opened.page.waitForFunction(() => !globalThis.haptoflowPage.hand.isPlaying, null, { timeout: 15000 });
    await opened.page.locator('#speed').fill('1');
    await isQuiet();
    await opened.page.locator('#record').click();
    const downloads = [];
    for (const id of ['download-wav', 'download-csv', 'download-scene']) {
      const [file] = await Promise.all([opened.page.waitForEvent('download'), opened.page.locator(`#${id}`).click()]);
      downloads.push({ name: file.suggestedFilename(), file: await file.path() });
    }
    assert.deepEqual(downloads.map(({ name }) => name), ['felt.wav', 'stroke.csv', 'scene.json']);
    const live = wavSamples(downloads[0].file);
    assert.ok(live.some((sample) => Math.abs(sample) > 1e-4));
    const found = await inPage(async () => {
      clearInterval(globalThis.timer);
      const { record, haptics } = globalThis.haptoflowPage;
      const { strokes, scene, reliefs } = record.last;
      const render = await haptics.render({ scene, reliefs, stroke: strokes[0], effects: { texture: true, impact: true, edge: true } });
      return { heard: [...new Set(globalThis.heard)], stroke: strokes[0], scene, strokes: strokes.length, seconds: render.seconds, touches: render.touches, level: Math.hypot(...[...render.samples].filter((_, index) => index % 16 === 0)) };
    });
    assert.equal(found.strokes, 1);
    assert.ok(found.touches >= 1);
    assert.ok(found.level > 0.01);
    for (const surface of ['desk', 'sandpaper sheet', 'jute mat', 'paper sheet', 'carpet square']) assert.ok(found.heard.includes(surface), `${surface}: ${found.heard}`);
    if (!hasCommandLine) return;
    const rendered = native((folder) => {
      const [scene, stroke] = ['scene.json', 'stroke.csv'].map((name) => path.join(folder, name));
      writeFileSync(scene, JSON.stringify(found.scene));
      writeFileSync(stroke, found.stroke);
      return ['contact', scene, '--stroke', stroke];
    }, (_, output) => output);
    const named = new Set(rendered.trim().split('\n').slice(1).map((line) => line.split(',')).filter((cells) => cells[2] === '1').map((cells) => cells[1]));
    assert.deepEqual([...named].sort(), [...found.heard].sort());
  });

  test('an object is painted with a label and with a blend, and sounds so', async () => {
    const { page } = opened;
    await page.locator('#labels input[value="sandpaper"]').check();
    await page.locator('#paint-object').selectOption({ label: 'Glass plate' });
    await page.getByRole('button', { name: 'Paint it' }).click();
    await draw(rub(-0.185, 0.112));
    assert.equal(await inPage(() => globalThis.haptoflowPage.tips[0].contact.material), 'sandpaper');
    assert.match(await text('#reading-name'), /Glass plate · sandpaper/);
    await page.mouse.up();
    await page.locator('#blend-label').selectOption('wood');
    await page.locator('#blend-share').fill('25');
    await page.getByRole('button', { name: 'Paint it' }).click();
    assert.deepEqual(await inPage(() => globalThis.haptoflowPage.table.materials[1]), { sandpaper: 0.75, wood: 0.25 });
    await page.getByRole('button', { name: 'Restore all' }).click();
    assert.equal(await inPage(() => globalThis.haptoflowPage.table.materials[1]), 'glass');
    await page.locator('#blend-label').selectOption('');
  });

  test('A and B change the chosen object by one key, and the quality', async () => {
    const { page } = opened;
    await page.locator('#paint-object').selectOption({ label: 'Paper' });
    await page.locator('#table').press('x');
    assert.match(await text('#compare-state'), /B: sandpaper on Paper/);
    await page.locator('#table').press('x');
    assert.match(await text('#compare-state'), /A: stone on Paper/);
    await page.locator('#compare-kind').selectOption('qualities');
    await page.getByRole('button', { name: 'Switch to B' }).click();
    await page.waitForFunction(() => globalThis.haptoflowPage.haptics.quality === 'standard');
    await page.getByRole('button', { name: 'Switch to A' }).click();
    await page.waitForFunction(() => globalThis.haptoflowPage.haptics.quality === 'sketch');
    await page.locator('#quality-standard').check();
    await page.getByRole('button', { name: 'Restore all' }).click();
  });

  test('qualities show accuracy of the model and milliseconds of now; an effect that is off does not run', async () => {
    const { page } = opened;
    await page.locator('#effect-impact').uncheck();
    await page.waitForTimeout(300);
    const before = await text('[data-runs="impact"]');
    await draw(rub(0.185, 0));
    await page.mouse.up();
    await page.waitForTimeout(500);
    assert.equal(await text('[data-runs="impact"]'), before);
    assert.ok(Number(await text('[data-tier="standard"]')) > 0);
    const expected = await inPage(() => globalThis.haptoflowPage.haptics.model.tiers.map(({ accuracy }) => accuracy.lsd_db.toFixed(2)));
    const shown = await page.locator('#qualities tr td:nth-child(2)').allInnerTexts();
    assert.deepEqual(shown.slice(0, expected.length), expected);
    await page.locator('#effect-impact').check();
  });

  test('a phone\'s motor and a gamepad\'s follow the stroke, and rest after it', async () => {
    const found = await inPage(async () => {
      const rumbles = [];
      const vibrations = [];
      const gamepad = { id: 'made', vibrationActuator: { playEffect: async (_, { weakMagnitude }) => rumbles.push(weakMagnitude) } };
      Object.defineProperty(navigator, 'getGamepads', { configurable: true, value: () => [null, gamepad] });
      Object.defineProperty(navigator, 'vibrate', { configurable: true, value: (milliseconds) => vibrations.push(milliseconds) });
      for (const id of ['output-vibration', 'output-rumble']) document.getElementById(id).click();
      const { hand } = globalThis.haptoflowPage;
      await hand.play({ name: '', words: '', from: [-0.22, -0.112], legs: [{ to: [-0.15, -0.112], seconds: 0.7 }, { to: [-0.22, -0.112], seconds: 0.7 }] });
      await new Promise((resolve) => { setTimeout(resolve, 500); });
      const counts = [rumbles.length, vibrations.length];
      await new Promise((resolve) => { setTimeout(resolve, 300); });
      const result = { rumbles: [...rumbles], vibrations: [...vibrations], counts, later: [rumbles.length, vibrations.length] };
      for (const id of ['output-vibration', 'output-rumble']) document.getElementById(id).click();
      return result;
    });
    assert.ok(found.rumbles.length > 5 && Math.max(...found.rumbles) > 0.1, `${found.rumbles}`);
    assert.ok(found.rumbles.every((share) => share >= 0 && share <= 1));
    assert.equal(found.rumbles.at(-1), 0);
    assert.ok(found.vibrations.length > 3 && found.vibrations.every((milliseconds) => milliseconds > 0 && milliseconds <= 50), `${found.vibrations}`);
    assert.deepEqual(found.counts, found.later);
  });

  test('quality "auto" names the tier that it takes', async () => {
    const { page } = opened;
    await page.locator('#quality-auto').check();
    await page.waitForFunction(() => /^now (sketch|draft|standard)$/.test(document.querySelector('[data-tier="auto"]').textContent), null, { timeout: 20000 });
    assert.equal(await inPage(() => globalThis.haptoflowPage.haptics.quality), 'auto');
    await page.locator('#quality-standard').check();
    await page.waitForFunction(() => document.querySelector('[data-tier="auto"]').textContent === '');
  });

  if (isLong) test('"Measure this device" makes a row with every quality, and the same as JSON', async () => {
    const { page } = opened;
    await page.locator('#measure').click();
    await page.waitForFunction(() => !document.querySelector('#measure').disabled, null, { timeout: 90000 });
    assert.match(await text('#measure-progress'), /^Done\./);
    const header = documentation.match(/^\| browser \| cores \|.*$/m)[0];
    const columns = (/** @type {string} */ row) => row.split('|').length;
    const row = await text('#measure-row');
    assert.equal(columns(row), columns(header), row);
    assert.match(row, /sketch [\d.]+ \/ [\d.]+ \([\d.]+\), draft .*, standard /);
    const report = JSON.parse(await page.locator('#measure-json').textContent());
    assert.deepEqual(report.tiers.map(({ tier }) => tier), ['sketch', 'draft', 'standard']);
    assert.ok(report.touchToSampleMs.count >= 30 && report.touchToSampleMs.median > 0, JSON.stringify(report.touchToSampleMs));
    assert.ok(report.eventToPublishMs.count > 0);
    assert.equal(report.sharing, 'shared');
  });

  if (isLong) test('a lost worker is told in words, and the page sounds again', async () => {
    await inPage(() => globalThis.haptoflowPage.haptics[Symbol.for('haptoflow.worker')].terminate());
    await opened.page.waitForFunction(() => /started again/.test(document.querySelector('#message-text').textContent), null, { timeout: 20000 });
    await inPage(() => {
      const { haptics } = globalThis.haptoflowPage;
      const heard = new AnalyserNode(haptics.context, { fftSize: 4096 });
      haptics.output.connect(heard);
      globalThis.loudestHeard = 0;
      const wave = new Float32Array(4096);
      setInterval(() => {
        heard.getFloatTimeDomainData(wave);
        globalThis.loudestHeard = Math.max(globalThis.loudestHeard, ...wave.map(Math.abs));
      }, 30);
    });
    await draw(rub(-0.185, -0.112));
    await opened.page.mouse.up();
    assert.ok(await inPage(() => globalThis.loudestHeard) > 1e-3);
  });

  test('sound that waits for a gesture says so, and a tap starts it', async () => {
    // As a browser does before a gesture, or when it takes the device away.
    await inPage(() => globalThis.haptoflowPage.haptics.context.suspend());
    await opened.page.getByRole('button', { name: 'Tap to start' }).click();
    await opened.page.waitForFunction(() => document.querySelector('#start').hidden);
  });

  test('every control has a name', async () => {
    const nameless = await inPage(() => [...document.querySelectorAll('button, input, select, canvas:not([aria-hidden]), meter, progress')].filter((element) => {
      const labels = /** @type {any} */ (element).labels;
      return !(element.getAttribute('aria-label') || element.textContent.trim() || [...(labels ?? [])].some((label) => label.textContent.trim()));
    }).map((element) => element.outerHTML.slice(0, 80)));
    assert.deepEqual(nameless, []);
  });

  test('an engine that cannot go on is told, with a way to try again', async () => {
    await inPage(() => globalThis.haptoflowPage.haptics.dispatchEvent(new CustomEvent('error', { detail: { error: { code: 'worker-lost', message: 'it failed 3 times within a minute and stays silent: reload the page' }, isFatal: true } })));
    assert.match(await text('#message-text'), /^The engine stopped: it failed 3 times/);
    assert.ok(await opened.page.getByRole('button', { name: 'Try again' }).isVisible());
  });

  test('nothing was asked of another origin, nothing was complained of, and nothing is missing', async () => {
    assert.equal(await opened.page.locator('#missing').isHidden(), true, await opened.page.locator('#missing').textContent());
    assert.deepEqual(opened.strangers, []);
    assert.deepEqual(opened.complaints, []);
  });
});

test('without the headers it says that it uses a ring, and sounds; 360 pixels need no scrolling aside; dark is dark; less motion stops the grille', { skip: !hasBrowser }, async () => {
  opened = await openLivePage({ isolated: false, viewport: { width: 360, height: 720 }, colorScheme: 'dark', reducedMotion: 'reduce' });
  try {
    assert.match(await opened.page.locator('#device-line').textContent(), /ring that adds \d+ ms/);
    const stop = await watch(opened.page);
    await draw(rub(-0.185, -0.112));
    await opened.page.mouse.up();
    assert.ok(loudest(await stop(), 'sandpaper sheet') > 0.1);
    assert.ok(await inPage(() => document.documentElement.scrollWidth <= innerWidth));
    const ground = await inPage(() => getComputedStyle(document.body).backgroundColor.match(/\d+/g).map(Number));
    assert.ok(Math.max(...ground) < 60, `${ground}`);
    assert.equal(await inPage(() => globalThis.haptoflowPage.table.tops.some(({ isMoving }) => isMoving)), false);
  } finally {
    await opened.close();
  }
});
