import assert from 'node:assert/strict';
import test from 'node:test';
import { bandLane, labelStretches, niceCeiling, waveformLane } from '../../scripts/demo/charts.mjs';
import { parseCsv } from '../../scripts/demo/csv.mjs';
import { readContacts } from '../../scripts/demo/stroke_path.mjs';

test('axes end at a round number times a power of ten', () => {
  assert.deepEqual([0, 0.03, 1, 1.2, 4.9, 5.1, 99].map(niceCeiling).map((value) => Number(value.toPrecision(6))), [1, 0.03, 1, 1.2, 5, 6, 100]);
});

test('stretches of one label are joined and end where the next begins', () => {
  const labels = ['wood', 'wood', null, 'stone', 'wood'];
  const readings = labels.map((label, index) => ({ timeSeconds: index, label }));
  assert.deepEqual(labelStretches(readings), [
    { label: 'wood', begin: 0, end: 2 },
    { label: 'stone', begin: 3, end: 4 },
    { label: 'wood', begin: 4, end: 4 },
  ]);
});

test('a band escapes its label', () => {
  assert.ok(!bandLane([{ timeSeconds: 0, label: '<i>' }], 1).includes('<i>'));
});

test('the waveform axis is in m/s^2 and ends at the given value', () => {
  const lane = waveformLane(Float32Array.from([0, 0.5, -0.25, 0]), 60, 30, 'w');
  assert.ok(lane.includes('+30') && lane.includes('−30'));
});

test('a CSV without a required column is refused with the column\'s name', () => {
  assert.throws(() => parseCsv('t,x\n0,1\n', 'stroke.csv', ['t', 'y']), /stroke\.csv, line 1: .* y not there/);
});

test('a CSV row of the wrong length is refused with its number', () => {
  assert.throws(() => parseCsv('t,x\n0,1\n1\n', 'stroke.csv', ['t']), /row 2: expected 2 fields, got 1/);
});

test('contact states carry the label of the surface, the speed and the position of the stroke', () => {
  const scene = { surfaces: [{ name: 'board', material: { stone: 0.2, wood: 0.8 } }] };
  const contact = 't,surface,touching,vx_mps,vy_mps,force_n\n5,,0,0,0,0\n5.5,board,1,0.3,0.4,1.5\n';
  const stroke = 't,x,y,z\n5,0,0,0\n6,1,2,4\n';
  const [before, during] = readContacts(contact, stroke, scene);
  assert.deepEqual([before.touching, before.label, before.timeSeconds], [false, null, 0]);
  assert.deepEqual([during.label, during.speedMps, during.forceNewtons, during.timeSeconds], ['wood', 0.5, 1.5, 0.5]);
  assert.deepEqual(during.position, [0.5, 1, 2]);
});
