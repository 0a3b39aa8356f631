import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import * as three from 'three';
import { Bench, geometryOf } from '../../Web/page/xr/bench.mjs';
import { boardTop, strokeOfPaint, swatches, withBoard } from '../../Web/page/xr/board.mjs';
import { mirrorPosition } from '../../Web/page/xr/frames.mjs';
import { wordsOfMaterial, wordsOfPanel } from '../../Web/page/xr/panel.mjs';
import { Rate } from '../../Web/page/xr/report.mjs';
import { repository, sceneOpener } from './support/engine.mjs';

const { open, labels } = await sceneOpener();
const names = labels.map(({ name }) => name);
const jsonOf = (name) => JSON.parse(readFileSync(path.join(repository, 'Web', 'page', 'table', name), 'utf8'));
const workbench = jsonOf('workbench.json');
const looks = { material: (label) => ({ label }) };

/** The first point that a ray from above hits, in the scene's frame. */
function topOf(group, [x, , z]) {
  group.updateMatrixWorld(true);
  const ray = new three.Raycaster(new three.Vector3(x, 1, -z), new three.Vector3(0, -1, 0));
  const [hit] = ray.intersectObjects(group.children);
  return hit && { height: hit.point.y, name: hit.object.name };
}

test('what is seen is what is touched: every object of the workbench is drawn where the contact model has it', () => {
  const vertices = [[-0.05, 0, -0.05], [-0.05, 0, 0.05], [0.05, 0, 0.05], [0.05, 0, -0.05], [-0.05, 0.04, 0]];
  const triangles = [[0, 1, 4], [1, 2, 4], [2, 3, 4], [3, 0, 4], [0, 2, 1], [0, 3, 2]];
  const wedge = { name: 'wedge', material: 'wood', position: [0, 0.1, 0], shape: { mesh: { vertices, triangles } } };
  const meshes = { ...workbench, surfaces: [...workbench.surfaces, wedge] };
  const bench = new Bench({ three, scene: meshes, poses: open(meshes), looks: { material: () => new three.MeshBasicMaterial() } });
  let checked = 0;
  const seen = new Set();
  for (const seconds of [0, 5.1]) {
    bench.update(seconds);
    for (let x = -0.24; x <= 0.24; x += 0.02) {
      for (let z = -0.165; z <= 0.165; z += 0.015) {
        const top = topOf(bench.group, [x, 0, z]);
        const scene = open(meshes);
        const contact = scene.update({ timeSeconds: seconds, positionMetres: [x, top.height - 0.0002, z] });
        assert.equal(contact.touching, true, `${x}, ${z} at ${seconds} s`);
        // Facets of a drawn ball lie a little below the ball itself.
        assert.ok(contact.penetrationMetres < 0.0026, `${top.name} at ${x}, ${z}: ${contact.penetrationMetres}`);
        scene.close();
        seen.add(top.name);
        checked += 1;
      }
    }
  }
  assert.ok(checked > 700);
  assert.deepEqual([...seen].sort(), meshes.surfaces.map(({ name }) => name).sort());
});

test('the shading of a relief lies just above its box, and runs along x and z from the box\'s middle', () => {
  const shading = new three.MeshBasicMaterial();
  const scene = { surfaces: [{ name: 'desk', material: 'wood', shape: { box: { size: [0.5, 0.02, 0.3] } }, position: [0, -0.01, 0] }], stylus: { tip_radius: 0.001 } };
  const bench = new Bench({ three, scene, poses: open(scene), looks: { material: () => new three.MeshBasicMaterial() }, shadings: new Map([['desk', shading]]) });
  bench.group.updateMatrixWorld(true);
  const [face] = bench.group.children[0].children;
  assert.equal(face.material, shading);
  const { position, uv } = face.geometry.attributes;
  for (let index = 0; index < uv.count; index += 1) {
    const place = face.localToWorld(new three.Vector3().fromBufferAttribute(position, index));
    assert.ok(place.y > 0 && place.y < 0.0005);
    // The room's z is the scene's, mirrored.
    assert.ok(Math.abs(uv.getX(index) - place.x) < 1e-6 && Math.abs(uv.getY(index) + place.z) < 1e-6);
  }
});

