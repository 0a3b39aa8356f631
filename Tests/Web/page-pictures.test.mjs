import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { render } from '../../Web/engine/js/offline.mjs';
import { decodePng } from '../../Web/engine/js/png.mjs';
import { isPicture, onGround } from '../../Web/page/panels/relief.mjs';
import { hasBrowser, openLivePage } from './support/browser.mjs';
import { coreWithModel, hasCommandLine, native, wavSamples } from './support/engine.mjs';
import { png } from './support/png.mjs';

// A visitor's picture is felt, seen, recorded and taken off again.

test('a picture is one by its type or its ending', () => {
  const named = (name, type = '') => isPicture({ name, type });
  assert.deepEqual([named('a.PNG'), named('a.jpeg'), named('a.webp'), named('a', 'image/gif'), named('a.csv'), named('png.txt', 'text/plain')], [true, true, true, true, false, false]);
});

test('what is transparent becomes white, or even in a normal map, and half of it half', () => {
  const pixels = () => Uint8Array.from([0, 0, 0, 0, 100, 100, 100, 255, 0, 0, 0, 51]);
  const heights = { width: 3, height: 1, data: pixels() };
  assert.equal(onGround(heights, false), true);
  assert.deepEqual([...heights.data], [255, 255, 255, 255, 100, 100, 100, 255, 204, 204, 204, 255]);
  const normals = { width: 3, height: 1, data: pixels() };
  onGround(normals, true);
  assert.deepEqual([...normals.data.subarray(0, 4)], [128, 128, 255, 255]);
  assert.equal(onGround({ width: 1, height: 1, data: Uint16Array.from([0, 0, 0, 65535]) }, false), false);
});

/** Bars along z, eight on the picture. */
const bars = png({ width: 128, height: 64, numbers: Array.from({ length: 128 * 64 }, (_, at) => ((at % 128) % 16 < 8 ? 255 : 0)) });

