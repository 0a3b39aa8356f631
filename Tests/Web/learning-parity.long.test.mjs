import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { learn, render } from '../../Web/engine/js/offline.mjs';
import { coreWithModel, hasCommandLine, native, recording, sample } from './support/engine.mjs';

// Takes half a minute.

/** @type {{share: number, doing: string}[]} */
const reports = [];
const core = await coreWithModel({ onProgress: (share, doing) => reports.push({ share, doing }) });

test('a table is learnt to the command line\'s own material', { skip: !hasCommandLine }, () => {
  const table = recording(11);
  const { material, report } = native(
    (folder) => {
      writeFileSync(path.join(folder, 'rough.csv'), table);
      return ['learn', path.join(folder, 'rough.csv'), '-o', path.join(folder, 'rough.haptomaterial'), '--report', path.join(folder, 'report.json'), '--seconds-limit', '600', '--quiet'];
    },
    (folder) => ({ material: readFileSync(path.join(folder, 'rough.haptomaterial'), 'utf8'), report: JSON.parse(readFileSync(path.join(folder, 'report.json'), 'utf8')) }),
  );
  const learnt = learn(core, { recording: [{ name: 'rough.csv', bytes: new TextEncoder().encode(table) }], secondsLimit: 600 });
  assert.equal(learnt.name, 'rough');
  assert.equal(learnt.report.start_label, report.start_label);
  assert.ok(Math.abs(learnt.report.fitted_distance_db - report.fitted_distance_db) < 0.05);
  assert.ok(Math.abs(learnt.report.level_error_db - report.level_error_db) < 0.05);
  const [web, other] = [learnt.material, material].map((text) => JSON.parse(text).embedding);
  assert.ok(Math.max(...web.map((number, index) => Math.abs(number - other[index]))) < 1e-3);
  assert.ok(reports.length > 3 && reports.every(({ share, doing }) => share >= 0 && share <= 1 && doing !== ''));
  const scene = sample('tracing.scene.json').replace(/"material": "[^"]+"/g, '"material": "rough"');
  const options = { scene, stroke: sample('tracing.stroke.csv'), quality: 'sketch', materials: [learnt.material] };
  assert.ok(render(core, options).samples.some((number) => Math.abs(number) > 0.001));
});
