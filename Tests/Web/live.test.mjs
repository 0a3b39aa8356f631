import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { hasBrowser, isLong, openPage } from './support/browser.mjs';
import { repository, sample } from './support/engine.mjs';

// In Chromium. The machine may be busy, so that times are judged with room.

/** @type {Awaited<ReturnType<typeof openPage>>} */
let opened;
const inPage = (action, argument) => opened.page.evaluate(action, argument);
const denim = readFileSync(path.join(repository, 'Tests', 'Golden', 'material', 'denim.haptomaterial'), 'utf8');

for (const isolated of [true, false]) {
  describe(isolated ? 'with shared memory' : 'without shared memory', { skip: !hasBrowser }, () => {
    before(async () => {
      opened = await openPage({ isolated });
    });
    after(() => opened.close());

    test('a slide sounds, lift-off ends it, nothing underruns, and the statistics say how it is played', async () => {
      const found = await inPage(async () => {
        const { started, hand, slide, pause, rms } = globalThis.tools;
        const { haptics, voice, events } = await started();
        const tap = voice.waveTap();
        const motor = voice.motorTap();
        await hand(voice, 1.2, slide('wood'));
        const wave = new Float32Array(24000);
        tap.latest(wave);
        const loud = rms(wave);
        const points = motor.read();
        voice.lift();
        await pause(400);
        tap.latest(wave.subarray(0, 4800));
        const result = { loud, quiet: rms(wave.subarray(0, 4800)), points, voice: voice.statistics(), engine: haptics.statistics(), events, written: tap.written };
        await haptics.close();
        return result;
      });
      assert.ok(found.loud > 1e-4, `${found.loud}`);
      assert.equal(found.quiet, 0);
      assert.equal(found.engine.sharing, isolated ? 'shared' : 'ring');
      assert.equal(found.engine.sharingNote === '', isolated);
      // It grows on a busy machine.
      assert.ok(isolated ? found.engine.ringFrames === 0 : found.engine.ringFrames >= 2048, `${found.engine.ringFrames}`);
      assert.equal(found.voice.underruns, 0);
      assert.equal(found.voice.nonFiniteSamples, 0);
      assert.equal(found.voice.failures, 0);
      assert.ok(found.voice.inferences > 15);
      assert.equal(found.engine.tier, 'standard');
      assert.ok(found.points.length > 100);
      assert.ok(Math.max(...found.points.map(({ share }) => share)) > 0.05);
      assert.deepEqual(found.events.filter(({ type }) => type === 'error'), []);
      assert.ok(found.written > 48000);
    });

    if (isolated || isLong) test('qualities change while the tip slides', async () => {
      const tiers = await inPage(async () => {
        const { started, hand, slide } = globalThis.tools;
        const { haptics, voice } = await started({ quality: 'sketch' });
        const found = [];
        for (const quality of ['draft', 'standard', 'auto', 'sketch']) {
          const done = haptics.setQuality(quality);
          await hand(voice, 0.3, slide('jute'));
          await done;
          await hand(voice, 0.3, slide('jute'));
          found.push(haptics.statistics().tier);
        }
        await haptics.close();
        return found;
      });
      assert.equal(tiers[0], 'draft');
      assert.equal(tiers[1], 'standard');
      assert.equal(tiers[3], 'sketch');
    });

    if (isolated || isLong) test('two voices sound at once, with settings of their own, and a closed one is refused', async () => {
      const found = await inPage(async () => {
        const { started, hand, slide, rms, pause } = globalThis.tools;
        const { haptics, voice } = await started({ quality: 'sketch' });
        const other = await haptics.openVoice({ gain: 0.25, listen: true, effects: { texture: true, impact: false, edge: false } });
        const taps = [voice.waveTap(), other.waveTap()];
        const both = { publish: (state) => [voice, other].forEach((each) => each.publish(state)) };
        await hand(both, 0.6, slide({ wood: 0.5, paper: 0.5 }));
        const levels = taps.map((tap) => {
          const wave = new Float32Array(9600);
          tap.latest(wave);
          return rms(wave);
        });
        voice.muted = true;
        await hand(both, 0.4, slide('wood'));
        await pause(0);
        const silence = voice.silence;
        await other.close();
        let refusal = '';
        try {
          other.publish({ touching: false });
        } catch (error) {
          refusal = error.code;
        }
        const result = { levels, silence, refusal, gain: other.gain, voices: haptics.voices.length };
        await haptics.close();
        return result;
      });
      assert.ok(found.levels.every((level) => level > 1e-5), `${found.levels}`);
      assert.equal(found.silence, 'muted');
      assert.equal(found.refusal, 'closed');
      assert.equal(found.gain, 0.25);
      assert.equal(found.voices, 1);
    });

    test('a voice that is closed while it sounds is heard to the end of its fade', async () => {
      const found = await inPage(async () => {
        const { started, hand, slide } = globalThis.tools;
        const { haptics, voice } = await started({ quality: 'sketch' });
        const tap = voice.waveTap();
        await hand(voice, 0.6, slide('wood'));
        await voice.close();
        const wave = new Float32Array(24000);
        tap.latest(wave);
        const last = wave.findLastIndex((sample) => sample !== 0);
        const peak = (samples) => samples.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);
        const result = { silent: wave.length - 1 - last, loudest: peak(wave), end: peak(wave.subarray(last - 4, last + 1)) };
        await haptics.close();
        return result;
      });
      assert.ok(found.silent > 0 && found.loudest > 1e-4, JSON.stringify(found));
      assert.ok(found.end < 0.1 * found.loudest, `a step at the end: ${JSON.stringify(found)}`);
    });

    if (isolated || isLong) test('a lost worker is told, and the voice sounds again by itself, on an added material too', async () => {
      const found = await inPage(async (text) => {
        const { started, hand, slide, rms, pause } = globalThis.tools;
        const { haptics, voice, events } = await started({ quality: 'draft' });
        const failureOf = (action) => Promise.resolve().then(action).then(() => null, ({ code, message }) => ({ code, message }));
        const unknown = await failureOf(() => voice.publish({ touching: true, material: 'denim' }));
        const taken = await failureOf(() => haptics.addMaterial('{"name": "wood"}'));
        const invalid = await failureOf(() => haptics.addMaterial('{"name": "denim"}'));
        const label = await haptics.addMaterial(text);
        const again = await haptics.addMaterial(text);
        const scene = haptics.loadScene({ surfaces: [{ name: 'table', shape: { plane: {} }, material: 'denim' }] });
        voice.gain = 0.5;
        const tap = voice.waveTap();
        await hand(voice, 0.3, slide('denim'));
        const recovered = new Promise((resolve) => haptics.addEventListener('recovered', ({ detail }) => resolve(detail.milliseconds)));
        haptics[Symbol.for('haptoflow.worker')].terminate();
        const milliseconds = await Promise.race([recovered, pause(15000)]);
        const wave = new Float32Array(9600);
        await hand(voice, 0.6, slide('denim'));
        tap.latest(wave);
        const result = {
          milliseconds, events, level: rms(wave), recoveries: haptics.statistics().recoveries, gain: voice.gain,
          unknown, taken, invalid, label, again, surface: scene.surfaces[0].material, labels: haptics.labels.length,
        };
        await haptics.close();
        return result;
      }, denim);
      assert.match(found.unknown.message, /"denim": there is no such label/);
      assert.match(found.taken.message, /"wood", which is a label of the model/);
      assert.equal(found.invalid.code, 'MATERIAL_INVALID');
      assert.deepEqual([found.label.index, found.label.isAdded, found.again.index, found.labels], [20, true, 20, 21]);
      assert.deepEqual(found.surface, { denim: 1 });
      assert.ok(found.milliseconds > 0, 'it did not recover');
      const [error] = found.events.filter(({ type }) => type === 'error');
      assert.equal(error.error.code, 'worker-lost');
      assert.equal(error.isFatal, false);
      assert.equal(found.recoveries, 1);
      assert.ok(found.level > 1e-5);
      assert.equal(found.gain, 0.5);
    });
  });
}

