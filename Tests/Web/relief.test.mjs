import assert from 'node:assert/strict';
import { writeFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { field, fieldCount, LabelIndices, writeState } from '../../Web/engine/js/contact-fields.mjs';
import { render } from '../../Web/engine/js/offline.mjs';
import { Relief } from '../../Web/engine/js/relief.mjs';
import { Scene } from '../../Web/engine/js/scene.mjs';
import { coreWithModel, hasCommandLine, native, pageCore, wavSamples } from './support/engine.mjs';
import { png } from './support/png.mjs';

const core = await coreWithModel();
const { labels } = core.json('hapto_model_json');
const rateHz = 48000;

const tableOf = (more = {}) => ({ surfaces: [{ name: 'table', shape: { box: { size: [1, 0.02, 1] } }, position: [0, -0.01, 0], material: 'wood', ...more }], stylus: { tip_radius: 0.0005 } });
/** From (-0.1, z) along x, a second at `speedMps`. */
const strokeOf = (speedMps, z = 0) => `t,x,y,z,force\n${Array.from({ length: 101 }, (_, row) => `${0.01 * row},${(0.01 * row * speedMps - 0.1).toFixed(6)},0.0004,${z},1`).join('\n')}\n`;
/** Ribs along z, sixteen on a map. */
const ribs = (pitchMetres, depthMetres, more = {}) => {
  const [columns, rows, pitch] = [512, 4, 32];
  const heightsMetres = Float32Array.from({ length: columns * rows }, (_, index) => depthMetres * (0.5 + 0.5 * Math.sin((2 * Math.PI * index) / pitch)));
  return { columns, rows, heightsMetres, sizeMetres: [16 * pitchMetres, 0.1], depthMetres, ...more };
};
const renderOver = (options) => render(core, { scene: tableOf(), stroke: strokeOf(0.2), quality: 'sketch', ...options });

/** Power of the wave at a frequency, in m/s^2, over its middle. */
function amplitudeAt(samples, hz) {
  const [from, to] = [0.2 * rateHz, 0.9 * rateHz];
  let [real, imaginary] = [0, 0];
  for (let index = from; index < to; index += 1) {
    real += samples[index] * Math.cos((2 * Math.PI * hz * index) / rateHz);
    imaginary += samples[index] * Math.sin((2 * Math.PI * hz * index) / rateHz);
  }
  return (200 * 2 * Math.hypot(real, imaginary)) / (to - from);
}

test('a relief that is switched off, and none, leave every sample as it was', () => {
  const plain = renderOver({});
  const off = renderOver({ reliefs: { table: ribs(0.004, 1e-4) }, effects: { texture: true, relief: false } });
  assert.deepEqual(off.samples, plain.samples);
  assert.deepEqual(renderOver({}).samples, plain.samples);
  const on = renderOver({ reliefs: { table: ribs(0.004, 1e-4) } });
  assert.ok(amplitudeAt(on.samples, 50) > 10 * amplitudeAt(plain.samples, 50), `${amplitudeAt(on.samples, 50)}, ${amplitudeAt(plain.samples, 50)}`);
});

test('the samples over a relief are those of the command line over an image of the same heights', { skip: !hasCommandLine }, () => {
  const [columns, rows, depth] = [40, 30, 2e-4];
  const greys = Array.from({ length: columns * rows }, (_, index) => (index * 37 + 11 * Math.floor(index / columns) ** 2) % 256);
  const heightsMetres = Float32Array.from(greys, (grey) => (depth * grey) / 255);
  const relief = { columns, rows, heightsMetres, sizeMetres: [0.03, 0.02], depthMetres: depth, tipRadiusMetres: 0.0005, share: 0.3 };
  const [stroke, effects] = [strokeOf(0.15, 0.013), { texture: true, impact: true, edge: true }];
  const web = renderOver({ stroke, effects, reliefs: { table: relief } });
  const expected = native((folder) => {
    const [scene, strokeFile] = [path.join(folder, 'scene.json'), path.join(folder, 'stroke.csv')];
    writeFileSync(path.join(folder, 'heights.png'), png({ width: columns, height: rows, numbers: greys }));
    writeFileSync(scene, JSON.stringify(tableOf({ relief: { image: 'heights.png', size: [0.03, 0.02], depth, share: 0.3 } })));
    writeFileSync(strokeFile, stroke);
    return ['render', scene, '--stroke', strokeFile, '-o', path.join(folder, 'out.wav'), '--quiet', '--quality', 'sketch', '--effects', 'texture,impact,edge'];
  }, (folder) => wavSamples(path.join(folder, 'out.wav')));
  assert.equal(web.samples.length, expected.length);
  const peak = expected.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);
  const largest = expected.reduce((most, sample, index) => Math.max(most, Math.abs(sample - web.samples[index])), 0);
  assert.ok(peak > 0.03 && largest < 1e-5 * peak, `${largest} of ${peak}`);
  const plain = renderOver({ stroke, effects });
  assert.ok(expected.some((sample, index) => Math.abs(sample - plain.samples[index]) > 0.1 * peak), 'the relief makes no difference');
});

