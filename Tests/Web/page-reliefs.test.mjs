import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { heightAt, reliefOf, reliefsOf } from '../../Web/page/table/reliefs.mjs';
import { hasBrowser, openLivePage } from './support/browser.mjs';
import { repository } from './support/engine.mjs';

// What is seen on the table, what its profile shows and what is felt are the same heights.

const jsonOf = (/** @type {string} */ name) => JSON.parse(readFileSync(path.join(repository, 'Web', 'page', 'table', name), 'utf8'));
const workbench = jsonOf('workbench.json');
const looks = jsonOf('looks.json');
const reliefs = reliefsOf(workbench, looks);
const every = 0.06;
const gaps = [-0.12, -0.06, 0, 0.06, 0.12];
/** Beside all objects. */
const freeX = -0.12;

/** Height at a place of a surface, from its middle. */
const heightOn = (/** @type {string} */ name, /** @type {number} */ x, /** @type {number} */ z) => {
  const relief = reliefs.get(name);
  return heightAt(relief, x / relief.sizeMetres[0], -z / relief.sizeMetres[1]);
};
const near = (value, expected, tolerance) => assert.ok(Math.abs(value - expected) <= tolerance, `${value}, expected ${expected}`);

test('the desk has a gap every 60 mm, the mosaic grout at its rims and between its tiles, the paper a raised word', () => {
  assert.deepEqual([...reliefs.keys()], ['desk', 'mosaic 1', 'mosaic 2', 'mosaic 3', 'mosaic 4', 'paper sheet']);
  assert.equal(reliefs.get('mosaic 1'), reliefs.get('mosaic 4'));
  for (const z of gaps) {
    near(heightOn('desk', 0.1, z), 0, 1e-5);
    near(heightOn('desk', -0.2, z + every / 2), 0.0005, 1e-6);
    near(heightOn('desk', 0, z + 0.002), 0.0005, 1e-6);
  }
  for (const x of [-0.0225, -0.0075, 0.0075, 0.0225]) near(heightOn('mosaic 2', x, 0), 0, 2e-5);
  for (const z of [-0.021, -0.007, 0.007, 0.021]) near(heightOn('mosaic 3', 0, z), 0, 2e-5);
  near(heightOn('mosaic 1', 0.015, 0.014), 0.0006, 1e-6);
  near(heightOn('paper sheet', 0.04, 0.035), 0, 1e-6);
});

test('the word reads from left to right, and its letters stand upright', () => {
  const height = looks.surfaces['paper sheet'].relief.word.height_metres;
  const left = -((0.85 * 3 + 0.55) / 2) * height;
  const isRaised = (letter, x, y) => heightOn('paper sheet', left + height * (0.85 * letter + x), height * (y - 0.5)) > 0.0002;
  // F has its bars above, L below; E both.
  for (const letter of [0, 1, 2, 3]) assert.ok(isRaised(letter, 0, 0.25));
  assert.deepEqual([0, 1, 2, 3].map((letter) => isRaised(letter, 0.5, 1)), [true, true, true, false]);
  assert.deepEqual([0, 1, 2, 3].map((letter) => isRaised(letter, 0.5, 0)), [false, true, true, true]);
});

test('a look without grooves and word, or with a letter that nobody drew, is refused in words', () => {
  assert.throws(() => reliefOf({ depth_metres: 1e-3, share: 0.1 }, [0.1, 0.1], 0), /"grooves" or "word"/);
  assert.throws(() => reliefOf({ word: { text: 'Q', height_metres: 0.01, width_metres: 0.001 }, depth_metres: 1e-3, share: 0.1 }, [0.1, 0.1], 0), /letter "Q"/);
});

