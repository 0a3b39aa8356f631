import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { clipFormats, createClip, readClip } from '../../Web/engine/js/clip.mjs';
import { render } from '../../Web/engine/js/offline.mjs';
import { hasBrowser, isLong, openPage } from './support/browser.mjs';
import { coreWithModel, hasCommandLine, native, sample, samplePath } from './support/engine.mjs';

// Clips in JavaScript: the C++ writes and reads them, so that the command line's files are the same.

const core = await coreWithModel();
const sine = (seconds, rateHz, hz = 160) => Float32Array.from({ length: Math.round(seconds * rateHz) }, (_, index) => 4 * Math.sin((2 * Math.PI * hz * index) / rateHz));
/** A second of 4 m/s^2. */
const tone = { samples: sine(1, 48000), rateHz: 48000, fullScaleMps2: 1, title: 'a tone', description: 'made', source: 'nowhere' };
const haptic = (points, more = {}) => JSON.stringify({ version: { major: 1, minor: 0, patch: 0 }, signals: { continuous: { envelopes: { amplitude: points.map(([time, amplitude]) => ({ time, amplitude })), ...more } } } });

test('a render brings its full scale along', () => {
  const options = { scene: sample('tracing.scene.json'), stroke: sample('tracing.stroke.csv'), quality: 'sketch' };
  const [own, other] = [100, 200].map((fullScaleMps2) => createClip(core, render(core, { ...options, fullScaleMps2 })).largestAmplitude);
  assert.ok(own > 0.01 && Math.abs(own / other - 1) < 0.01, `${own}, ${other}`);
});

describe('a render as a clip', { skip: !hasCommandLine }, () => {
  const scene = 'taps';
  const commandLineFiles = () => native(
    (folder) => ['render', samplePath(`${scene}.scene.json`), '--stroke', samplePath(`${scene}.stroke.csv`), ...clipFormats.flatMap((format) => ['-o', path.join(folder, `x.${format}`)]), '--quiet', '--quality', 'sketch', '--effects', 'texture,impact'],
    (folder) => Object.fromEntries(clipFormats.map((format) => [format, readFileSync(path.join(folder, `x.${format}`), 'utf8')])),
  );

  test('has the curves and the transients of the command line\'s files within 1e-3, in every format', () => {
    const rendered = render(core, { scene: sample(`${scene}.scene.json`), stroke: sample(`${scene}.stroke.csv`), quality: 'sketch', effects: { texture: true, impact: true, edge: false } });
    const { files } = createClip(core, rendered);
    const theirs = commandLineFiles();
    for (const format of clipFormats) {
      const [own, other] = [readClip(core, files[format]), readClip(core, theirs[format])];
      assert.equal(own.format, format);
      assert.equal(own.seconds, other.seconds);
      assert.ok(own.transients.length > 10);
      assert.equal(own.transients.length, other.transients.length, format);
      own.transients.forEach((each, index) => {
        assert.ok(Math.abs(each.timeSeconds - other.transients[index].timeSeconds) <= 1e-3, `${format}: ${JSON.stringify([each, other.transients[index]])}`);
        assert.ok(Math.abs(each.amplitude - other.transients[index].amplitude) <= 1e-3, `${format}: ${JSON.stringify([each, other.transients[index]])}`);
      });
      const apart = own.amplitude.reduce((most, value, index) => Math.max(most, Math.abs(value - other.amplitude[index])), 0);
      const hertz = own.frequencyHz.reduce((most, value, index) => Math.max(most, Math.abs(value / other.frequencyHz[index] - 1)), 0);
      assert.ok(apart <= 1e-3 && hertz <= 1e-3, `${format}: ${apart}, ${hertz}`);
    }
    assert.ok(Math.max(...readClip(core, files.haptic).amplitude) > 0.1);
  });
});

test('a clip says its figures, its curves and what it came from', () => {
  const clip = createClip(core, tone);
  assert.deepEqual([clip.format, clip.title, clip.description, clip.omitted], ['haptic', 'a tone', 'made', '']);
  assert.match(clip.editor, /^HaptoFlow \d/);
  assert.ok(Math.abs(clip.seconds - 1) < 0.01, `${clip.seconds}`);
  assert.equal(clip.amplitude.length, 251);
  assert.ok(clip.amplitudePoints >= 2 && clip.frequencyPoints >= 2);
  const middle = Array.from(clip.frequencyHz.subarray(50, 200));
  assert.ok(middle.every((hz) => Math.abs(hz - 160) < 5), `${middle}`);
  assert.ok(Math.abs(clip.largestAmplitude - Math.max(...clip.amplitude)) < 0.01);
  assert.equal(clip.text, clip.files.haptic);
  assert.deepEqual(clipFormats.map((format) => readClip(core, clip.files[format]).format), [...clipFormats]);
  assert.equal(JSON.parse(clip.files.hjif).date, new Date().toISOString().slice(0, 10));
});

test('full scale is 200 m/s^2 unless given', () => {
  const { largestAmplitude } = createClip(core, tone);
  assert.ok(Math.abs(createClip(core, { ...tone, samples: tone.samples.map((each) => each / 200), fullScaleMps2: undefined }).largestAmplitude - largestAmplitude) < 1e-3);
});

