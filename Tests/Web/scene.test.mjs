import assert from 'node:assert/strict';
import { test } from 'node:test';
import { LabelIndices } from '../../Web/engine/js/contact-fields.mjs';
import { Scene } from '../../Web/engine/js/scene.mjs';
import { rotate } from '../../Web/page/xr/frames.mjs';
import { coreWithModel, hasCommandLine, native, pageCore, sample, samplePath } from './support/engine.mjs';

const { labels } = (await coreWithModel()).json('hapto_model_json');
const indices = new LabelIndices();
indices.set(labels);
const core = pageCore();
const sceneOf = (text) => new Scene(core, indices, labels, text);

/** The tip at each frame of a scene, as `haptoflow contact` reads strokes. */
function* framesOf(text, updateRateHz) {
  const rows = text.trim().split('\n').slice(1).map((line) => line.split(',').map(Number));
  const hasForce = text.startsWith('t,x,y,z,force');
  const count = Math.floor((rows.at(-1)[0] - rows[0][0]) * updateRateHz + 1e-6) + 1;
  for (let frame = 0; frame < count; frame += 1) {
    const time = rows[0][0] + frame / updateRateHz;
    const after = rows.findIndex((row) => row[0] > time);
    const b = rows[after < 0 ? rows.length - 1 : after];
    const a = rows[after <= 0 ? (after < 0 ? rows.length - 1 : 0) : after - 1];
    const share = b[0] > a[0] ? (time - a[0]) / (b[0] - a[0]) : 0;
    const mix = (column) => a[column] + share * (b[column] - a[column]);
    yield { timeSeconds: time, positionMetres: [mix(1), mix(2), mix(3)], ...(hasForce ? { forceNewtons: mix(4) } : {}) };
  }
}

for (const name of ['crossing', 'taps', 'tracing']) {
  test(`${name}: contact states are the command line's`, { skip: !hasCommandLine }, () => {
    const output = native(() => ['contact', samplePath(`${name}.scene.json`), '--stroke', samplePath(`${name}.stroke.csv`)], (_, text) => text);
    const [header, ...lines] = output.trim().split('\n');
    const columns = header.split(',');
    const scene = sceneOf(sample(`${name}.scene.json`));
    let touching = 0;
    let row = 0;
    for (const tip of framesOf(sample(`${name}.stroke.csv`), scene.updateRateHz)) {
      const expected = Object.fromEntries(lines[row].split(',').map((cell, index) => [columns[index], cell]));
      const found = scene.update(tip);
      const near = (value, column) => assert.ok(Math.abs(value - Number(expected[column])) < 1e-5, `${column} of row ${row}: ${value} and ${expected[column]}`);
      assert.equal(found.touching ? '1' : '0', expected.touching, `row ${row}`);
      near(found.velocityMps[0], columns.find((column) => /^v(elocity)?_?x/.test(column)));
      near(found.forceNewtons, columns.find((column) => column.startsWith('force')));
      touching += found.touching ? 1 : 0;
      row += 1;
    }
    assert.equal(row, lines.length);
    assert.ok(touching > 10);
  });
}

const table = { surfaces: [{ name: 'table', shape: { box: { size: [1, 0.02, 1] } }, material: { wood: 3, fur: 1 }, stiffness: 500 }] };
const over = (seconds, depth = 0.002) => ({ timeSeconds: seconds, positionMetres: [0.1 * seconds, 0.011 - depth, 0] });

test('a surface can change its material, scale and tone; one that does not exist is named', () => {
  const scene = sceneOf(table);
  const first = scene.update(over(0));
  assert.deepEqual(first.material, { wood: 0.75, fur: 0.25 });
  assert.ok(Math.abs(first.penetrationMetres - 0.002) < 1e-9 && Math.abs(first.forceNewtons - 1) < 1e-6);
  scene.setSurface('table', { material: 'glass', spatialScale: 2, toneDbPerOctave: -3 });
  const contact = scene.update(over(0));
  assert.equal(contact.material, 'glass');
  assert.equal(contact.spatialScale, 2);
  assert.equal(contact.toneDbPerOctave, -3);
  assert.throws(() => scene.setSurface('chair', {}), /no surface "chair"/);
  assert.throws(() => scene.setSurface('table', { material: 'glas' }), /material "glas": there is no such label/);
});

test('a closed scene refuses calls, and its place is used again', () => {
  const scene = sceneOf(table);
  scene.close();
  assert.throws(() => scene.update(over(0)), (error) => error.code === 'closed');
  assert.ok(sceneOf(table).update(over(0)).touching);
});

// The contact model says where a touched point is in the room and in the surface's own frame: that gives away the pose it uses.
const turn = (angle, [x, y, z]) => [Math.sin(angle / 2) * x, Math.sin(angle / 2) * y, Math.sin(angle / 2) * z, Math.cos(angle / 2)];
const motions = {
  'there and back, in a loop': { loop: true, keyframes: [
    { t: 0, position: [-0.07, 0.002, 0] },
    { t: 4, position: [0.07, 0.002, 0] },
    { t: 8, position: [-0.07, 0.002, 0] },
  ] },
  'a curve that turns': { loop: false, keyframes: [
    { t: 1, position: [0.2, 0, 0] },
    { t: 1.5, position: [0.25, 0.02, 0.1], rotation: turn(1, [0, 1, 0]) },
    { t: 3, position: [0.1, 0, -0.1], rotation: turn(2.5, [0, 0.6, 0.8]) },
  ] },
};

for (const [name, motion] of Object.entries(motions)) {
  test(`${name}: the pose of a moving surface is where contact finds it`, () => {
    const scene = sceneOf({ surfaces: [{ name: 'mover', shape: { box: { size: [2, 0.5, 2] } }, material: 'wood', motion }] });
    const pose = { position: [0, 0, 0], rotation: [0, 0, 0, 1] };
    for (let seconds = 0; seconds < 20; seconds += 0.37) {
      assert.equal(scene.poseOf(0, seconds, pose), pose);
      const toRoom = (place) => rotate(pose.rotation, place, []).map((part, axis) => part + pose.position[axis]);
      scene.reset();
      const contact = scene.update({ timeSeconds: seconds, positionMetres: toRoom([0.01, 0.2495, 0.02]) });
      assert.equal(contact.touching, true, `${seconds} s`);
      toRoom(contact.placeMetres).forEach((part, axis) => assert.ok(Math.abs(part - contact.contactMetres[axis]) < 1e-6, `${seconds} s`));
      rotate(pose.rotation, [0, 1, 0], []).forEach((part, axis) => assert.ok(Math.abs(part - contact.normal[axis]) < 1e-6, `${seconds} s`));
    }
    scene.close();
  });
}

test('a surface that rests has its pose at any time, normalised; one that does not exist has none', () => {
  const scene = sceneOf({ surfaces: [{ name: 'rest', shape: { sphere: { radius: 0.1 } }, material: 'wood', position: [1, 2, 3], rotation: [0, 2, 0, 0] }] });
  const pose = scene.poseOf(0, 7, { position: [], rotation: [] });
  assert.deepEqual(pose, { position: [1, 2, 3], rotation: [0, 1, 0, 0] });
  assert.throws(() => scene.poseOf(1, 0, pose));
  scene.close();
  assert.throws(() => scene.poseOf(0, 0, pose), /closed/);
});
