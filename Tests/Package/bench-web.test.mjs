import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import test from 'node:test';
import { spread, webTables } from '../../scripts/bench/web_tables.mjs';
import { timeOf } from '../../scripts/bench/web_touches.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';

const times = (median) => ({ count: 9, minimum: median, median, percentile99: median, worst: median });
const roundOf = (browser, native, touches) => ({
  touchesMs: { shared: touches, ring: [50] },
  missed: { shared: 1, ring: 0 },
  browser: [{ tier: 'draft', hotMs: times(browser), pacedMs: times(2 * browser) }],
  native: { inference_ms: { draft: { p50: native, paced: { p50: native } } }, onset_ms: { block_frames: 256, count: 60, p50: 2.6, p99: 5.5, worst: 5.6, missed: 0 } },
});

test('ratios are of each round, and the table says their middle and both ends', () => {
  const tables = webTables([roundOf(0.3, 0.1, [1, 2]), roundOf(0.4, 0.2, [3, 9]), roundOf(0.5, 0.1, [4])], { machine: 'here', browserName: 'Chromium', outputLatencyMs: 8, deviceRow: '| mine |' });
  assert.match(tables, /^\| draft \| 0\.40 \| 0\.10 \| 3\.0 \(2\.0 to 5\.0\) \| 0\.80 \| 0\.10 \| 6\.0 \(4\.0 to 10\.0\) \|$/m);
  assert.equal(spread([1, 2, 4, 8]), '2.0 (1.0 to 8.0)');
});

test('no touch is left out: the worst is the worst, and touches without sound are counted', () => {
  const tables = webTables([roundOf(0.3, 0.1, [1, 2]), roundOf(0.3, 0.1, [3, 90])], { machine: 'here', browserName: 'Chromium', outputLatencyMs: 8, deviceRow: '| mine |' });
  assert.match(tables, /shared memory \| 4 \| 2 \| 2\.0 \| 90\.0 \| 90\.0 \|$/m);
  assert.match(tables, /^\| mine \|$/m);
});

test('a touch\'s time is that of its first audible block, and nothing from before the press counts', () => {
  const block = (atMs, peak) => ({ atMs, peak });
  assert.equal(timeOf({ pressedMs: 100, blocks: [block(99, 1), block(101, 0), block(104, 1e-5), block(107, 0.01), block(110, 0.5)] }), 7);
  assert.equal(timeOf({ pressedMs: 100, blocks: [block(99, 1), block(101, 0)] }), null);
});

test('a quick run is not published, and what is no option is named', () => {
  const bench = (...words) => spawnSync(process.execPath, [inRepository('scripts', 'bench-web.mjs'), ...words], { encoding: 'utf8' });
  assert.match(bench('--publish', '--quick').stderr, /--publish goes with a whole run/);
  assert.equal(bench('--publish', '--quick').status, 2);
  assert.match(bench('--qiuck').stderr, /--qiuck/);
  assert.match(bench('--help').stdout, /from a\npointer event to its first sample/);
});
