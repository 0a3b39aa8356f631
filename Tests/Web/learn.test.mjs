import assert from 'node:assert/strict';
import { test } from 'node:test';
import { learn, render } from '../../Web/engine/js/offline.mjs';
import { coreWithModel, sample } from './support/engine.mjs';
import { recording } from './support/made-recording.mjs';

const reports = [];
const core = await coreWithModel({ onProgress: (share, doing) => reports.push({ share, doing }) });
const bytesOf = (text) => new TextEncoder().encode(text);

test('a table is learnt to a material that a scene can use, with progress', () => {
  const learnt = learn(core, { recording: [{ name: 'rough.csv', bytes: bytesOf(recording(11)) }], secondsLimit: 2 });
  assert.equal(learnt.name, 'rough');
  assert.equal(learnt.report.start_label, 'sandpaper');
  assert.ok(reports.length > 3 && reports.every(({ share, doing }) => share >= 0 && share <= 1 && doing !== ''));
  const scene = sample('tracing.scene.json').replace(/"material": "[^"]+"/g, '"material": "rough"');
  const options = { stroke: sample('tracing.stroke.csv'), quality: 'sketch', materials: [learnt.material] };
  assert.ok(render(core, { ...options, scene }).samples.some((number) => Math.abs(number) > 0.001));
});

const refusals = [
  ['a recording without motion', bytesOf(recording(2).replaceAll(/,[^,\n]+,[^,\n]+,[^,\n]+\n/g, '\n')), 'RECORDING_UNUSABLE', /rough\.csv/],
  ['bytes that are no table', new Uint8Array(40), 'RECORDING_UNUSABLE', /rough\.csv/],
  ['a blink', bytesOf(recording(0.1)), 'RECORDING_UNUSABLE', /short|seconds| s /],
];
for (const [name, bytes, code, message] of refusals) {
  test(`${name}: learning says why it cannot`, () => {
    assert.throws(() => learn(core, { recording: [{ name: 'rough.csv', bytes }] }), (error) => {
      assert.equal(error.code, code);
      assert.match(error.message, message);
      return true;
    });
  });
}