const damaged = [
  ['heights of another count', { columns: 5 }, 'invalid-argument', /2048 numbers; expected columns by rows, 5 by 4/],
  ['a map without texels', { columns: 0, heightsMetres: new Float32Array(0) }, 'INVALID_ARGUMENT', /texel/],
  ['a depth of 0', { depthMetres: 0 }, 'INVALID_ARGUMENT', /depth/],
  ['a length that is not a number', { sizeMetres: [NaN, 1] }, 'INVALID_ARGUMENT', /./],
  ['heights that are not finite', { heightsMetres: new Float32Array(2048).fill(Infinity) }, 'INVALID_ARGUMENT', /finite/],
  ['a tip that is too thick', { tipRadiusMetres: 1 }, 'INVALID_ARGUMENT', /radius/],
];
for (const [name, change, code, message] of damaged) {
  test(`${name}: a relief is refused in words`, () => {
    assert.throws(() => renderOver({ reliefs: { table: { ...ribs(0.004, 1e-4), ...change } } }), (error) => {
      assert.equal(error.code, code, error.message);
      assert.match(error.message, message);
      return true;
    });
  });
}

test('a relief for a surface that the scene lacks is refused by its name', () => {
  assert.throws(() => renderOver({ reliefs: { chair: ribs(0.004, 1e-4) } }), /no surface "chair"/);
});

test('a scene says where the tip is in the relief of a surface, until it is taken away', () => {
  const indices = new LabelIndices();
  indices.set(labels);
  const scene = new Scene(pageCore(), indices, labels, tableOf());
  const relief = new Relief(/** @type {any} */ ({ ...ribs(0.02, 1e-4), sizeMetres: [0.02, 0.05] }), 7, () => {});
  const at = (seconds) => scene.update({ timeSeconds: seconds, positionMetres: [0.005, 0.0004, 0.02] });
  assert.equal(at(0).relief, null);
  scene.setRelief('table', relief, { share: 0.25 });
  const contact = at(0.01);
  assert.equal(contact.relief, relief);
  assert.deepEqual(contact.reliefPlace.map((part) => Number(part.toFixed(5))), [0.25, -0.4]);
  assert.equal(contact.reliefShare, 0.25);
  // A state of one's own that names the relief says the same, without a scene.
  const fields = new Float64Array(fieldCount);
  writeState({ touching: true, material: 'wood', relief, reliefPlace: [0.25, -0.4], reliefShare: 0.25 }, 1, fields);
  assert.deepEqual([field.relief, field.reliefPlace, field.reliefPlace + 1, field.reliefShare].map((at) => fields[at]), [7, 0.25, -0.4, 0.25]);
  scene.setRelief(0, null);
  assert.equal(at(0.02).relief, null);
  assert.throws(() => scene.setRelief('chair', relief), /no surface "chair"/);
  scene.close();
  assert.throws(() => scene.setRelief('table', relief), (error) => error.code === 'closed');
});
