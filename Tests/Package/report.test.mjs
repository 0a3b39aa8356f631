import assert from 'node:assert/strict';
import test from 'node:test';
import { assembleReport } from '../../scripts/demo/report.mjs';

const ofCommandLine = {
  name: 'tracing', model: 'default', labels: ['wood'], wav: 'wood.wav', seconds: 6, rms_mps2: 1.5, peak: 0.2, segments: 430,
  inference_ms: { p50: 0.4, p99: 0.7 }, nonfinite: 0, underruns: 0, solver: 'midpoint', steps: 2,
};

test('the report names the model once and has the documented keys of each render, in order', () => {
  const report = assembleReport([{ name: 'wood', report: ofCommandLine }]);
  assert.deepEqual(Object.keys(report), ['model', 'renders']);
  assert.equal(report.model, 'default');
  assert.deepEqual(Object.keys(report.renders[0]), [
    'name', 'labels', 'wav', 'seconds', 'rms_mps2', 'peak', 'segments', 'inference_ms', 'nonfinite', 'underruns',
  ]);
  assert.equal(report.renders[0].name, 'wood');
});

test('a missing figure is an error that names the render and the key', () => {
  const { rms_mps2: _, ...without } = ofCommandLine;
  assert.throws(() => assembleReport([{ name: 'wood', report: without }]), /report of "wood": "rms_mps2" must be a finite number/);
  const halved = { ...ofCommandLine, inference_ms: { p50: 0.4 } };
  assert.throws(() => assembleReport([{ name: 'wood', report: halved }]), /inference_ms\.p99/);
});

test('renders of two models do not make one report', () => {
  const other = { ...ofCommandLine, model: 'another' };
  assert.throws(() => assembleReport([{ name: 'a', report: ofCommandLine }, { name: 'b', report: other }]), /default, another/);
});
