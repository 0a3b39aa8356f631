import assert from 'node:assert/strict';
import { test } from 'node:test';
import { pause } from '../../Web/engine/js/pause.mjs';
import { hasBrowser } from './support/browser.mjs';
import { hasSoundServer, openBarePage, startSoundServer } from './support/programs.mjs';

/** Notes in the page what sounds, and follows the engine's events. */
const watch = `(() => {
  const { haptics, voices } = haptoflowPage;
  globalThis.events = [];
  for (const type of ['error', 'recovered', 'context', 'device']) haptics.addEventListener(type, ({ detail }) => events.push({ type, state: detail.state ?? '' }));
  const tap = voices[0].waveTap();
  const wave = new Float32Array(2400);
  globalThis.peak = () => {
    tap.latest(wave);
    return wave.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);
  };
})()`;
const rub = "void haptoflowPage.hand.play({ name: '', words: '', from: [-0.22, -0.112], legs: Array.from({ length: 30 }, (_, leg) => ({ to: [leg % 2 ? -0.22 : -0.15, -0.112], seconds: 0.5 })) })";

test('a tab that is hidden in mid-stroke falls silent, is not taken for dead, and plays when it is back', { skip: !hasBrowser, timeout: 90000 }, async () => {
  const page = await openBarePage();
  try {
    await page.inPage(watch);
    await page.inPage(rub);
    await page.until('peak() > 1e-4');
    await page.hide();
    await page.until("document.visibilityState === 'hidden'");
    await page.until('peak() === 0');
    assert.equal(await page.inPage('haptoflowPage.tips[0].isDown'), false);
    // Longer than a worker may be silent while the page is seen.
    await pause(6000);
    await page.show();
    await page.until("document.visibilityState === 'visible'");
    assert.equal(await page.inPage('peak()'), 0);
    await page.inPage(rub);
    await page.until('peak() > 1e-4');
    assert.deepEqual(await page.inPage('events'), []);
    assert.equal(await page.inPage('haptoflowPage.haptics.statistics().recoveries'), 0);
  } finally {
    await page.close();
  }
});

test('an output that is unplugged is told, the wave for motors goes on, and the next output sounds by itself', { skip: !hasBrowser || !hasSoundServer, timeout: 90000 }, async () => {
  const sound = await startSoundServer();
  const page = await openBarePage(sound.environment).catch(async (error) => {
    await sound.close();
    throw error;
  });
  try {
    await page.inPage(watch);
    await page.inPage(rub);
    await page.until('peak() > 1e-4');
    assert.equal(sound.streams(), 1);
    sound.unplug();
    await page.until("/sound device .*lost/.test(document.querySelector('#message-text').textContent)");
    await page.inPage(rub);
    await page.until('peak() > 1e-4');
    assert.equal(await page.inPage('haptoflowPage.haptics.statistics().hasLostOutput'), true);
    assert.equal(await page.inPage("document.querySelector('#start').hidden"), true);
    sound.plug();
    await page.until('!haptoflowPage.haptics.statistics().hasLostOutput');
    await page.until("document.querySelector('#message').hidden");
    assert.equal(sound.streams(), 1);
    await page.inPage(rub);
    await page.until('peak() > 1e-4');
    assert.deepEqual(await page.inPage("events.filter(({ type }) => type === 'device').map(({ state }) => state)"), ['lost', 'back']);
    assert.deepEqual(await page.inPage("events.filter(({ type }) => type === 'error')"), []);
  } finally {
    await Promise.allSettled([page.close(), sound.close()]);
  }
});