test('a picture has its true size on every face of a box', () => {
  const { uv, normal } = geometryOf(three, { box: { size: [0.5, 0.02, 0.3] } }).attributes;
  const spans = new Map();
  for (let index = 0; index < uv.count; index += 1) {
    const key = ['x', 'y', 'z'][[normal.getX(index), normal.getY(index), normal.getZ(index)].findIndex((part) => Math.abs(part) > 0.5)];
    const span = spans.get(key) ?? [0, 0];
    spans.set(key, [Math.max(span[0], uv.getX(index)), Math.max(span[1], uv.getY(index))].map((part) => Number(part.toFixed(6))));
  }
  assert.deepEqual(Object.fromEntries(spans), { x: [0.3, 0.02], y: [0.5, 0.3], z: [0.5, 0.02] });
});

test('the board has a swatch of every label behind the workbench, none within another, and the engine takes them all', () => {
  const { scene, objectCount } = withBoard(workbench, names);
  assert.equal(objectCount, workbench.surfaces.length);
  const opened = open(scene);
  assert.equal(opened.surfaces.length, objectCount + names.length);
  swatches(names).forEach(({ position, rotation }, index) => {
    assert.ok(position[2] > 0.2 && position[1] > 0.04);
    // The front faces the viewer and leans back; the tip comes from there.
    const lean = 2 * Math.asin(rotation[0]);
    const outwards = [0, Math.sin(lean), -Math.cos(lean)];
    const front = position.map((part, axis) => part + 0.0039 * outwards[axis]);
    opened.reset();
    const contact = opened.update({ timeSeconds: index, positionMetres: front });
    assert.equal(contact.surfaceName, `swatch of ${names[index]}`);
    assert.ok(contact.normal[2] < -0.5 && contact.normal[1] > 0, `${contact.normal}`);
  });
  assert.ok(boardTop(names.length)[1] > Math.max(...swatches(names).map(({ position }) => position[1])));
});

test('a hand paints the object that it touches with what it took from the board, and nothing else', () => {
  const contact = { surfaceIndex: 2, surfaceName: 'plate' };
  assert.deepEqual(strokeOfPaint(contact, 'glass', 5), { surface: 'plate', material: 'glass' });
  assert.equal(strokeOfPaint(contact, '', 5), null);
  assert.equal(strokeOfPaint(null, 'glass', 5), null);
  assert.equal(strokeOfPaint({ surfaceIndex: 5, surfaceName: 'swatch of wood' }, 'glass', 5), null);
});

test('painting changes the look of that object alone', () => {
  const bench = new Bench({ three, scene: workbench, poses: open(workbench), looks });
  bench.paint('desk', 'glass');
  const lookOf = (name) => bench.group.children.find((mesh) => mesh.name === name).material.label;
  assert.equal(lookOf('desk'), 'glass');
  assert.equal(lookOf('stone tile'), 'stone');
});

test('the panel names the shares of a blend', () => {
  assert.equal(wordsOfMaterial({ wood: 0.25, fur: 0.75 }), '25 % wood, 75 % fur');
  assert.equal(wordsOfMaterial({ wood: 1 }), 'wood');
});

test('the panel says what is felt, at what cost, and why a hand is silent', () => {
  const side = { name: 'Right', device: 'MX Ink', isTracked: true, isTouching: true, silence: 'none', hasMotor: true, forceNewtons: 0.5 };
  const others = [{ isTouching: false, silence: 'rest' }, { silence: 'paused' }, { isTracked: false }, { device: '' }, { hasMotor: false }];
  const sides = [side, ...others.map((change) => ({ ...side, ...change }))];
  const words = wordsOfPanel({ label: 'wood', brush: 'glass', quality: 'draft', segmentMs: 0.4, posesPerSecond: 71.8, sides });
  assert.equal(words.title, 'wood');
  assert.equal(words.cost, 'draft   0.40 ms a segment   72 poses a second');
  assert.match(words.hint, /glass/);
  assert.deepEqual(words.sides, [
    'Right: MX Ink, 0.50 N', 'Right: MX Ink, silent: at rest', 'Right: MX Ink, silent: out of focus', 'Right: MX Ink, not tracked',
    'Right: nothing held', 'Right: MX Ink, 0.50 N, no motor',
  ]);
  assert.match(wordsOfPanel({ sides: [] }).cost, /- ms/);
});

test('a rate is that of the last second', () => {
  const rate = new Rate();
  for (let frame = 0; frame <= 200; frame += 1) rate.update(frame * 10, frame);
  assert.ok(Math.abs(rate.perSecond - 100) < 1e-9);
  assert.deepEqual(mirrorPosition([0, 0, 0], [1, 1, 1]).map(Math.abs), [0, 0, 0]);
});
