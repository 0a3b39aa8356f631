import assert from 'node:assert/strict';
import { test } from 'node:test';
import { render } from '../../Web/engine/js/offline.mjs';
import { coreWithModel, sample } from './support/engine.mjs';
import { browsers, reportOf } from './support/other-browsers.mjs';
import { hasSoundServer } from './support/sound-server.mjs';

const task = { scene: sample('tracing.scene.json'), stroke: sample('tracing.stroke.csv') };
const loudest = (/** @type {ArrayLike<number>} */ wave) => Array.from(wave).reduce((most, each) => Math.max(most, Math.abs(each)), 0);

for (const [name, { isThere }] of Object.entries(browsers)) {
  for (const isolated of [true, false]) {
    test(`${name}, ${isolated ? 'with' : 'without'} shared memory: the samples, live sound, silence, recovery and the live page`, { skip: !isThere || !hasSoundServer, timeout: 150000 }, async () => {
      const { failures, userAgent, rendered, slid, drawn } = await reportOf(name, { task, isolated });
      console.log(`# ${userAgent}: ${JSON.stringify(slid?.engine)} ${JSON.stringify({ ...slid?.voice, effects: undefined })}`);
      assert.deepEqual(failures, []);
      const core = await coreWithModel();
      for (const quality of ['sketch', 'draft', 'standard']) {
        const { samples } = render(core, { ...task, quality });
        assert.equal(rendered[quality].length, samples.length);
        const difference = loudest(samples.map((expected, index) => rendered[quality][index] - expected));
        assert.ok(difference <= 1e-6 * loudest(samples), `${quality}: ${difference} of ${loudest(samples)}`);
      }
      assert.equal(slid.engine.sharing, isolated ? 'shared' : 'ring');
      assert.equal(slid.state, 'running');
      assert.ok(slid.peak > 1e-4 && slid.motor > 0.05, `${slid.peak}, ${slid.motor}`);
      assert.equal(slid.quiet, 0);
      assert.equal(slid.voice.underruns + slid.voice.failures + slid.voice.nonFiniteSamples, 0);
      assert.ok(slid.voice.renderedFrames > 48000);
      assert.deepEqual(slid.events.map((/** @type {string} */ event) => event.split(' ')[0]), ['error', 'recovered']);
      assert.ok(slid.again > 1e-4, `${slid.again}`);
      assert.ok(drawn.isComplete && drawn.start);
      for (const surface of ['sandpaper sheet', 'jute mat']) assert.ok(drawn.heard.includes(surface), `${drawn.heard}`);
      assert.ok(drawn.rmsMps2 > 0.1, `${drawn.rmsMps2}`);
      assert.deepEqual(drawn.complaints, []);
      assert.equal(drawn.error, '');
    });
  }
}
