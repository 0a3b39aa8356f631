import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import { after, before, describe, test } from 'node:test';
import { clipFormats, readClip } from '../../Web/engine/js/clip.mjs';
import { clipSentence, isClip } from '../../Web/page/panels/clip.mjs';
import { hasBrowser, openLivePage } from './support/browser.mjs';
import { pageCore } from './support/engine.mjs';

// Clips on the live page: a recording is downloaded as clips, and a clip of another tool plays beside the texture.

const core = pageCore();
const haptic = (points) => JSON.stringify({ version: { major: 1, minor: 0, patch: 0 }, metadata: { project: 'a knock', editor: 'somebody' }, signals: { continuous: { envelopes: { amplitude: points.map(([time, amplitude]) => ({ time, amplitude })) } } } });

test('a clip is one by its ending', () => {
  assert.deepEqual(['a.haptic', 'A.AHAP', 'b.hjif', 'haptic', 'a.haptoflow', 'a.json'].map((name) => isClip({ name })), [true, true, true, false, false, false]);
});

test('a clip is told in a sentence, with what it leaves out', () => {
  const clip = readClip(core, haptic([[0, 0.5], [2, 0.5]]));
  assert.equal(clipSentence('x.haptic', clip), '“x.haptic” (a knock, by somebody): 2.0 s, 2 points of amplitude, no frequency, so 160 Hz, 0 transients.');
  assert.match(clipSentence('x.ahap', { ...clip, omitted: '2 audio events', frequencyPoints: 3 }), /3 of frequency, .* Left out: 2 audio events\.$/);
});

