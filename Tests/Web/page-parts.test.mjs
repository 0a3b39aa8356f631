import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { largestForceNewtons, penForce, Press } from '../../Web/page/table/press.mjs';
import { presetStrokes, secondsOf, strokeAt } from '../../Web/page/table/preset-strokes.mjs';
import { Spectrum } from '../../Web/page/spectrum.mjs';
import { strokeTable, wavBytes } from '../../Web/page/recorder.mjs';
import { orientationOf } from '../../Web/page/table/hand.mjs';
import { highestAt, topOf } from '../../Web/page/table/tops.mjs';
import { repository } from './support/engine.mjs';

const read = (name) => JSON.parse(readFileSync(path.join(repository, 'Web', 'page', 'table', name), 'utf8'));
const scene = read('workbench.json');
const looks = read('looks.json');
const tops = scene.surfaces.map(topOf);
const tipRadius = scene.stylus.tip_radius;
const near = (value, expected, tolerance = 1e-9) => assert.ok(Math.abs(value - expected) <= tolerance, `${value} and ${expected}`);
const nameAt = (x, z) => tops[highestAt(tops, x, z, tipRadius).index]?.name;

test('the table has at least eight labels, one curved, one moving, one turned, and two materials side by side', () => {
  const labels = new Set(scene.surfaces.map(({ material }) => material));
  assert.ok(labels.size >= 8, `${labels.size}`);
  assert.ok(tops.some(({ kind }) => kind !== 'box'));
  assert.ok(tops.some(({ isMoving }) => isMoving));
  assert.ok(scene.surfaces.some(({ material, rotation }) => material === 'corduroy' && rotation));
  const mosaic = scene.surfaces.filter(({ name }) => name.startsWith('mosaic'));
  assert.equal(new Set(mosaic.map(({ material }) => material)).size, 2);
});

test('every surface and every label of the scene has a look', () => {
  for (const { name, material } of scene.surfaces) {
    assert.ok(looks.surfaces[name]?.title, name);
    assert.ok(looks.labels[material]?.colour, material);
  }
});

test('a tip rests on what lies above the desk, and on nothing beside the table', () => {
  near(highestAt(tops, -0.185, 0.112, tipRadius).height, 0.003 + tipRadius);
  assert.equal(nameAt(-0.185, 0.112), 'glass plate');
  assert.equal(nameAt(-0.125, 0.06), 'desk');
  near(highestAt(tops, 0.185, 0.112, tipRadius).height, 0.02 + tipRadius);
  assert.equal(nameAt(0.4, 0), undefined);
});

test('a tip rolls over a rim without a jump', () => {
  let before = highestAt(tops, 0.12, 0, tipRadius).height;
  for (let x = 0.12; x < 0.15; x += 1e-5) {
    const { height } = highestAt(tops, x, 0, tipRadius);
    assert.ok(height >= before - 1e-12);
    before = height;
  }
  near(before, 0.004 + tipRadius);
});

test('a turned box is where its corners are', () => {
  const swatch = topOf({ name: 'swatch', shape: { box: { size: [0.2, 0.002, 0.02] } }, rotation: [0, Math.sin(-Math.PI / 12), 0, Math.cos(Math.PI / 12)], material: 'corduroy' });
  // Unity's left-handed y: a turn by -30 degrees takes x to (cos 30, 0, sin 30).
  const [x, z] = [0.09 * Math.cos(Math.PI / 6), 0.09 * Math.sin(Math.PI / 6)];
  assert.equal(highestAt([swatch], x, z, 0.001).index, 0);
  assert.equal(highestAt([swatch], x, -z, 0.001).index, -1);
});

