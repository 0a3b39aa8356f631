import assert from 'node:assert/strict';
import { chmodSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { filterOf, judgePrograms, results } from '../../scripts/lib/test_results.mjs';

const posixOnly = process.platform === 'win32' ? 'the stand-in is a shell script' : false;

/** Judges a shell script as a GoogleTest program in two shares; $1 is the filter and $xml the result's file. */
async function judge(script, cores = 2) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-gtest-'));
  const name = path.basename(folder);
  const silenced = console.error;
  try {
    const file = path.join(folder, 'program');
    writeFileSync(file, `#!/bin/sh\nxml="\${3#--gtest_output=xml:}"\n${script}\n`);
    chmodSync(file, 0o755);
    console.error = () => {};
    return await judgePrograms([{ name, file, tests: ['A.*'], except: ['A.Slow*'] }], cores);
  } finally {
    console.error = silenced;
    rmSync(folder, { recursive: true, force: true });
    for (let share = 0; share < cores; share += 1) rmSync(results(`${name}-${share}.xml`), { force: true });
  }
}

const wrote = (tests, failures) => `echo '<testsuite tests="${tests}" failures="${failures}" disabled="0" errors="0">' > "$xml"`;

test('a filter names the tests to run, then those to leave out', () => {
  assert.equal(filterOf({}), '*');
  assert.equal(filterOf({ tests: ['A.*', 'B.*'], except: ['A.Slow'] }), 'A.*:B.*-A.Slow');
});

test('each core runs its own share of a program, and their counts are summed', { skip: posixOnly }, async () => {
  const script = `test "$1" = '--gtest_filter=A.*-A.Slow*' && test "$GTEST_TOTAL_SHARDS" = 2 && if test "$GTEST_SHARD_INDEX" = 0; then ${wrote(3, 0)}; else ${wrote(2, 0)}; fi`;
  assert.deepEqual(await judge(script), { passed: 5, failed: 0, skipped: 0 });
});

test('a failed test is counted once', { skip: posixOnly }, async () => {
  const script = `if test "$GTEST_SHARD_INDEX" = 0; then ${wrote(3, 1)}; exit 1; else ${wrote(2, 0)}; fi`;
  assert.deepEqual(await judge(script), { passed: 4, failed: 1, skipped: 0 });
});

test('a program that crashes before it writes its results has failed', { skip: posixOnly }, async () => {
  assert.equal((await judge('kill -SEGV $$')).failed, 2);
});

test('a share without tests is fine where another share has some, and a program without any has failed', { skip: posixOnly }, async () => {
  const script = `if test "$GTEST_SHARD_INDEX" = 0; then ${wrote(1, 0)}; else ${wrote(0, 0)}; fi`;
  assert.deepEqual(await judge(script), { passed: 1, failed: 0, skipped: 0 });
  assert.equal((await judge(wrote(0, 0))).failed, 1);
});
