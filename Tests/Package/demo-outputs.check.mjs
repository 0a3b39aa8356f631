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

test('the report lists the crossing scene, every traced label, the taps and the boards', () => {
  assert.deepEqual(report.renders.map(({ name }) => name), ['crossing', ...tracedLabels, tapsName, boardsName]);
  assert.equal(typeof report.model, 'string');
});

test('every object of the report has exactly the documented keys', () => {
  const keys = ['name', 'labels', 'wav', 'seconds', 'rms_mps2', 'peak', 'segments', 'inference_ms', 'nonfinite', 'underruns'];
  assert.deepEqual(Object.keys(report), ['model', 'renders']);
  for (const render of report.renders) {
    assert.deepEqual(Object.keys(render), keys, render.name);
    assert.deepEqual(Object.keys(render.inference_ms), ['p50', 'p99'], render.name);
  }
});

test('every traced render names the label that it was made for', () => {
  for (const render of report.renders.slice(1, -2)) assert.deepEqual(render.labels, [render.name]);
});

test('the length, the level and the peak of every file equal those in its report', () => {
  for (const render of report.renders) {
    const { samples, rateHz } = waveOf(render);
    assert.equal(rateHz, 48000, render.name);
    assert.ok(Math.abs(samples.length / rateHz - render.seconds) < 0.001, `${render.name}: length`);
    const level = soundingLevel(samples);
    assert.ok(Math.abs(level - render.rms_mps2) <= 0.03 * render.rms_mps2, `${render.name}: ${level} and ${render.rms_mps2} m/s^2`);
    const peak = samples.reduce((most, value) => Math.max(most, Math.abs(value)), 0);
    assert.ok(Math.abs(peak - render.peak) < 1e-3, `${render.name}: peak ${peak} and ${render.peak}`);
  }
});

test('every file is finite, within full scale and not silent', () => {
  for (const render of report.renders) {
    const { samples } = waveOf(render);
    assert.ok(samples.every((value) => Number.isFinite(value) && Math.abs(value) <= 1), render.name);
    assert.ok(render.rms_mps2 > 0.01, `${render.name}: ${render.rms_mps2} m/s^2`);
  }
});

test('every render ran the network and counted no fault', () => {
  for (const render of report.renders) {
    assert.ok(render.segments > 0, render.name);
    assert.ok(render.inference_ms.p50 > 0 && render.inference_ms.p99 >= render.inference_ms.p50, render.name);
    assert.equal(render.nonfinite, 0, render.name);
    assert.equal(render.underruns, 0, render.name);
  }
});

test('the crossing is silent before the first touch', () => {
  const { samples, rateHz } = waveOf(report.renders[0]);
  assert.ok(samples.subarray(0, Math.round(0.2 * rateHz)).every((value) => Math.abs(value) < 1e-6));
});

test('labels differ in level: stone is stronger than glass', () => {
  const level = (name) => report.renders.find((render) => render.name === name).rms_mps2;
  assert.ok(level('stone') > 1.5 * level('glass'), `stone ${level('stone')}, glass ${level('glass')} m/s^2`);
});

test('each of the nine taps makes a pulse, which is stronger the higher the tap began', () => {
  const { samples, rateHz } = waveOf(report.renders.at(-2));
  const { samples: quiet } = waveOf(report.renders[0]);
  assert.ok(quiet.length > 0);
  const blocks = Array.from({ length: Math.floor(samples.length / (0.02 * rateHz)) }, (_, block) =>
    samples.subarray(block * 0.02 * rateHz, (block + 1) * 0.02 * rateHz).reduce((most, value) => Math.max(most, Math.abs(value)), 0));
  const onsets = blocks.flatMap((peak, block) => (block > 0 && peak > 4 * blocks[block - 1] && peak > 0.01 ? [block] : []));
  const taps = onsets.filter((block) => block * 0.02 < 5.2);
  assert.equal(taps.length, 9, `${taps.map((block) => (block * 0.02).toFixed(2))} s`);
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

test('the rendered scenes are in the folder of the sound files', () => {
  for (const render of report.renders) {
    assert.ok(existsSync(path.join(folder, 'scenes', render.wav.replace(/\.wav$/, '.scene.json'))), render.name);
  }
});

test('boards are felt as wood with a blow at each gap', () => {
  const wood = report.renders.find(({ name }) => name === 'wood');
  const boards = report.renders.at(-1);
  assert.deepEqual(boards.labels, ['wood']);
  assert.ok(boards.peak > 3 * wood.peak, `${boards.peak} and ${wood.peak}`);
  const peaksOf = (render) => {
    const { samples } = waveOf(render);
    const blocks = Array.from({ length: Math.floor(samples.length / 960) }, (_, block) => samples.subarray(960 * block, 960 * (block + 1)));
    return blocks.filter((block) => block.some((value) => Math.abs(value) > 1.5 * wood.peak)).length;
  };
  assert.equal(peaksOf(wood), 0);
  assert.ok(peaksOf(boards) > 10, `${peaksOf(boards)} blocks of 20 ms`);
});
