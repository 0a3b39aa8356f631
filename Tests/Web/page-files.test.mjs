import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { fittedTo, isModel, qualitiesOf } from '../../Web/page/model-file.mjs';
import { hasBrowser, openLivePage } from './support/browser.mjs';
import { recording, repository } from './support/engine.mjs';

const labels = (...names) => names.map((name) => ({ name }));
const sceneOf = (...materials) => ({ surfaces: materials.map((material, index) => ({ name: `object ${index}`, material })), stylus: {} });
const materialsOf = ({ scene }) => scene.surfaces.map(({ material }) => material);

test('a scene keeps the materials that a model has', () => {
  const scene = sceneOf('wood', 'stone', 'wood');
  assert.deepEqual(fittedTo(scene, labels('stone', 'wood')), { scene, lacking: [] });
});

test('a name that a model lacks becomes one of its own, the same on every object, and none that the scene has already', () => {
  const found = fittedTo(sceneOf('wood', 'jute', 'carpet', 'jute'), labels('wood', 'silk', 'slate'));
  assert.deepEqual(materialsOf(found), ['wood', 'silk', 'slate', 'silk']);
  assert.deepEqual(found.lacking, ['jute', 'carpet']);
});

test('a model of one label fills the whole scene, and names are spread over a model of many', () => {
  assert.deepEqual(materialsOf(fittedTo(sceneOf('wood', 'jute'), labels('wood'))), ['wood', 'wood']);
  const many = materialsOf(fittedTo(sceneOf('a', 'b', 'c'), labels(...Array.from({ length: 90 }, (_, index) => `material ${index}`))));
  assert.deepEqual(many, ['material 0', 'material 30', 'material 60']);
});

test('qualities are the tiers that the engine takes for them, each once', () => {
  assert.deepEqual(qualitiesOf(labels('sketch', 'draft', 'standard')).map(({ quality, tier }) => [quality, tier]), [['sketch', 'sketch'], ['draft', 'draft'], ['standard', 'standard']]);
  assert.deepEqual(qualitiesOf(labels('published-2', 'published')), [{ quality: 'sketch', tier: 'published-2' }, { quality: 'standard', tier: 'published' }]);
  assert.deepEqual(qualitiesOf(labels('one')), [{ quality: 'sketch', tier: 'one' }]);
});

test('a model file is one by its ending', () => {
  assert.deepEqual(['a.haptoflow', 'A.HAPTOFLOW', 'a.haptomaterial', 'haptoflow'].map(isModel), [true, true, false, false]);
});

