import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import test from 'node:test';
import { soakTable } from '../../scripts/lib/measured_part.mjs';
import { modelOfPage } from './support/model_of_page.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';

const modelSha256 = 'e'.repeat(64);
const run = { date: '2026-11-22', machine: 'a machine', modelSha256 };
const loop = (change, fit) => `<testcase name="Stays/0"><properties><property name="level_change_db" value="${change}"/>
<property name="spectrum_gfc" value="${fit}"/></properties></testcase>`;
const suites = (tests, failures, cases = '') => `<testsuites tests="${tests}" failures="${failures}" time="12.6" name="AllTests">
<testsuite name="S" tests="${tests}" failures="${failures}" disabled="0" skipped="0" errors="0">${cases}</testsuite></testsuites>`;

test('the soak\'s table has the worst and the median of the labels, and the size of a change, not its sign', () => {
  const xml = suites(3, 0, loop(-0.31, 0.9991) + loop(0.1, 0.9999) + loop(0.02, 0.9995));
  const table = soakTable([{ about: 'ten minutes on each label', xml }], run);
  assert.match(table, /ten minutes on each label \| 3 of 3 \| 13 \|/);
  assert.match(table, /on 3 labels: level changed by at most 0\.31 dB \(median 0\.10\), .* at least 0\.9991 \(median 0\.9995\)/);
  assert.equal(modelOfPage(table), modelSha256);
});

test('the soak accepts --publish, and an unknown option beside it is named', () => {
  const { status, stderr } = spawnSync(process.execPath, [inRepository('scripts', 'test-soak.mjs'), '--publish', '--publsh'], { encoding: 'utf8' });
  assert.equal(status, 2);
  assert.match(stderr, /'--publsh'/);
  assert.doesNotMatch(stderr, /takes no arguments/);
});