describe('on the live page', { skip: !hasBrowser }, () => {
  /** @type {Awaited<ReturnType<typeof openLivePage>>} */
  let opened;
  before(async () => {
    opened = await openLivePage();
  });
  after(() => opened.close());
  const inPage = (action, argument) => opened.page.evaluate(action, argument);
  const note = async () => (await opened.page.locator('#relief-note').textContent()) ?? '';
  const choose = async (buffer, name = 'bars.png', mimeType = 'image/png') => {
    await opened.page.locator('#relief-file').setInputFiles({ name, mimeType, buffer });
    await opened.page.waitForFunction(() => !/^$|^Reading/.test(document.querySelector('#relief-note').textContent), null, { timeout: 60000 });
    return note();
  };
  /** Draws over the glass plate while the strokes' heights are watched: the lowest and the highest, and the runs of the effect. */
  const overGlass = () => inPage(async () => {
    const page = globalThis.haptoflowPage;
    const runs = () => page.tips[0].voice.statistics().effects.relief.runs;
    const begun = runs();
    const [heights, names] = [[], new Set()];
    const timer = setInterval(() => {
      const { contact } = page.tips[0];
      if (!contact?.touching) return;
      names.add(contact.surfaceName);
      if (!document.querySelector('#profile').hidden) heights.push(...page.profile.heights.heightsMetres);
    }, 10);
    await page.hand.play({ name: '', words: '', from: [-0.22, 0.112], legs: [{ to: [-0.15, 0.112], seconds: 0.8 }] });
    clearInterval(timer);
    return { lowest: Math.min(...heights), highest: Math.max(...heights), runs: runs() - begun, names: [...names] };
  });
  const select = (title) => opened.page.locator('#paint-object').selectOption({ label: title });

  test('a chosen picture lies on the object that was touched last: felt, with its heights under the pen, and seen', async () => {
    const { page } = opened;
    assert.equal(await page.locator('#relief-lay').isDisabled(), true);
    await select('Glass plate');
    assert.equal(await page.locator('#relief-remove').isDisabled(), true);
    const before = await page.locator('.still').evaluate((canvas) => canvas.toDataURL());
    assert.equal(await choose(bars), '“bars.png” lies on Glass plate: 60 × 30 mm, 0.4 mm deep.');
    const found = await overGlass();
    assert.ok(found.lowest < 1e-5 && found.highest > 3.9e-4, JSON.stringify(found));
    assert.ok(found.runs > 20, JSON.stringify(found));
    assert.notEqual(await page.locator('.still').evaluate((canvas) => canvas.toDataURL()), before);
    assert.equal(await page.locator('#relief-lay').textContent(), 'Lay it on: Glass plate');
  });

  test('its middle lies in the middle of the object, and it lies as it is drawn', async () => {
    // A white quarter at the left above; the lower left one is half as high.
    const quarters = png({ width: 64, height: 64, numbers: Array.from({ length: 4096 }, (_, at) => (at % 64 >= 32 ? 0 : at < 2048 ? 255 : 128)) });
    await choose(quarters);
    const heights = await inPage(() => {
      const { tips, table } = globalThis.haptoflowPage;
      const relief = globalThis.haptoflowPage.reliefs.present.get('glass plate');
      const at = (x, z) => {
        const [column, row] = [((x / relief.sizeMetres[0]) % 1 + 1) % 1 * relief.columns, ((-z / relief.sizeMetres[1]) % 1 + 1) % 1 * relief.rows];
        return relief.heightsMetres[Math.floor(row) * relief.columns + Math.floor(column)];
      };
      return { tips: tips.length, surfaces: table.tops.length, found: [[-0.015, 0.015], [0.015, 0.015], [-0.015, -0.015], [0.015, -0.015]].map(([x, z]) => Math.round(1e6 * at(x, z))) };
    });
    assert.deepEqual(heights.found, [400, 0, 201, 0]);
  });

  test('width and depth change it, also under a tip that draws, and numbers that are none are refused', async () => {
    const { page } = opened;
    await choose(bars);
    const playing = inPage(async () => {
      const { hand, tips } = globalThis.haptoflowPage;
      const depths = new Set();
      const timer = setInterval(() => {
        if (tips[0].contact?.touching && tips[0].contact.relief) depths.add(tips[0].contact.relief.depthMetres);
      }, 10);
      await hand.play({ name: '', words: '', from: [-0.22, 0.112], legs: [{ to: [-0.15, 0.112], seconds: 3 }] });
      clearInterval(timer);
      return [...depths];
    });
    await page.locator('#relief-depth').fill('1.5');
    await page.locator('#relief-depth').blur();
    const depths = await playing;
    assert.ok(depths.includes(0.0015), `${depths}`);
    for (const [field, value, sentence] of [['depth', '', 'Depth: write a number of millimetres from 0.01 to 5.'], ['depth', '-3', 'Depth: write a number of millimetres from 0.01 to 5.'], ['width', '1e9', 'Width: write a number of millimetres from 1 to 1000.']]) {
      await page.locator(`#relief-${field}`).fill(value);
      await page.locator(`#relief-${field}`).blur();
      await page.waitForFunction((text) => document.querySelector('#relief-note').textContent === text, sentence);
      assert.equal(await page.locator(`#relief-${field}`).getAttribute('aria-invalid'), 'true');
      await page.locator(`#relief-${field}`).fill({ depth: '0.4', width: '60' }[field]);
      await page.locator(`#relief-${field}`).blur();
      await page.waitForFunction(() => document.querySelector('#relief-note').textContent.startsWith('“bars.png” lies on'));
    }
    assert.equal((await overGlass()).highest > 3.9e-4, true);
  });

  test('bad files are refused in a sentence, and what lay there stays', async () => {
    const before = await inPage(() => globalThis.haptoflowPage.reliefs.changes);
    const cases = [
      [Buffer.from('no picture'), 'letter.png', 'image/png', /^This file cannot be used: letter\.png: damaged, too large, or no picture/],
      [bars.subarray(0, 80), 'cut.png', 'image/png', /^This file cannot be used: cut\.png: damaged/],
      [Buffer.alloc(0), 'empty.jpg', 'image/jpeg', /^This file cannot be used: empty\.jpg/],
      [Buffer.from('a,b\n'), 'table.csv', 'text/csv', /^table\.csv is no picture: choose a PNG, JPEG or WebP file\.$/],
      [Buffer.from('<svg xmlns="http://www.w3.org/2000/svg"/>'), 'drawing.svg', 'image/svg+xml', /^This file cannot be used: drawing\.svg/],
    ];
    for (const [bytes, name, type, sentence] of cases) assert.match(await choose(bytes, name, type), sentence);
    assert.equal(await inPage(() => globalThis.haptoflowPage.reliefs.changes), before);
  });

  test('one pixel, transparency, normals, a JPEG file and far too many pixels', async () => {
    const { page } = opened;
    await select('Glass plate');
    assert.match(await choose(png({ width: 1, height: 1, numbers: [9] }), 'one.png'), /60 × 60 mm, 0\.4 mm deep\. All of it is equally high, so nothing is felt\.$/);
    assert.match(await choose(png({ width: 2, height: 1, colourType: 4, numbers: [0, 255, 0, 0] }), 'clear.png'), /What is transparent counts as white\.$/);
    const jpeg = await inPage(async () => {
      const canvas = new OffscreenCanvas(64, 32);
      const context = canvas.getContext('2d');
      context.fillRect(0, 0, 32, 32);
      context.fillStyle = '#fff';
      context.fillRect(32, 0, 32, 32);
      return [...new Uint8Array(await (await canvas.convertToBlob({ type: 'image/jpeg' })).arrayBuffer())];
    });
    assert.equal(await choose(Buffer.from(jpeg), 'photo.jpg', 'image/jpeg'), '“photo.jpg” lies on Glass plate: 60 × 30 mm, 0.4 mm deep.');
    const large = png({ width: 3000, height: 2000, bits: 1, numbers: Uint8Array.from({ length: 6e6 }, (_, at) => ((at % 3000) % 500 < 250 ? 1 : 0)) });
    assert.match(await choose(large, 'large.png'), /Its 3000 × 2000 pixels are more than the 3,145,728 of a relief: it was made smaller, 2172 × 1448\.$/);
    assert.ok((await overGlass()).runs > 20);
    await page.locator('#relief-kind').selectOption('normals');
    await page.waitForFunction(() => !document.querySelector('#relief-note').textContent.startsWith('Reading'), null, { timeout: 60000 });
    const slope = png({ width: 32, height: 16, colourType: 2, numbers: Array.from({ length: 512 }, (_, at) => [128 + Math.round(40 * Math.sin((2 * Math.PI * (at % 32)) / 8)), 128, 250]).flat() });
    assert.equal(await choose(slope, 'normals.png'), '“normals.png” lies on Glass plate: 60 × 30 mm, 0.4 mm deep.');
    assert.ok((await overGlass()).highest > 3.9e-4);
    await page.locator('#relief-kind').selectOption('heights');
    await page.waitForFunction(() => !document.querySelector('#relief-note').textContent.startsWith('Reading'), null, { timeout: 60000 });
  });

  test('a recording carries the picture: its files give the command line what was rendered here', async () => {
    const { page } = opened;
    await choose(bars);
    await page.locator('#record').click();
    await overGlass();
    await page.locator('#record').click();
    assert.equal(await page.locator('#record-note').textContent(), '');
    const files = {};
    page.on('download', async (file) => {
      files[file.suggestedFilename()] = await file.path();
    });
    for (const id of ['download-wav', 'download-csv', 'download-scene', 'download-reliefs']) await page.locator(`#${id}`).click();
    for (let time = 0; time < 100 && Object.keys(files).length < 7; time += 1) await page.waitForTimeout(50);
    assert.deepEqual(Object.keys(files).sort(), ['felt.wav', 'relief-desk.png', 'relief-glass-plate.png', 'relief-mosaic-1.png', 'relief-paper-sheet.png', 'scene.json', 'stroke.csv']);
    const { scene, stroke, level } = await inPage(async () => {
      const { record, haptics } = globalThis.haptoflowPage;
      const { scene: recorded, strokes, reliefs } = record.last;
      const { samples } = await haptics.render({ scene: recorded, stroke: strokes[0], reliefs, quality: 'sketch', effects: { texture: true, impact: true, edge: true } });
      return { scene: recorded, stroke: strokes[0], level: Math.max(...samples.map(Math.abs)) };
    });
    const relief = scene.surfaces.find(({ name }) => name === 'glass plate').relief;
    assert.deepEqual(relief, { image: 'relief-glass-plate.png', size: [0.06, 0.03], depth: 0.0004, share: 0.1 });
    const images = {};
    for (const [name, file] of Object.entries(files)) if (name.endsWith('.png')) images[name] = await decodePng(readFileSync(file));
    const web = render(await coreWithModel(), { scene, stroke, quality: 'sketch', images, effects: { texture: true, impact: true, edge: true } });
    const peak = web.samples.reduce((most, each) => Math.max(most, Math.abs(each)), 0);
    assert.ok(Math.abs(peak - level) < 1e-3 * peak && peak > 0.01, `${peak} and ${level}`);
    if (!hasCommandLine) return;
    const expected = native((folder) => {
      for (const [name, file] of Object.entries(files)) writeFileSync(path.join(folder, name), readFileSync(file));
      return ['render', path.join(folder, 'scene.json'), '--stroke', path.join(folder, 'stroke.csv'), '-o', path.join(folder, 'out.wav'), '--quiet', '--quality', 'sketch', '--effects', 'texture,impact,edge'];
    }, (folder) => wavSamples(path.join(folder, 'out.wav')));
    const largest = expected.reduce((most, each, index) => Math.max(most, Math.abs(each - web.samples[index])), 0);
    assert.ok(largest < 1e-5 * peak, `${largest} of ${peak}`);
    const live = wavSamples(files['felt.wav']);
    const loudest = live.reduce((most, each) => Math.max(most, Math.abs(each)), 0);
    assert.ok(loudest > 0.5 * peak && loudest < 2 * peak, `${loudest} live, ${peak} rendered`);
  });

  test('with the effect off a recording has no relief, and a picture that is exchanged while it runs is noted', async () => {
    const { page } = opened;
    await page.locator('#effect-relief').uncheck();
    assert.match(await choose(bars), /Relief is switched off, under Effects\.$/);
    await page.locator('#record').click();
    await choose(bars, 'again.png');
    await page.locator('#record').click();
    const last = await inPage(() => ({ files: globalThis.haptoflowPage.record.last.files.size, hasRelief: globalThis.haptoflowPage.record.last.scene.surfaces.some(({ relief }) => relief) }));
    assert.deepEqual(last, { files: 0, hasRelief: false });
    assert.match(await page.locator('#record-note').textContent() ?? '', /^A picture was laid or taken off meanwhile/);
    await page.locator('#effect-relief').check();
  });

  test('a picture is dropped on an object of the table, which its own relief has again when it is taken off, by keys', async () => {
    const { page } = opened;
    const own = await inPage(() => globalThis.haptoflowPage.reliefs.present.get('paper sheet').columns);
    const [[clientX, clientY]] = await opened.pointsOf([[0.06, -0.112]]);
    await inPage(({ base64, x, y }) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], 'bars.png', { type: 'image/png' }));
      document.querySelector('#table').dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true, clientX: x, clientY: y }));
    }, { base64: bars.toString('base64'), x: clientX, y: clientY });
    await page.waitForFunction(() => document.querySelector('#relief-note').textContent.startsWith('“bars.png” lies on Paper'));
    assert.equal(await inPage(() => globalThis.haptoflowPage.reliefs.present.get('paper sheet').columns), 128);
    await page.locator('#relief-remove').focus();
    await page.keyboard.press('Enter');
    await page.waitForFunction(() => document.querySelector('#relief-note').textContent === 'The picture is off Paper.');
    assert.equal(await inPage(() => globalThis.haptoflowPage.reliefs.present.get('paper sheet').columns), own);
    assert.equal(await page.evaluate(() => document.activeElement?.id), 'relief-lay');
    assert.equal(await page.locator('#relief-remove').isDisabled(), true);
    await select('Glass plate');
    await page.locator('#relief-remove').click();
    assert.equal((await overGlass()).runs, 0);
  });

  test('a round object is refused, and many wishes at once end with the newest', async () => {
    const { page } = opened;
    const round = await inPage(() => globalThis.haptoflowPage.table.tops.findIndex(({ kind }) => kind !== 'box'));
    await page.locator('#paint-object').selectOption(String(round));
    assert.match(await choose(bars), / is round, and a picture lies on flat objects: touch another one\.$/);
    await select('Glass plate');
    const width = await inPage(async () => {
      const { relief, reliefs } = globalThis.haptoflowPage;
      const field = document.querySelector('#relief-width');
      const laid = [];
      for (const millimetres of ['20', '30', '40', '50']) {
        field.value = millimetres;
        laid.push(relief.lay(globalThis.haptoflowPage.view.selected));
      }
      await Promise.all(laid);
      const found = reliefs.present.get('glass plate').sizeMetres[0];
      // Taken off while it is laid.
      const again = relief.lay(globalThis.haptoflowPage.view.selected);
      const off = relief.remove(globalThis.haptoflowPage.view.selected);
      await Promise.all([again, off]);
      return [found, reliefs.hasPicture('glass plate')];
    });
    assert.deepEqual(width, [0.05, false]);
  });

  test('nothing was complained of', () => assert.deepEqual(opened.complaints, []));
});