test('a press begins light, reaches the chosen force, grows while it is still, and stays within its limit', () => {
  const press = new Press();
  press.begin();
  assert.ok(press.force(0, 0.1, 0.8) < 0.4);
  near(press.force(0.1, 0.1, 0.8), 0.8);
  near(press.force(1, 0.1, 0.8), 0.8);
  near(press.force(0.5, 0, 0.8), 1.3);
  near(press.force(10, 0, 0.8), largestForceNewtons);
  press.begin();
  near(press.force(1, 0.1, 0.8), 0.8);
});

test('a pen presses by its own pressure', () => {
  near(penForce(1), largestForceNewtons);
  assert.ok(penForce(0) > 0);
  near(penForce(0.5), largestForceNewtons / 2);
});

test('preset strokes begin and end at rest, stay on the table, and pass over what they name', () => {
  for (const stroke of presetStrokes) {
    const seconds = secondsOf(stroke, 1);
    const places = Array.from({ length: 400 }, (_, index) => strokeAt(stroke, (index * seconds) / 400, 1));
    assert.ok(places.every(({ x, z }) => Math.abs(x) < 0.25 && Math.abs(z) < 0.175), stroke.name);
    const first = strokeAt(stroke, 0.01, 1);
    assert.ok(Math.hypot(first.x - stroke.from[0], first.z - stroke.from[1]) < 1e-3, stroke.name);
    assert.equal(strokeAt(stroke, seconds + 0.01, 1).isTouching, false);
  }
  const across = presetStrokes[0];
  const names = new Set(Array.from({ length: 300 }, (_, index) => strokeAt(across, index / 100, 1)).map(({ x, z }) => nameAt(x, z)));
  for (const name of ['metal rod', 'sliding grille', 'stone tile', 'desk']) assert.ok(names.has(name), name);
});

test('the speed scale shortens a stroke and keeps its path', () => {
  const stroke = presetStrokes[1];
  near(secondsOf(stroke, 2), secondsOf(stroke, 1) / 2);
  near(strokeAt(stroke, 0.5, 2).x, strokeAt(stroke, 1, 1).x);
});

test('the spectrum of a sinusoid has its power in its band', () => {
  const spectrum = new Spectrum(256);
  const block = Float32Array.from({ length: 256 }, (_, index) => 0.5 * Math.sin((2 * Math.PI * 20 * index) / 256));
  const bands = new Float32Array(128);
  spectrum.power(block, bands);
  assert.equal(bands.indexOf(Math.max(...bands)), 20);
  near(bands.reduce((sum, power) => sum + power, 0), 0.125, 1e-3);
});

test('a WAV file states its rate and its samples', () => {
  const bytes = Buffer.from(wavBytes(Float32Array.of(0, 0.5, -1), 48000));
  assert.equal(bytes.readUInt32LE(24), 48000);
  assert.equal(bytes.readUInt32LE(54), 12);
  assert.equal(bytes.readFloatLE(62), 0.5);
  assert.equal(bytes.length, 70);
});

test('a stroke table has orientations only where every row has one', () => {
  const row = { timeSeconds: 1.5, positionMetres: [0.1, 0.002, -0.05], forceNewtons: 0.8, orientation: null };
  assert.equal(strokeTable([row]), 't,x,y,z,force\n1.5,0.1,0.002,-0.05,0.8\n');
  assert.equal(strokeTable([{ ...row, orientation: [0, 0, 0, 1] }]), 't,x,y,z,force,qx,qy,qz,qw\n1.5,0.1,0.002,-0.05,0.8,0,0,0,1\n');
  assert.ok(strokeTable([row, { ...row, orientation: [0, 0, 0, 1] }]).startsWith('t,x,y,z,force\n'));
});

test('a pen that leans to the right points its axis to the right', () => {
  const [x, y, z, w] = orientationOf(30, 0);
  // The y axis turned by a quaternion.
  const up = [2 * (x * y - w * z), 1 - 2 * (x * x + z * z), 2 * (y * z + w * x)];
  near(up[0], Math.sin(Math.PI / 6), 1e-6);
  near(up[1], Math.cos(Math.PI / 6), 1e-6);
});
