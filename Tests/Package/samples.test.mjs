import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const folder = inRepository('Samples~', 'HeadlessScenes');
const read = (name) => readFileSync(`${folder}/${name}`, 'utf8');
const rowsOf = (name) => {
  const [header, ...rows] = read(`${name}.stroke.csv`).trim().split('\n').map((line) => line.split(','));
  return rows.map((row) => Object.fromEntries(header.map((column, place) => [column, row[place]])));
};

test('every scene has a stroke, and every stroke the script it was made from', () => {
  const files = readdirSync(folder);
  const named = (ending) => files.filter((name) => name.endsWith(ending)).map((name) => name.replace(ending, ''));
  assert.deepEqual(named('.scene.json'), ['crossing', 'taps', 'tracing']);
  assert.deepEqual(named('.stroke.csv'), named('.scene.json'));
  assert.deepEqual(named('.stroke.toml'), named('.scene.json'));
});

test('strokes run forward in time at hand speed', () => {
  for (const name of ['crossing', 'taps', 'tracing']) {
    const rows = rowsOf(name).map((row) => [row.t, row.x, row.y, row.z].map(Number));
    const speeds = rows.slice(1).map((row, index) => {
      const [before, elapsed] = [rows[index], row[0] - rows[index][0]];
      assert.ok(elapsed > 0, `${name}: time at row ${index + 2}`);
      return Math.hypot(row[1] - before[1], row[2] - before[2], row[3] - before[3]) / elapsed;
    });
    assert.ok(Math.max(...speeds) < 1.5, `${name}: ${Math.max(...speeds)} m/s`);
  }
});

test('the crossing stroke lasts 8 to 10 seconds and the tracing stroke about 6', () => {
  const seconds = (name) => Number(rowsOf(name).at(-1).t);
  assert.ok(seconds('crossing') >= 8 && seconds('crossing') <= 10, `${seconds('crossing')} s`);
  assert.ok(Math.abs(seconds('tracing') - 6) < 0.2, `${seconds('tracing')} s`);
});

test('a stroke begins where the first way-point of its script is', () => {
  for (const name of ['crossing', 'taps', 'tracing']) {
    const [, waypoint] = read(`${name}.stroke.toml`).match(/waypoints_metres = \[\s*\[([^\]]+)\]/);
    const { x, y, z } = rowsOf(name)[0];
    waypoint.split(',').map(Number).forEach((value, axis) => assert.ok(Math.abs(value - Number([x, y, z][axis])) < 0.001, `${name}: axis ${axis}`));
  }
});

test('the crossing scene shows a moving object, a curved one and a blend', () => {
  const { surfaces } = JSON.parse(read('crossing.scene.json'));
  assert.ok(surfaces.some((surface) => surface.motion?.keyframes.length > 1));
  assert.ok(surfaces.some((surface) => surface.shape.sphere));
  assert.ok(surfaces.some((surface) => typeof surface.material === 'object' && Object.keys(surface.material).length > 1));
});