describe('clips on the live page', { skip: !hasBrowser }, () => {
  /** @type {Awaited<ReturnType<typeof openLivePage>>} */
  let opened;
  before(async () => {
    opened = await openLivePage();
  });
  after(() => opened.close());
  const inPage = (action, argument) => opened.page.evaluate(action, argument);
  const note = (/** @type {RegExp} */ wanted) => opened.page.waitForFunction((source) => new RegExp(source).test(document.querySelector('#clip-note').textContent), wanted.source, { timeout: 20000 });
  const choose = (/** @type {string} */ name, /** @type {string} */ text) => opened.page.locator('#clip-file').setInputFiles({ name, mimeType: 'application/json', buffer: Buffer.from(text) });
  const isLoud = (/** @type {number} */ least) => opened.page.waitForFunction((wanted) => globalThis.haptoflowPage.scope.rmsMps2 > wanted, least, { timeout: 10000 });
  const isQuiet = () => opened.page.waitForFunction(() => globalThis.haptoflowPage.scope.rmsMps2 === 0, null, { timeout: 10000 });

  test('a recording is downloaded in the three formats, with the materials that were touched', async () => {
    const { page } = opened;
    await page.locator('#record').click();
    await inPage(() => globalThis.haptoflowPage.hand.play({ name: '', words: '', from: [-0.22, -0.112], legs: [{ to: [-0.15, -0.112], seconds: 0.5 }, { to: [-0.22, -0.112], seconds: 0.5 }] }));
    await isQuiet();
    await page.locator('#record').click();
    for (const format of clipFormats) {
      const [file] = await Promise.all([page.waitForEvent('download'), page.locator(`#download-${format}`).click()]);
      assert.equal(file.suggestedFilename(), `felt.${format}`);
      const text = readFileSync(await file.path(), 'utf8');
      const clip = readClip(core, text);
      assert.equal(clip.format, format);
      assert.match(text, /sandpaper/);
      assert.match(text, /recorded on the live page of HaptoFlow/);
      assert.ok(clip.largestAmplitude > 0.01 && clip.seconds > 0.9, JSON.stringify([clip.largestAmplitude, clip.seconds]));
    }
    assert.equal(readClip(core, await inPage(async () => (await globalThis.haptoflowPage.haptics.createClip({ samples: new Float32Array(4800), rateHz: 48000, title: 'nothing' })).text)).largestAmplitude, 0);
  });

  test('a recording that holds nothing says so', async () => {
    await inPage(() => {
      const { record } = globalThis.haptoflowPage;
      const { last } = record;
      Object.assign(last, { samples: new Float32Array(0) });
      document.querySelector('#record').click();
      document.querySelector('#record').click();
      Object.assign(record.last, { samples: new Float32Array(0) });
      document.querySelector('#download-haptic').click();
    });
    await opened.page.waitForFunction(() => /a clip of no samples/.test(document.querySelector('#record-note').textContent));
  });

  test('a chosen clip is drawn and told, plays beside the texture by the keyboard, and stops', async () => {
    const { page } = opened;
    await choose('knock.haptic', haptic([[0, 0.6], [0.5, 0.6]]));
    await note(/^“knock\.haptic” \(a knock, by somebody\): 0\.5 s/);
    assert.match(await page.locator('#clip-amplitude').getAttribute('aria-label'), /0\.5 seconds, 60 % of the range at most, with 0 transients/);
    assert.match(await page.locator('#clip-frequency').getAttribute('aria-label'), /left to the device/);
    const drawn = () => inPage(() => ['#clip-amplitude', '#clip-frequency'].map((id) => {
      const canvas = document.querySelector(id);
      return canvas.getContext('2d').getImageData(0, 0, canvas.width, canvas.height).data.some((value) => value > 0);
    }));
    await page.waitForTimeout(100);
    assert.deepEqual(await drawn(), [true, true]);
    await page.locator('#clip-loop').check();
    await page.locator('#clip-play').press('Enter');
    await isLoud(1);
    assert.equal(await page.locator('#clip-play').textContent(), 'Stop');
    const beside = await inPage(async () => {
      const { hand, tips } = globalThis.haptoflowPage;
      const before = tips[0].voice.statistics().effects;
      await hand.play({ name: '', words: '', from: [-0.22, -0.112], legs: [{ to: [-0.15, -0.112], seconds: 0.7 }] });
      const { texture, clip } = tips[0].voice.statistics().effects;
      return { texture: texture.runs - before.texture.runs, clip: clip.runs - before.clip.runs };
    });
    assert.ok(beside.texture > 5 && beside.clip > 50, JSON.stringify(beside));
    await isLoud(1);
    await page.locator('#clip-play').press(' ');
    await isQuiet();
    assert.equal(await page.locator('#clip-play').textContent(), 'Play');
  });

  test('without the loop it ends by itself, and the button says so', async () => {
    const { page } = opened;
    await page.locator('#clip-loop').uncheck();
    await page.locator('#clip-play').click();
    await page.waitForFunction(() => document.querySelector('#clip-play').textContent === 'Play', null, { timeout: 10000 });
    await isQuiet();
  });

  test('a dropped clip replaces the one that plays, and refused files get the library\'s sentence and change nothing', async () => {
    const { page } = opened;
    const drop = (/** @type {string} */ name, /** @type {string} */ text) => inPage(([called, content]) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([content], called));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
    }, [name, text]);
    await page.locator('#clip-loop').check();
    await page.locator('#clip-play').click();
    await isLoud(1);
    await drop('soft.haptic', haptic([[0, 0.1], [0.5, 0.1]]));
    await note(/soft\.haptic/);
    await page.waitForFunction(() => globalThis.haptoflowPage.scope.rmsMps2 > 0 && globalThis.haptoflowPage.scope.rmsMps2 < 0.5, null, { timeout: 10000 });
    for (const [name, text, words] of /** @type {const} */ ([
      ['broken.haptic', haptic([[0, 0.5]]).slice(0, -9), /^broken\.haptic: .*the clip/],
      ['other.ahap', '{"no": "clip"}', /^other\.ahap: .*"signals".*"Pattern".*"perceptions"/],
      ['empty.hjif', '', /^empty\.hjif: .*the clip/],
      ['large.hjif', ' '.repeat(2 ** 24 + 100), /^large\.hjif: .*larger than 16 MiB/],
    ])) {
      await drop(name, text);
      await note(words);
    }
    assert.equal(await page.locator('#clip-play').textContent(), 'Stop');
    // The page stood still for the largest of them, and the loop is played anew.
    await isLoud(0.01);
  });

  test('a mute ends it, and the page says why', async () => {
    await inPage(() => {
      globalThis.haptoflowPage.tips[0].voice.muted = true;
    });
    await note(/^The clip has ended: the sound is muted\.$/);
    await inPage(() => {
      globalThis.haptoflowPage.tips[0].voice.muted = false;
    });
    await opened.page.waitForTimeout(300);
    await isQuiet();
    await opened.page.locator('#clip-play').click();
    await isLoud(0.01);
  });

  test('a lost worker ends it, and it plays again', async () => {
    await inPage(() => globalThis.haptoflowPage.haptics[Symbol.for('haptoflow.worker')].terminate());
    await opened.page.waitForFunction(() => /started again/.test(document.querySelector('#message-text').textContent), null, { timeout: 20000 });
    assert.equal(await opened.page.locator('#clip-play').textContent(), 'Play');
    await opened.page.locator('#clip-play').click();
    await isLoud(0.01);
    await opened.page.locator('#clip-play').click();
    await isQuiet();
    assert.deepEqual(opened.complaints, []);
  });
});
