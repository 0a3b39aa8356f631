// How `./run test` runs its runners and sums what they found.
import assert from 'node:assert/strict';
import { chmodSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { CommandError } from '../../scripts/lib/process.mjs';
import { closingLine, countsOfJunit, countsOfTap, countsOfTrx, exitCodeOf, filterOf, judged, judgePrograms, results, runRunners } from '../../scripts/lib/test_results.mjs';
import { chosenRunners, purposesOf, runners } from '../../scripts/lib/test_runners.mjs';

const posixOnly = process.platform === 'win32' ? 'the stand-in is a shell script' : false;
const counts = (passed, failed, skipped) => ({ passed, failed, skipped });

for (const [what, read, text, expected] of [
  ['ctest\'s JUnit: disabled tests are skipped', countsOfJunit, '<testsuite name="Linux"\n\ttests="9"\n\tfailures="2"\n\tdisabled="1"\n\tskipped="1">', counts(5, 2, 2)],
  ['pytest\'s JUnit: errors have failed', countsOfJunit, '<testsuites><testsuite errors="1" failures="1" skipped="2" tests="10"></testsuite></testsuites>', counts(6, 2, 2)],
  ['node\'s TAP: cancelled tests have failed', countsOfTap, '# tests 5\n# pass 2\n# fail 1\n# cancelled 1\n# skipped 1\n# todo 0\n', counts(2, 2, 1)],
  ['TRX: what neither passed nor was skipped has failed', countsOfTrx, '<Counters total="9" executed="8" passed="5" failed="1" error="1" timeout="1" inconclusive="0" />', counts(5, 3, 1)],
  ['TRX: NUnit\'s explicit tests are skipped', countsOfTrx, '<Counters total="240" executed="239" passed="239" failed="0" inconclusive="0" notExecuted="0" />', counts(239, 0, 1)],
  ['TRX without counters', countsOfTrx, '<TestRun></TestRun>', counts(0, 0, 0)],
]) {
  test(`results are read: ${what}`, () => assert.deepEqual(read(text), expected));
}

test('a runner has failed that ran nothing, or whose exit code its counts do not explain', () => {
  assert.equal(judged(counts(0, 0, 3), 0).failed, 1);
  assert.equal(judged(counts(7, 0, 0), 139).failed, 1);
  assert.deepEqual(judged(counts(7, 2, 0), 1), counts(7, 2, 0));
});

test('the closing line names skipped tests only where there are some', () => {
  assert.equal(closingLine(counts(3, 0, 0)), '3 passed, 0 failed');
  assert.equal(closingLine(counts(3, 1, 2)), '3 passed, 1 failed, 2 skipped');
});

/** Judges a shell script as a GoogleTest program in two shares; $1 is the filter and $xml the result's file. */
async function judge(script) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-gtest-'));
  const name = path.basename(folder);
  const silenced = console.error;
  try {
    const file = path.join(folder, 'program');
    writeFileSync(file, `#!/bin/sh\nxml="\${3#--gtest_output=xml:}"\n${script}\n`);
    chmodSync(file, 0o755);
    console.error = () => {};
    return await judgePrograms([{ name, file, tests: ['A.*'], except: ['A.Slow*'] }], 2);
  } finally {
    console.error = silenced;
    rmSync(folder, { recursive: true, force: true });
    for (const share of [0, 1]) rmSync(results(`${name}-${share}.xml`), { force: true });
  }
}

test('native programs run in shares whose counts are summed; a crash and a program without tests have failed', { skip: posixOnly }, async () => {
  const wrote = (tests, failures) => `echo '<testsuite tests="${tests}" failures="${failures}" disabled="0" errors="0">' > "$xml"`;
  const shares = (first, second) => `test "$1" = '--gtest_filter=A.*-A.Slow*' && test "$GTEST_TOTAL_SHARDS" = 2 && if test "$GTEST_SHARD_INDEX" = 0; then ${first}; else ${second}; fi`;
  assert.deepEqual(await judge(shares(wrote(3, 0), wrote(2, 0))), counts(5, 0, 0));
  assert.deepEqual(await judge(shares(`${wrote(3, 1)}; exit 1`, wrote(2, 0))), counts(4, 1, 0));
  assert.deepEqual(await judge(shares(wrote(1, 0), wrote(0, 0))), counts(1, 0, 0));
  assert.equal((await judge(wrote(0, 0))).failed, 1);
  assert.equal((await judge('kill -SEGV $$')).failed, 2);
  assert.equal(filterOf({}), '*');
});

test('without a reachable SDK every other runner runs, one sentence says which did not, and the exit code is 2', async () => {
  const ran = [];
  const { rows, notRun } = await runRunners(['native', 'dotnet', 'package', 'mono'], {
    needsSdk: (name) => runners[name].purposes.includes('dotnet'),
    bringSdk: async () => { throw new CommandError('apt has none', 2); },
    execute: async (name) => {
      ran.push(name);
      if (name === 'package') throw new CommandError('the build fails');
      return counts(1, 0, 0);
    },
  });
  assert.deepEqual(ran, ['native', 'package']);
  assert.deepEqual(rows.map(({ name, passed, failed }) => [name, passed, failed]), [['native', 1, 0], ['package', 0, 1]]);
  assert.equal(notRun, 'not run: dotnet, mono, because apt has none');
  assert.deepEqual([exitCodeOf({ failed: 0, notRun }), exitCodeOf({ failed: 3, notRun }), exitCodeOf({ failed: 0, notRun: null })], [2, 1, 0]);
});

test('the default form runs no long runner and installs no cross compiler, the long form runs all, --only the named one', () => {
  assert.deepEqual(chosenRunners({ all: false }), ['native', 'training', 'dotnet', 'package', 'web']);
  assert.deepEqual(chosenRunners({ all: true }), Object.keys(runners));
  assert.deepEqual(chosenRunners({ only: 'platforms', all: false }), ['platforms']);
  assert.throws(() => chosenRunners({ only: 'nothing', all: false }), /--only nothing: expected one of native,/);
  for (const name of chosenRunners({ all: false })) assert.ok(!purposesOf(name, false).includes('platforms'), name);
  assert.ok(purposesOf('sanitizers', true).includes('realtime') && !purposesOf('sanitizers', false).includes('realtime'));
});
