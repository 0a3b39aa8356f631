import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { benchArguments, withMeasuredTables, withModelSha256 } from '../../scripts/bench/measured_tables.mjs';
import { modelOfPage } from './support/model_of_page.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';

const page = readFileSync(inRepository('Documentation~', 'benchmarks.md'), 'utf8');
const bench = (...words) => spawnSync(process.execPath, [inRepository('scripts', 'bench.mjs'), ...words], { encoding: 'utf8' });

test('published tables replace the text between the page\'s markers and nothing else', () => {
  const once = withMeasuredTables(page, '\nfirst table\n', 'a'.repeat(64));
  const twice = withMeasuredTables(once, '\nsecond table\n', 'b'.repeat(64));
  assert.match(once, /```\nfirst table\n```/);
  assert.match(twice, /```\nsecond table\n```/);
  assert.doesNotMatch(twice, /first table/);
  assert.equal(withMeasuredTables(twice, 'first table', 'a'.repeat(64)), once);
  const outside = (text) => [text.split('<!-- measured: begin')[0], text.split('<!-- measured: end')[1]];
  assert.deepEqual(outside(twice), outside(page));
});

test('the page and the report name the measured model', () => {
  const sha256 = 'c'.repeat(64);
  assert.equal(modelOfPage(withMeasuredTables(page, 'table', sha256)), sha256);
  const report = { model: { name: 'default', crc32: '12' }, onset_ms: { p50: 1 } };
  assert.deepEqual(withModelSha256(report, sha256), { model: { name: 'default', crc32: '12', sha256 }, onset_ms: { p50: 1 } });
});

test('a page without markers is refused', () => {
  assert.throws(() => withMeasuredTables('# Benchmarks\n', 'table', 'a'.repeat(64)), /measured: begin/);
});

test('the page explains every key that bench.json promises', () => {
  const promised = ['callback_us', 'onset_ms', 'contact_to_sound_ms', 'stop_ms', 'inference_ms', 'speedup_vs_paper_architecture', 'voices', 'idle', 'memory_mib', 'load_ms', 'contact'];
  for (const key of promised) assert.match(page, new RegExp(`^\\| \`${key}\` \\| \\S`, 'm'), key);
});

test('options are passed to the command line, and the paper\'s architecture only on request', () => {
  assert.deepEqual(benchArguments({ quick: true, only: 'idle,contact' }, 'r.json', null), ['bench', '--output', 'r.json', '--quick', '--only', 'idle,contact']);
  assert.deepEqual(benchArguments({ events: '5' }, 'r.json', 'p.haptoflow'), ['bench', '--output', 'r.json', '--paper-model', 'p.haptoflow', '--events', '5']);
});

test('an option that does not exist ends with 2 before anything is set up or built', () => {
  const { status, stdout, stderr } = bench('--qiuck');
  assert.equal(status, 2);
  assert.match(stderr, /--qiuck/);
  assert.equal(stdout, '');
});

test('a part of the measurements, or another model, is not published', () => {
  for (const words of [['--quick'], ['--only', 'idle'], ['--events', '3'], ['--model', 'm.haptoflow'], ['--no-paper']]) {
    const { status, stderr } = bench('--publish', ...words);
    assert.equal(status, 2, words.join(' '));
    assert.match(stderr, /--publish goes with a whole run/);
  }
});
