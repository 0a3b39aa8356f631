import assert from 'node:assert/strict';
import path from 'node:path';
import { test } from 'node:test';
import { hasBrowser, openLivePage } from './support/browser.mjs';
import { repository } from './support/engine.mjs';

const emulator = path.join(repository, 'node_modules', 'iwer', 'build', 'iwer.js');

/** An emulated Quest from the first script on; the emulator calls all its poses guessed. */
function emulate() {
  const { XRDevice, metaQuest3, P_SPACE } = globalThis.IWER;
  const device = new XRDevice(metaQuest3);
  device.installRuntime({ forceInstall: true });
  device.stereoEnabled = false;
  device.position.set(0, 1.3, 0);
  for (const each of Object.values(device.controllers)) each.inputSource.targetRaySpace[P_SPACE].emulated = false;
  Object.assign(globalThis, { device });
}

test('the live page offers the headset, loads three.js only on entering, and shows afterwards what was painted there', { skip: !hasBrowser }, async () => {
  const { page, complaints, strangers, close } = await openLivePage({ viewport: { width: 200, height: 150 }, script: emulator, before: emulate });
  try {
    await page.waitForSelector('#enter-vr:not([hidden])', { state: 'attached', timeout: 30000 });
    const isLoaded = () => performance.getEntriesByType('resource').some(({ name }) => name.endsWith('/three.module.js'));
    assert.equal(await page.evaluate(isLoaded), false);
    const voices = await page.evaluate(() => globalThis.haptoflowPage.haptics.voices.length);
    await page.locator('#enter-vr').click();
    await page.waitForFunction((before) => globalThis.haptoflowPage.haptics.voices.length === before + 2, voices, { timeout: 20000 });
    assert.equal(await page.evaluate(isLoaded), true);
    const painted = await page.evaluate(async () => {
      const { swatches } = await import(new URL('xr/board.mjs', location.href).href);
      const { device, haptoflowPage } = globalThis;
      const labels = haptoflowPage.haptics.labels.map(({ name }) => name);
      const { position } = swatches(labels).find(({ material }) => material === 'sandpaper');
      const frames = async (count, isTrue = () => false) => {
        for (let frame = 0; frame < count && !isTrue(); frame += 1) {
          await new Promise((resolve) => {
            requestAnimationFrame(resolve);
          });
        }
      };
      // The bench stands 0.4 m ahead of the emulated head and 0.45 m below it; the nib is 0.06 m ahead of the hand.
      const hold = async ([x, y, z]) => {
        device.controllers.right.position.set(x, 0.85 + y, -0.4 - z + 0.06);
        await frames(20);
      };
      const { table } = haptoflowPage;
      const index = table.scene.surfaces.findIndex(({ name }) => name === 'paper sheet');
      let isFelt = false;
      // The first frames may come while the headset is still made ready.
      for (let time = 0; time < 5 && table.materials[index] !== 'sandpaper'; time += 1) {
        await hold([0, 0.3, 0]);
        await hold([position[0], position[1] + 0.0035 * Math.sin(0.4), position[2] - 0.0035 * Math.cos(0.4)]);
        await hold([0.062, 0.0003, -0.112]);
        isFelt = isFelt || haptoflowPage.haptics.voices.some((voice) => voice.statistics().effects.relief.isAskedFor);
        device.controllers.right.updateButtonValue('trigger', 1);
        await hold([0.062, 0.0003, -0.112]);
        device.controllers.right.updateButtonValue('trigger', 0);
      }
      await device.activeSession.end();
      await frames(600, () => !document.querySelector('#enter-vr').disabled);
      return { isFelt, material: table.materials[index], isDisabled: document.querySelector('#enter-vr').disabled };
    });
    assert.equal(painted.material, 'sandpaper');
    assert.equal(painted.isFelt, true, 'the embossed word of the paper');
    assert.equal(painted.isDisabled, false);
    assert.deepEqual(complaints, []);
    assert.deepEqual(strangers, []);
  } finally {
    await close();
  }
});

test('a headset\'s browser without graphics, states of sight, joints or motors costs these, and the page goes on', { skip: !hasBrowser }, async () => {
  const lack = () => {
    const { getContext } = HTMLCanvasElement.prototype;
    globalThis.hasGraphics = false;
    HTMLCanvasElement.prototype.getContext = function (kind, ...more) {
      return kind === '2d' || globalThis.hasGraphics ? getContext.call(this, kind, ...more) : null;
    };
    Object.defineProperty(globalThis.XRSession.prototype, 'visibilityState', { get: () => undefined });
    delete globalThis.XRFrame.prototype.getJointPose;
    for (const { inputSource } of Object.values(globalThis.device.controllers)) {
      Object.defineProperty(inputSource.gamepad, 'hapticActuators', { get() { throw new DOMException('denied', 'SecurityError'); } });
      Object.defineProperty(inputSource.gamepad, 'vibrationActuator', { get() { throw new DOMException('denied', 'SecurityError'); } });
    }
  };
  const { page, complaints, close } = await openLivePage({ viewport: { width: 200, height: 150 }, script: emulator, before: [emulate, lack] });
  try {
    await page.waitForSelector('#enter-vr:not([hidden])', { state: 'attached', timeout: 30000 });
    const click = () => page.evaluate(() => document.querySelector('#enter-vr').click());
    await click();
    await page.waitForFunction(() => /^Headset: /.test(document.querySelector('#missing').textContent), null, { timeout: 20000 });
    assert.equal(await page.evaluate(() => globalThis.haptoflowPage.haptics.voices.length), 2, 'the voices of the failed visit are closed');
    await page.evaluate(() => { globalThis.hasGraphics = true; });
    await click();
    await page.waitForFunction(() => globalThis.haptoflowPage.haptics.voices.length === 4, null, { timeout: 20000 });
    const sounded = await page.evaluate(async () => {
      const { device, haptoflowPage } = globalThis;
      const [, , , right] = haptoflowPage.haptics.voices;
      let hasSounded = false;
      // Over the sandpaper: the bench stands 0.4 m ahead of the emulated head and 0.45 m below it; the nib is 0.06 m ahead of the hand.
      for (let frame = 0; frame < 900 && !hasSounded; frame += 1) {
        device.controllers.right.position.set(-0.185 + 0.03 * Math.sin(frame / 8), 0.8505, -0.4 + 0.112 + 0.06);
        await new Promise((resolve) => { requestAnimationFrame(resolve); });
        hasSounded = right.silence === 'none' && right.isTouching;
      }
      device.primaryInputMode = 'hand';
      for (let frame = 0; frame < 5; frame += 1) await new Promise((resolve) => { requestAnimationFrame(resolve); });
      await device.activeSession.end();
      return hasSounded;
    });
    assert.equal(sounded, true);
    await page.waitForFunction(() => !document.querySelector('#enter-vr').disabled);
    assert.equal(await page.locator('#message').isHidden(), true, await page.locator('#message').textContent());
    assert.deepEqual(complaints.filter((text) => !/WebGL/.test(text)), []);
  } finally {
    await close();
  }
});
