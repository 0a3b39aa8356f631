import assert from 'node:assert/strict';
import { after, before, describe, test } from 'node:test';
import { render } from '../../Web/engine/js/offline.mjs';
import { hasBrowser, openPage } from './support/browser.mjs';
import { coreWithModel, sample } from './support/engine.mjs';

// The engine in a page, as far as nothing has to be heard.

/** @type {Awaited<ReturnType<typeof openPage>>} */
let opened;
const inPage = (action, argument) => opened.page.evaluate(action, argument);

describe('the engine in a page', { skip: !hasBrowser }, () => {
  before(async () => {
    opened = await openPage();
  });
  after(() => opened.close());

  const failureOf = (options) => inPage(async (given) => {
    try {
      const haptics = await globalThis.HaptoFlow.create(given);
      await haptics.close();
      return null;
    } catch (error) {
      return { name: error.name, code: error.code, message: error.message };
    }
  }, options);

  const cases = [
    ['a model that is not there', {}, ['/engine/model.haptoflow', () => 404], 'model-unreachable', /model\.haptoflow: 404.*check the address/],
    ['a model cut short', {}, ['/engine/model.haptoflow', (bytes) => bytes.subarray(0, 100000)], 'MODEL_TRUNCATED', /./],
    ['a page in place of a model', {}, ['/engine/model.haptoflow', () => Buffer.from('<!doctype html>'.repeat(100))], 'NOT_A_MODEL', /./],
    ['an engine that is not there', {}, ['/engine/engine.wasm', () => 404], 'engine-unreachable', /engine\.wasm: 404.*base/],
    ['an engine cut short', {}, ['/engine/engine.wasm', (bytes) => bytes.subarray(0, 1000)], 'engine-unreachable', /is not the engine/],
    ['ONNX Runtime that is not there', {}, ['/engine/ort-wasm-simd-threaded.wasm', () => 503], 'runtime-unreachable', /503.*onnxruntime-web 1\.30\.0/],
    ['a worker script that is not there', {}, ['/engine/live-worker.mjs', () => 404], 'worker-lost', /live-worker\.mjs/],
    ['an audio script that is not there', {}, ['/engine/worklet.mjs', () => 404], 'engine-unreachable', /worklet\.mjs/],
    ['a quality that does not exist', { quality: 'best' }, null, 'invalid-argument', /"best": expected/],
  ];
  for (const [name, options, change, code, message] of cases) {
    test(`${name}: a plain message`, async () => {
      if (change) opened.server.changes.set(change[0], change[1]);
      const failure = await failureOf(options);
      opened.server.changes.clear();
      assert.equal(failure?.name, 'HaptoFlowError');
      assert.equal(failure.code, code, failure.message);
      assert.match(failure.message, message);
    });
  }

  test('after all these failures the next attempt works', async () => {
    assert.equal(await failureOf({ quality: 'sketch' }), null);
  });

  test('loading is aborted by a signal', async () => {
    const code = await inPage(async () => {
      const controller = new AbortController();
      const loading = globalThis.HaptoFlow.create({ signal: controller.signal });
      setTimeout(() => controller.abort(), 30);
      return loading.then(() => 'loaded', (error) => error.code);
    });
    assert.equal(code, 'aborted');
  });

  test('a render in the page has the samples of the render in Node', async () => {
    const options = { scene: sample('tracing.scene.json'), stroke: sample('tracing.stroke.csv'), quality: 'standard' };
    const found = await inPage(async (given) => {
      const shares = [];
      const { samples, ...figures } = await globalThis.HaptoFlow.render({ ...given, onProgress: (share) => shares.push(share) });
      return { figures, samples: Array.from(samples.subarray(40000, 44000)), shares };
    }, options);
    const here = render(await coreWithModel(), options);
    assert.deepEqual(found.samples, Array.from(here.samples.subarray(40000, 44000)));
    assert.equal(found.figures.touches, here.touches);
    assert.ok(found.shares.length > 2);
  });

  test('learning ends at once by its signal, a refused recording says why, and measuring gives a row for each tier', async () => {
    const found = await inPage(async () => {
      const controller = new AbortController();
      const samples = Float32Array.from({ length: 24000 }, () => Math.random());
      const recording = { name: 'rough', accelerationMps2: samples, sampleRateHz: 2000, constantVelocityMps: [0.1, 0], constantForceNewtons: 1 };
      const learning = globalThis.HaptoFlow.learn({ recording, signal: controller.signal, onProgress: (share, doing) => doing !== 'loading' && controller.abort() });
      const aborted = await learning.then(() => 'learnt', ({ code }) => code);
      const refused = await globalThis.HaptoFlow.learn({ recording: [{ name: 'rough.csv', bytes: new Uint8Array(9) }] }).then(() => 'learnt', ({ code }) => code);
      const haptics = await globalThis.HaptoFlow.create({ quality: 'sketch' });
      const rows = await haptics.measure({ seconds: 0.2 });
      const costs = await haptics.measureEffects();
      await haptics.close();
      return { aborted, refused, rows, costs };
    });
    assert.equal(found.aborted, 'aborted');
    assert.equal(found.refused, 'RECORDING_UNUSABLE');
    assert.deepEqual(found.rows.map(({ tier }) => tier), ['sketch', 'draft', 'standard']);
    assert.deepEqual(found.costs.map(({ effect }) => effect), ['texture', 'impact', 'edge', 'relief', 'clip', 'delay', 'compensation', 'listen']);
    assert.ok(found.costs[0].microsecondsPerBlock > 0);
    assert.ok(found.rows.every(({ hotMs, pacedMs }) => hotMs.median > 0 && pacedMs.median >= hotMs.minimum));
  });
});