describe('on the live page', { skip: !hasBrowser }, () => {
  /** @type {Awaited<ReturnType<typeof openLivePage>>} */
  let opened;
  before(async () => {
    opened = await openLivePage();
  });
  after(() => opened.close());
  const inPage = (action, argument) => opened.page.evaluate(action, argument);

  test('the profile shows the gap under the tip, and is hidden on glass and after lift-off', async () => {
    const found = await inPage(async (x) => {
      const page = globalThis.haptoflowPage;
      const canvas = document.querySelector('#profile');
      const frames = () => new Promise((resolve) => {
        requestAnimationFrame(() => requestAnimationFrame(resolve));
      });
      // A slow machine has few frames in a stroke, and the profile needs some that move.
      let atGap;
      for (let time = 0; time < 8 && !(atGap?.heights.at(-1) > 0.0004); time += 1) {
        const timer = setInterval(() => {
          const { contact } = page.tips[0];
          if (contact?.touching) atGap = { surface: contact.surfaceName, isShown: !canvas.hidden, heights: [...page.profile.heights.heightsMetres] };
        }, 10);
        await page.hand.play({ name: '', words: '', from: [x, 0.03], legs: [{ to: [x, 0.06], seconds: 1 + time }, { to: [x, 0.06], seconds: 0.5 }] });
        clearInterval(timer);
      }
      await frames();
      const lifted = canvas.hidden;
      /** @type {boolean[]} */
      const onGlass = [];
      const watching = setInterval(() => {
        if (page.tips[0].contact?.touching && page.tips[0].contact.surfaceName === 'glass plate') onGlass.push(canvas.hidden);
      }, 10);
      await page.hand.play({ name: '', words: '', from: [-0.2, 0.112], legs: [{ to: [-0.17, 0.112], seconds: 0.6 }] });
      clearInterval(watching);
      return { atGap, lifted, onGlass };
    }, freeX);
    assert.equal(found.atGap.surface, 'desk');
    assert.equal(found.atGap.isShown, true);
    const { heights } = found.atGap;
    const middle = (heights.length - 1) / 2;
    near(heights[middle], 0, 1e-4);
    near(heights[0], 0.0005, 1e-6);
    near(heights.at(-1), 0.0005, 1e-6);
    assert.equal(found.lifted, true);
    assert.ok(found.onGlass.length > 0 && found.onGlass.slice(-3).every(Boolean), `${found.onGlass}`);
  });

  test('boards, mosaic and paper play their relief; switched off, it does not run; the statistics tell', async () => {
    const runs = () => inPage(() => globalThis.haptoflowPage.tips[0].voice.statistics().effects.relief.runs);
    const stroke = (from, to) => inPage((places) => globalThis.haptoflowPage.hand.play({ name: '', words: '', from: places[0], legs: [{ to: places[1], seconds: 0.6 }] }), [from, to]);
    for (const [from, to] of [[[freeX, -0.03], [freeX, 0.03]], [[0.03, 0.133], [0.098, 0.133]], [[0.03, -0.112], [0.09, -0.112]]]) {
      const begun = await runs();
      await stroke(from, to);
      assert.ok(await runs() > begun + 20, `${from}`);
    }
    const beforeGlass = await runs();
    await stroke([-0.22, 0.112], [-0.15, 0.112]);
    assert.equal(await runs(), beforeGlass);
    await opened.page.locator('#effect-relief').uncheck();
    await stroke([freeX, -0.03], [freeX, 0.03]);
    assert.equal(await runs(), beforeGlass);
    await opened.page.locator('#effect-relief').check();
  });

  test('the gaps are seen where they are felt: darker than the boards beside them', async () => {
    const found = await inPage(([x, zs]) => {
      const { view } = globalThis.haptoflowPage;
      const still = document.querySelector('.still');
      const { left, top, width, height } = still.getBoundingClientRect();
      const context = still.getContext('2d');
      const darkness = (z) => {
        // Over 20 mm, so that the grain does not matter.
        const a = view.pointOf(x - 0.003, z);
        const b = view.pointOf(x + 0.003, z);
        const [column, row] = [((a.clientX - left) / width) * still.width, ((a.clientY - top) / height) * still.height];
        const { data } = context.getImageData(Math.round(column), Math.floor(row), Math.max(1, Math.round(((b.clientX - a.clientX) / width) * still.width)), 1);
        return data.filter((_, index) => index % 4 === 0).reduce((sum, red) => sum + red, 0) / (data.length / 4);
      };
      return zs.map((z) => [darkness(z), darkness(z + 0.01)]);
    }, [freeX, gaps]);
    for (const [gap, board] of found) assert.ok(gap < board - 40, `${gap} and ${board}`);
  });

  test('nothing was complained of', () => assert.deepEqual(opened.complaints, []));
});