describe('a file that is dropped on the live page', { skip: !hasBrowser }, () => {
  const imported = readFileSync(path.join(repository, 'Tests', 'Golden', 'model', 'published.haptoflow'));
  /** @type {Awaited<ReturnType<typeof openLivePage>>} */
  let opened;
  before(async () => {
    opened = await openLivePage();
  });
  after(() => opened.close());

  const drop = async (/** @type {Buffer} */ bytes, name = 'real.haptoflow') => {
    await opened.page.evaluate(({ base64, name: called }) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([Uint8Array.from(atob(base64), (letter) => letter.charCodeAt(0))], called));
      document.body.dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
    }, { base64: bytes.toString('base64'), name });
  };
  const text = async (/** @type {string} */ selector) => (await opened.page.locator(selector).textContent()) ?? '';
  const isReady = async () => {
    await opened.page.waitForFunction(() => 'haptoflowPage' in globalThis, null, { timeout: 60000 }).catch(async (error) => {
      throw new Error(`${error.message}: ${await text('#start-text')} ${await text('#message-text')} ${opened.complaints.join('; ')}`);
    });
  };

  test('a dropped recording becomes a material of the palette, and learning can be cancelled', async () => {
    const { page } = opened;
    const dropTable = () => opened.page.evaluate((content) => {
      const transfer = new DataTransfer();
      transfer.items.add(new File([content], 'rough.csv', { type: 'text/csv' }));
      document.querySelector('#drop').dispatchEvent(new DragEvent('drop', { dataTransfer: transfer, bubbles: true, cancelable: true }));
    }, recording(11));
    await page.evaluate(() => {
      globalThis.haptoflowPage.ownMaterial.secondsLimit = 1;
    });
    await dropTable();
    await page.locator('#learn-cancel').click();
    await page.waitForFunction(() => document.querySelector('#learn-result').textContent === 'Cancelled.');
    await dropTable();
    await page.waitForFunction(() => document.querySelector('#labels input[value="rough"]'), null, { timeout: 60000 });
    assert.match(await text('#learn-result'), /“rough” is in the palette/);
    await page.locator('#paint-object').selectOption({ label: 'Paper' });
    await page.getByRole('button', { name: 'Paint it' }).click();
    const loudest = await page.evaluate(async () => {
      const { hand, scope } = globalThis.haptoflowPage;
      let most = 0;
      const timer = setInterval(() => {
        most = Math.max(most, scope?.rmsMps2 ?? 0);
      }, 20);
      await hand.play({ name: '', words: '', from: [0.03, -0.112], legs: [{ to: [0.09, -0.112], seconds: 0.5 }, { to: [0.03, -0.112], seconds: 0.5 }] });
      clearInterval(timer);
      return most;
    });
    assert.ok(loudest > 0.01, `${loudest}`);
    assert.equal(await page.evaluate(() => globalThis.haptoflowPage.table.materials[13]), 'rough');
  });

  test('a file that is no recording is refused in words', async () => {
    const { page } = opened;
    await page.locator('#recording').setInputFiles({ name: 'letter.csv', mimeType: 'text/csv', buffer: Buffer.from('dear,friend\n1,2\n') });
    await page.waitForFunction(() => document.querySelector('#learn-result').textContent.includes('letter.csv'), null, { timeout: 20000 });
    assert.equal(await page.locator('#learn-progress').isHidden(), true);
  });

  test('a file that is no model is refused, and the page goes on', async () => {
    await drop(Buffer.from('{"no": "model"}'));
    await opened.page.waitForFunction(() => document.querySelector('#model-note')?.textContent?.includes('is no .haptoflow file'));
    assert.match(await text('#model-line'), /^The shipped model, 20 materials/);
  });

  test('an imported file plays: its labels, its tiers, sound from its network, and what the scene lacks is said', async () => {
    await Promise.all([opened.page.waitForNavigation(), drop(imported)]);
    await isReady();
    assert.match(await text('#model-line'), /^real\.haptoflow: Published HaptoFlow, 8 materials, imported from the published weights .*level assumed/);
    assert.match(await text('#message-text'), /This model has no .*jute.*: these objects are of other materials/);
    assert.deepEqual(await opened.page.locator('#qualities label').allTextContents(), ['published-1-unguided', 'published', 'auto']);
    assert.deepEqual(await opened.page.locator('#labels .chip-name').allTextContents(), ['aluminium', 'corduroy', 'granite', 'japanese cedar (sugi)', 'wool felt', 'wood', 'stone', 'metal']);
    const found = await opened.page.evaluate(async () => {
      const { hand, scope, haptics, quality } = globalThis.haptoflowPage;
      const runsOf = (/** @type {string} */ tier) => haptics.statistics().tiers?.find(({ name }) => name === tier)?.runs ?? 0;
      // Strokes until the network has run, for which a slow machine needs more than one.
      const loudestOf = async (/** @type {string} */ tier) => {
        let loudest = 0;
        const timer = setInterval(() => {
          loudest = Math.max(loudest, scope?.rmsMps2 ?? 0);
        }, 20);
        for (let stroke = 0; stroke < 20 && runsOf(tier) <= 3; stroke += 1) {
          await hand.play({ name: '', words: '', from: [-0.22, 0.05], legs: [{ to: [-0.15, 0.05], seconds: 0.7 }, { to: [-0.22, 0.05], seconds: 0.7 }] });
        }
        clearInterval(timer);
        return loudest;
      };
      const best = await loudestOf('published');
      await quality.choose('published-1-unguided');
      const fast = await loudestOf('published-1-unguided');
      await new Promise((resolve) => { setTimeout(resolve, 500); });
      return { best, fast, after: scope?.rmsMps2, tiers: haptics.statistics().tiers?.map(({ name, runs }) => ({ name, runs })) };
    });
    assert.ok(found.best > 0.05 && found.fast > 0.05, JSON.stringify(found));
    assert.equal(found.after, 0);
    for (const name of ['published-1-unguided', 'published']) assert.ok((found.tiers?.find((tier) => tier.name === name)?.runs ?? 0) > 3, JSON.stringify(found));
  });

  test('the file stays for the next visit, and the way back is the shipped model', async () => {
    const address = opened.page.url();
    await opened.page.goto('about:blank');
    await opened.page.goto(address);
    await isReady();
    assert.match(await text('#model-line'), /^real\.haptoflow/);
    await Promise.all([opened.page.waitForNavigation(), opened.page.locator('#model-back').click()]);
    await isReady();
    assert.match(await text('#model-line'), /^The shipped model/);
    assert.equal(await opened.page.locator('#model-back').isVisible(), false);
  });

  test('a damaged file is named where the page cannot start with it, and a button starts with the shipped model', async () => {
    const damaged = Buffer.from(imported);
    damaged[damaged.length - 5000] ^= 0xff;
    await Promise.all([opened.page.waitForNavigation(), drop(damaged)]);
    await opened.page.waitForFunction(() => document.querySelector('#start-text')?.textContent === 'The page cannot go on.', null, { timeout: 60000 });
    assert.match(await text('#message-text'), /real\.haptoflow: /);
    await Promise.all([opened.page.waitForNavigation(), opened.page.locator('#start-back').click()]);
    await isReady();
    assert.match(await text('#model-line'), /^The shipped model/);
  });
});