if (isLong) describe('a ring whose worker is busy', { skip: !hasBrowser }, () => {
  before(async () => {
    opened = await openPage();
  });
  after(() => opened.close());

  test('grows, stays so after a recovery, and the statistics say how long it is', async () => {
    const found = await inPage(async () => {
      const { started, hand, slide } = globalThis.tools;
      const { haptics, voice } = await started({ sharing: 'ring', ringFrames: 1024, quality: 'sketch' });
      const lengths = [haptics.statistics().ringFrames];
      await hand(voice, 0.3, slide('wood'));
      // Loading a network takes the worker longer than the ring lasts.
      const loaded = haptics.setQuality('standard');
      await hand(voice, 2, slide('wood'));
      await loaded;
      lengths.push(haptics.statistics().ringFrames);
      const late = voice.statistics().ringUnderruns;
      await hand(voice, 1, slide('wood'));
      const later = voice.statistics().ringUnderruns - late;
      const recovered = new Promise((resolve) => haptics.addEventListener('recovered', resolve));
      haptics[Symbol.for('haptoflow.worker')].terminate();
      await recovered;
      lengths.push(haptics.statistics().ringFrames);
      await haptics.close();
      return { lengths, late, later };
    });
    assert.equal(found.lengths[0], 1024);
    assert.ok(found.late > 0, 'no block came too late');
    assert.ok(found.lengths[1] > 1024 && found.lengths[1] <= 8192 && found.lengths[2] >= found.lengths[1], `${found.lengths}`);
    assert.ok(found.later < found.late / 4, `${found.late}, then ${found.later}`);
  });
});