/** @type {[string, () => unknown, string, RegExp][]} */
const refusals = [
  ['a wave of no samples', () => createClip(core, { ...tone, samples: new Float32Array(0) }), 'INVALID_ARGUMENT', /a clip of no samples/],
  ['a wave that is no array of floats', () => createClip(core, { ...tone, samples: [1, 2] }), 'invalid-argument', /expected a Float32Array/],
  ['a rate of nothing', () => createClip(core, { ...tone, rateHz: NaN }), 'invalid-argument', /rateHz is NaN; expected 8000/],
  ['a full scale of nothing', () => createClip(core, { ...tone, fullScaleMps2: 0 }), 'invalid-argument', /fullScaleMps2 is 0/],
  ['no text', () => readClip(core, /** @type {any} */ (undefined)), 'invalid-argument', /expected the text/],
  ['another file', () => readClip(core, '{"no": "clip"}'), 'INVALID_ARGUMENT', /"signals".*"Pattern".*"perceptions"/],
];
for (const [name, action, code, message] of refusals) {
  test(`${name} is refused in words`, () => {
    assert.throws(action, (error) => {
      assert.equal(error.code, code, error.message);
      assert.match(error.message, message);
      return true;
    });
  });
}

describe('a voice and clips', { skip: !hasBrowser }, () => {
  /** @type {Awaited<ReturnType<typeof openPage>>} */
  let opened;
  before(async () => {
    opened = await openPage();
    await opened.page.evaluate((texts) => {
      const { started, hand, pause } = globalThis.tools;
      let [publishedMs, longestGapMs] = [0, 0];
      /** Publishes states of a tip in the air for a time. */
      const hover = (voice, seconds) => hand(voice, seconds, () => {
        const now = performance.now();
        longestGapMs = Math.max(longestGapMs, now - publishedMs);
        publishedMs = now;
        return { touching: false };
      });
      /** What `action` finds while no state is late: a clip ends 100 ms after the last one, and a busy machine may hold the page up. */
      const steadily = async (action) => {
        for (let tries = 1; ; tries += 1) {
          [publishedMs, longestGapMs] = [performance.now(), 0];
          const found = await action();
          if (longestGapMs < 80 || tries === 5) return found;
        }
      };
      /** The largest value of the last `seconds`, m/s^2, while the tip is in the air. */
      const loudestOf = async (voice, tap, seconds = 0.3) => {
        await hover(voice, seconds);
        const wave = new Float32Array(Math.round(0.8 * seconds * tap.sampleRateHz));
        tap.latest(wave);
        return 200 * Math.max(...wave.map(Math.abs));
      };
      /** Hovers until `work` is done. */
      const handDuring = async (voice, work) => {
        let isDone = false;
        const done = work.finally(() => { isDone = true; });
        while (!isDone) await hover(voice, 0.02);
        return done;
      };
      /** Plays a clip, and publishes states until the engine has loaded it and for `seconds` more. */
      const playAndWait = async (voice, clip, options, seconds) => {
        await handDuring(voice, voice.playClip(clip, options));
        longestGapMs = 0;
        await hover(voice, seconds);
      };
      Object.assign(globalThis, { texts, loudestOf, started, hover, handDuring, playAndWait, steadily, pause });
    }, { loud: haptic([[0, 0.6], [0.3, 0.6]]), soft: haptic([[0, 0.1], [0.3, 0.1]]), long: haptic(Array.from({ length: 6001 }, (_, index) => [index / 10, 0.3 + 0.2 * (index % 2)])), nothing: haptic([[0, 0]]) });
  });
  after(() => opened.close());
  const inPage = (action, argument) => opened.page.evaluate(action, argument);

  for (const sharing of ['shared', 'ring']) {
    test(`with sharing "${sharing}": a loop sounds without contact, another clip takes its place, the counters count, and its end is silence`, async () => {
      const found = await inPage(async (way) => {
        const { haptics, voice } = await globalThis.started({ sharing: way, quality: 'sketch' });
        const tap = voice.waveTap();
        const [loud, soft] = await Promise.all([haptics.readClip(globalThis.texts.loud), haptics.readClip(globalThis.texts.soft)]);
        const levels = {};
        const play = (clip, options, act = () => {}) => globalThis.steadily(async () => {
          await globalThis.playAndWait(voice, clip, options, 0.4);
          act();
          return globalThis.loudestOf(voice, tap, 0.6);
        });
        levels.loud = await play(loud, { isLoop: true });
        levels.soft = await play(soft, { isLoop: true });
        levels.quiet = await play(loud, { isLoop: true, gain: 0 });
        levels.once = await play(loud, {});
        // A first play that still loads gives way to a later one, and to a stop.
        levels.replaced = await globalThis.steadily(async () => {
          const late = await globalThis.handDuring(voice, haptics.readClip(globalThis.texts.loud));
          const loading = voice.playClip(late, { isLoop: true });
          voice.playClip(soft, { isLoop: true });
          await globalThis.handDuring(voice, loading);
          await globalThis.hover(voice, 0.2);
          return globalThis.loudestOf(voice, tap, 0.5);
        });
        voice.stopClip();
        // A busy machine lengthens the ring.
        await globalThis.hover(voice, 0.3);
        levels.stopped = await globalThis.loudestOf(voice, tap, 0.4);
        await globalThis.pause(200);
        const { effects } = voice.statistics();
        const refusal = await voice.playClip(loud, { gain: 5 }).catch(({ code }) => code);
        haptics.forgetClip(loud);
        levels.again = await play(loud, { isLoop: true });
        levels.forgotten = await play(loud, { isLoop: true }, () => haptics.forgetClip(loud));
        await play(loud, { isLoop: true });
        await globalThis.pause(400);
        levels.stale = await globalThis.loudestOf(voice, tap, 0.4);
        await play(loud, { isLoop: true });
        voice.muted = true;
        await globalThis.hover(voice, 0.2);
        voice.muted = false;
        levels.muted = await globalThis.loudestOf(voice, tap, 0.4);
        const errors = voice.statistics().failures;
        await haptics.close();
        return { levels, clip: effects.clip, refusal, errors };
      }, sharing);
      const { levels } = found;
      const shown = JSON.stringify(found);
      assert.ok(levels.loud > 3 * levels.soft && levels.soft > 0.01, shown);
      assert.equal(levels.quiet, 0, shown);
      assert.equal(levels.once, 0, shown);
      assert.ok(Math.abs(levels.replaced - levels.soft) < 0.1 * levels.soft, shown);
      assert.equal(levels.stopped, 0, shown);
      assert.ok(levels.again > 0.5 * levels.loud && levels.forgotten > 0.5 * levels.loud, shown);
      assert.equal(levels.muted, 0, shown);
      assert.equal(levels.stale, 0, `it went on without states: ${shown}`);
      assert.ok(found.clip.runs > 100 && found.clip.events >= 5, shown);
      assert.equal(found.refusal, 'invalid-argument');
    });
  }

  test('after the worker was lost a clip that played is silent, and plays when it is asked for', async () => {
    const found = await inPage(async () => {
      const { haptics, voice, events } = await globalThis.started({ quality: 'sketch' });
      const tap = voice.waveTap();
      const loud = await haptics.readClip(globalThis.texts.loud);
      await globalThis.playAndWait(voice, loud, { isLoop: true }, 0.3);
      const recovered = new Promise((resolve) => haptics.addEventListener('recovered', resolve));
      haptics[Symbol.for('haptoflow.worker')].terminate();
      await recovered;
      const lost = await globalThis.loudestOf(voice, tap, 0.4);
      const play = (seconds) => globalThis.steadily(async () => {
        await globalThis.playAndWait(voice, loud, { isLoop: true }, seconds);
        return globalThis.loudestOf(voice, tap, 0.4);
      });
      const again = await play(0.5);
      // Asked for while the engine starts again, it waits for that; states that are published meanwhile are no harm to its memory.
      const told = new Promise((resolve) => haptics.addEventListener('error', resolve));
      haptics[Symbol.for('haptoflow.worker')].terminate();
      await told;
      voice.stopClip();
      const later = await play(2);
      await haptics.close();
      return { lost, again, later, errors: events.filter(({ type }) => type === 'error').length };
    });
    assert.equal(found.lost, 0);
    assert.ok(found.again > 1 && found.later > 1, JSON.stringify(found));
    assert.equal(found.errors, 2);
  });

  test('a clip of ten minutes is read, and plays without holding the page or the audio up; an empty one is silence', async () => {
    const found = await inPage(async () => {
      const { haptics, voice } = await globalThis.started({ quality: 'sketch' });
      const tap = voice.waveTap();
      let [longest, before] = [0, performance.now()];
      const timer = setInterval(() => {
        longest = Math.max(longest, performance.now() - before);
        before = performance.now();
        voice.publish({ touching: false });
      }, 8);
      const began = performance.now();
      const clip = await haptics.readClip(globalThis.texts.long);
      const readMs = performance.now() - began;
      longest = 0;
      const asked = performance.now();
      await voice.playClip(clip);
      const loadMs = performance.now() - asked;
      await globalThis.pause(600);
      const level = await globalThis.loudestOf(voice, tap, 0.4);
      clearInterval(timer);
      const { memoryBytes } = haptics.statistics();
      await globalThis.playAndWait(voice, await haptics.readClip(globalThis.texts.nothing), {}, 0.4);
      const nothing = await globalThis.loudestOf(voice, tap, 0.4);
      const { underruns } = voice.statistics();
      await haptics.close();
      return { seconds: clip.seconds, points: clip.amplitudePoints, readMs, loadMs, longest, level, nothing, memoryBytes, underruns };
    });
    if (isLong) console.log(JSON.stringify(found));
    assert.equal(found.seconds, 600);
    assert.ok(found.level > 0.1, JSON.stringify(found));
    assert.equal(found.nothing, 0);
    assert.ok(found.longest < 400, JSON.stringify(found));
    assert.equal(found.underruns, 0);
  });
});
