import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { outline, positionAt, rotate } from '../../scripts/demo/geometry.mjs';
import { drawScene } from '../../scripts/demo/scene_drawing.mjs';
import { inRepository } from '../../scripts/lib/repository.mjs';

const path = [
  { timeSeconds: 0, position: [0, 0.1, 0], touching: false },
  { timeSeconds: 1, position: [0.1, 0, 0], touching: true },
];
const still = { position: [0, 0, 0], rotation: [0, 0, 0, 1] };
const fromAbove = ([x, , z]) => [x, z];
const extent = (points, axis) => {
  const values = points.map((point) => point[axis]);
  return Math.round(1e6 * (Math.max(...values) - Math.min(...values))) / 1e6;
};
const crossing = JSON.parse(readFileSync(inRepository('Samples~', 'HeadlessScenes', 'crossing.scene.json'), 'utf8'));

test('markup in names and labels is escaped', () => {
  const surface = { ...still, name: '<script>"&', shape: { sphere: { radius: 0.1 } }, material: '<b>' };
  const drawing = drawScene({ surfaces: [surface] }, path).join('\n');
  assert.ok(!drawing.includes('<script>') && !drawing.includes('<b>'));
  assert.ok(drawing.includes('&lt;script&gt;&quot;&amp;'));
});

test('a quarter turn about y swaps the extents of a box seen from above', () => {
  const box = { ...still, name: 'box', shape: { box: { size: [0.4, 0.1, 0.2] } }, rotation: [0, Math.SQRT1_2, 0, Math.SQRT1_2] };
  const corners = outline(box, fromAbove);
  assert.deepEqual([extent(corners, 0), extent(corners, 1)], [0.2, 0.4]);
});

test('a capsule turned on its side is as long as its height and as wide as its diameter', () => {
  const capsule = { ...still, name: 'roll', shape: { capsule: { radius: 0.05, height: 0.3 } }, rotation: [0, 0, Math.SQRT1_2, Math.SQRT1_2] };
  const corners = outline(capsule, fromAbove);
  assert.deepEqual([extent(corners, 0), extent(corners, 1)], [0.3, 0.1]);
});

test('a quarter turn about z takes x to y', () => {
  const turned = rotate([0, 0, Math.SQRT1_2, Math.SQRT1_2], [1, 0, 0]);
  [0, 1, 0].forEach((value, axis) => assert.ok(Math.abs(turned[axis] - value) < 1e-12));
});

test('a looped motion passes through its keyframes and begins again', () => {
  const keyframes = [[0, 0], [0.5, 0.1], [1, 0]].map(([t, x]) => ({ t, position: [x, 0, 0] }));
  const surface = { name: 'plate', shape: { sphere: { radius: 0.1 } }, motion: { keyframes, loop: true } };
  for (const [time, x] of [[0, 0], [0.5, 0.1], [1, 0], [2.5, 0.1]]) {
    assert.ok(Math.abs(positionAt(surface, time)[0] - x) < 1e-9, `at ${time} s`);
  }
});

test('a shape that the drawing does not know is named in the error', () => {
  const surface = { ...still, name: 'bunny', shape: { mesh: {} }, material: 'stone' };
  assert.throws(() => drawScene({ surfaces: [surface] }, path), /surface "bunny": the drawing knows box/);
});

test('the crossing scene is drawn twice, with every label, the start and a moving object', () => {
  const drawing = drawScene(crossing, path).join('\n');
  assert.equal(drawing.match(/<svg /g).length, 2);
  for (const label of ['plywood', 'wood', 'stone', 'metal mesh', 'sandpaper', 'corduroy', 'brick + concrete']) {
    assert.ok(drawing.includes(label), label);
  }
  assert.equal(drawing.match(/class="start"/g).length, 2);
  assert.equal(drawing.match(/class="mover"/g).length, 2);
  assert.ok(!/NaN|undefined/.test(drawing));
});