describe('a relief', { skip: !hasBrowser }, () => {
  before(async () => {
    opened = await openPage();
  });
  after(() => opened.close());

  for (const sharing of ['shared', 'ring']) {
    test(`sounds with sharing "${sharing}", is the same one after the worker was lost, and ends when it is destroyed`, async () => {
      const found = await inPage(async (way) => {
        const { started, hand, pause } = globalThis.tools;
        const { haptics, voice } = await started({ sharing: way, quality: 'sketch' });
        voice.effects = { texture: false, impact: false, edge: false };
        const ribs = (depthMetres) => ({ columns: 128, rows: 1, heightsMetres: Float32Array.from({ length: 128 }, (_, index) => depthMetres * [0, 0.5, 1, 0.5][index % 4]), sizeMetres: [0.064, 0.064], depthMetres });
        const others = [await haptics.createRelief(ribs(1e-6)), await haptics.createRelief(ribs(1e-6))];
        const relief = await haptics.createRelief(ribs(1e-4));
        // What is destroyed leaves its number behind, which a new engine knows nothing of.
        others[0].destroy();
        const table = { surfaces: [{ name: 'table', shape: { box: { size: [1, 0.02, 1] } }, material: 'wood' }] };
        const scene = haptics.loadScene(table);
        scene.setRelief('table', relief);
        const tap = voice.waveTap();
        const began = performance.now();
        // To and fro at 0.1 m/s, for longer where a busy machine lets states come too late.
        const level = async (wanted = 0) => {
          const published = { publish: () => {
            const seconds = (performance.now() - began) / 1000;
            scene.publish(voice, { timeSeconds: seconds, positionMetres: [0.1 * Math.abs((seconds % 2) - 1), 0.0105, 0], forceNewtons: 1 });
          } };
          let loudest = 0;
          for (let time = 0; time < 10 && (time === 0 || loudest < wanted); time += 1) {
            await hand(published, 1, () => null);
            const wave = new Float32Array(19200);
            tap.latest(wave);
            loudest = 200 * Math.max(...wave.map(Math.abs));
          }
          return loudest;
        };
        const levels = [await level(1.5)];
        const recovered = new Promise((resolve) => haptics.addEventListener('recovered', resolve));
        haptics[Symbol.for('haptoflow.worker')].terminate();
        await recovered;
        levels.push(await level(1.5));
        relief.destroy();
        await pause(200);
        levels.push(await level());
        scene.setRelief('table', others[1]);
        levels.push(await level(2e-3));
        const refusal = await haptics.createRelief({ ...ribs(1e-4), depthMetres: 0 }).catch(({ code }) => code);
        await haptics.close();
        return { levels, refusal };
      }, sharing);
      const [first, recovered, destroyed, other] = found.levels;
      assert.ok(first > 1 && recovered > 1, `${found.levels} m/s^2`);
      assert.ok(destroyed < 1e-4, `${found.levels} m/s^2`);
      assert.ok(other > 1e-3 && other < first / 10, `${found.levels} m/s^2`);
      assert.equal(found.refusal, 'INVALID_ARGUMENT');
    });
  }

});

describe('silences and contact', { skip: !hasBrowser }, () => {
  before(async () => {
    opened = await openPage();
  });
  after(() => opened.close());

  test('a context that stops is a silence with a reason, and sound returns when it is resumed', async () => {
    const found = await inPage(async () => {
      const { started, hand, slide, pause } = globalThis.tools;
      const { haptics, voice, events } = await started({ quality: 'sketch' });
      await hand(voice, 0.3, slide('wood'));
      await haptics.context.suspend();
      await pause(300);
      const stopped = voice.statistics().silence;
      await haptics.resume();
      await hand(voice, 0.4, slide('wood'));
      const again = voice.silence;
      await haptics.close();
      return { stopped, again, events };
    });
    assert.equal(found.stopped, 'context');
    assert.equal(found.again, 'none');
    assert.ok(found.events.some(({ type, state }) => type === 'context' && state === 'suspended'));
    assert.ok(found.events.some(({ type, reason }) => type === 'silent' && reason === 'context'));
  });

});
