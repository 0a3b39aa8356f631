// Run after the demo: the files in out/demo must match the page and the report.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { readFloatWav } from './support/float_wav.mjs';

const fullScaleMps2 = 200;
const tracedLabels = ['wood', 'metal mesh', 'corduroy', 'sandpaper', 'glass', 'rubber', 'jute', 'stone'];
const tapsName = 'taps and rims';
const boardsName = 'boards';

const folder = inRepository('out', 'demo');
const report = JSON.parse(readFileSync(path.join(folder, 'report.json'), 'utf8'));
const waveOf = (render) => readFloatWav(readFileSync(path.join(folder, render.wav)), render.wav);

/** Level in m/s^2 over the blocks of 5 ms in which something sounds. */
function soundingLevel(samples) {
  let [energy, count] = [0, 0];
  for (let begin = 0; begin < samples.length; begin += 240) {
    const block = samples.subarray(begin, begin + 240);
    if (block.every((value) => value === 0)) continue;
    energy += block.reduce((sum, value) => sum + value * value, 0);
    count += block.length;
  }
  return count > 0 ? fullScaleMps2 * Math.sqrt(energy / count) : 0;
}

/** The largest sample of each block of 20 ms. */
const peaksOf = (samples) => Array.from({ length: Math.floor(samples.length / 960) }, (_, block) =>
  samples.subarray(960 * block, 960 * (block + 1)).reduce((most, value) => Math.max(most, Math.abs(value)), 0));

test('the report has exactly the documented keys, for the crossing scene, every traced label, the taps and the boards', () => {
  assert.deepEqual(Object.keys(report), ['model', 'renders']);
  assert.equal(typeof report.model, 'string');
  assert.deepEqual(report.renders.map(({ name }) => name), ['crossing', ...tracedLabels, tapsName, boardsName]);
  const keys = ['name', 'labels', 'wav', 'seconds', 'rms_mps2', 'peak', 'segments', 'inference_ms', 'nonfinite', 'underruns'];
  for (const render of report.renders) {
    assert.deepEqual(Object.keys(render), keys, render.name);
    assert.deepEqual(Object.keys(render.inference_ms), ['p50', 'p99'], render.name);
  }
  for (const { name, labels } of report.renders.slice(1, -2)) assert.deepEqual(labels, [name]);
});

for (const render of report.renders) {
  test(`${render.name}: the file is what the report says of it, within full scale and not silent, made by the network without a fault`, () => {
    const { samples, rateHz } = waveOf(render);
    assert.equal(rateHz, 48000);
    assert.ok(samples.every((value) => Number.isFinite(value) && Math.abs(value) <= 1));
    assert.ok(Math.abs(samples.length / rateHz - render.seconds) < 0.001, 'length');
    const level = soundingLevel(samples);
    assert.ok(Math.abs(level - render.rms_mps2) <= 0.03 * render.rms_mps2, `${level} and ${render.rms_mps2} m/s^2`);
    assert.ok(render.rms_mps2 > 0.01, `${render.rms_mps2} m/s^2`);
    const peak = samples.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    assert.ok(Math.abs(peak - render.peak) < 1e-3, `peak ${peak} and ${render.peak}`);
    assert.ok(render.segments > 0 && render.inference_ms.p50 > 0 && render.inference_ms.p99 >= render.inference_ms.p50);
    assert.deepEqual([render.nonfinite, render.underruns], [0, 0]);
    assert.ok(existsSync(path.join(folder, 'scenes', render.wav.replace(/\.wav$/, '.scene.json'))));
  });
}

test('the crossing is silent before the first touch', () => {
  const { samples, rateHz } = waveOf(report.renders[0]);
  assert.ok(samples.subarray(0, Math.round(0.2 * rateHz)).every((value) => Math.abs(value) < 1e-6));
});

test('labels differ in level: stone is stronger than glass', () => {
  const level = (name) => report.renders.find((render) => render.name === name).rms_mps2;
  assert.ok(level('stone') > 1.5 * level('glass'), `stone ${level('stone')}, glass ${level('glass')} m/s^2`);
});

test('each of the nine taps makes a pulse', () => {
  const peaks = peaksOf(waveOf(report.renders.at(-2)).samples);
  const onsets = peaks.flatMap((peak, block) => (block > 0 && peak > 4 * peaks[block - 1] && peak > 0.01 ? [block * 0.02] : []));
  const taps = onsets.filter((seconds) => seconds < 5.2);
  assert.equal(taps.length, 9, `${taps.map((seconds) => seconds.toFixed(2))} s`);
});

test('boards are felt as wood with a blow at each gap', () => {
  const wood = report.renders.find(({ name }) => name === 'wood');
  const boards = report.renders.at(-1);
  assert.deepEqual(boards.labels, ['wood']);
  assert.ok(boards.peak > 3 * wood.peak, `${boards.peak} and ${wood.peak}`);
  const [ofWood, ofBoards] = [wood, boards].map((render) => peaksOf(waveOf(render).samples).filter((peak) => peak > 1.5 * wood.peak).length);
  assert.equal(ofWood, 0);
  assert.ok(ofBoards > 10, `${ofBoards} blocks of 20 ms`);
});

test('the page is one file without references to the network', () => {
  const page = readFileSync(path.join(folder, 'index.html'), 'utf8');
  assert.ok(!/(?:src|href)="(?!data:|#)/.test(page), 'a source or link leads outside the page');
  assert.ok(!/url\(|@import|https?:/.test(page), 'a style or script leads outside the page');
  assert.equal(page.match(/<audio /g).length, report.renders.length);
  assert.equal(page.match(/href="data:image\/png/g).length, report.renders.length);
  assert.ok(page.includes('trained on synthetic recordings'));
  assert.ok(!/undefined|NaN/.test(page.replace(/data:[^"]*/g, '')), 'a value of the page is missing');
});
