import assert from 'node:assert/strict';
import { chmodSync, mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { longTestsOf } from '../../scripts/lib/long_tests.mjs';
import { leftOut } from '../../scripts/lib/platform_tests.mjs';
import { CommandError, inRepository } from '../../scripts/lib/process.mjs';
import { complaintsAboutCore, withoutReadOnlyMarks } from '../../scripts/lib/runtime_tests.mjs';
import { closingLine, countsOfJunit, countsOfTap, countsOfTrx, exitCodeOf, filterOf, judged, judgePrograms, results, runRunners } from '../../scripts/lib/test_results.mjs';
import { chosenRunners, nativePrograms, purposesOf, runners, sanitized } from '../../scripts/lib/test_runners.mjs';

// How `./run test` runs its runners and sums what they found.
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
    isBeside: () => false,
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

test('a runner that may run beside another begins before that one has ended', async () => {
  const told = [];
  const { rows } = await runRunners(['native', 'training', 'package', 'web'], {
    isBeside: (name) => runners[name].isBeside ?? false,
    needsSdk: () => false,
    bringSdk: async () => {},
    execute: async (name) => {
      told.push(`${name} begins`);
      await new Promise((resolve) => { setTimeout(resolve, 5); });
      told.push(`${name} ends`);
      return counts(1, 0, 0);
    },
  });
  assert.deepEqual(told, ['native begins', 'native ends', 'training begins', 'package begins', 'training ends', 'package ends', 'web begins', 'web ends']);
  assert.equal(rows.length, 4);
});

test('the default form runs no long runner and installs no cross compiler, the long form runs all, --only the named one', () => {
  assert.deepEqual(chosenRunners({ all: false }), ['native', 'training', 'package', 'dotnet', 'web']);
  assert.deepEqual(chosenRunners({ all: true }), Object.keys(runners));
  assert.deepEqual(chosenRunners({ only: 'platforms', all: false }), ['platforms']);
  assert.throws(() => chosenRunners({ only: 'nothing', all: false }), /--only nothing: expected one of native,/);
  for (const name of chosenRunners({ all: false })) assert.ok(!purposesOf(name, false).includes('platforms'), name);
  assert.ok(purposesOf('sanitizers', true).includes('realtime') && !purposesOf('sanitizers', false).includes('realtime'));
});

/** The text of every file of the native tests with this ending. */
const nativeTexts = (ending) => readdirSync(inRepository('Tests', 'Native'), { recursive: true })
  .filter((file) => file.endsWith(ending)).map((file) => readFileSync(inRepository('Tests', 'Native', file), 'utf8'));

test('every native test program is run, and every pattern that chooses or leaves out native tests names one', { skip: process.platform !== 'linux' || process.arch !== 'x64' }, () => {
  const built = nativeTexts('CMakeLists.txt').flatMap((text) => [...text.matchAll(/haptoflow_add_test\(\s*(\w+)_tests\b/g)].map(([, name]) => name));
  assert.deepEqual([...nativePrograms()].sort(), built.sort());
  const found = nativeTexts('_test.cpp').flatMap((text) => [...text.matchAll(/^TEST(_F|_P)?\(\s*(\w+),\s*(\w+)/gm)]);
  // Only the running program knows the whole name of a test with parameters, so a pattern may name its suite.
  const names = found.map(([, kind, suite, name]) => ({ suite, name: `${suite}.${name}`, hasValues: kind === '_P' }));
  const patterns = [...sanitized.flatMap(({ tests = [], except = [] }) => [...tests, ...except]), ...longTestsOf('native'), ...Object.values(leftOut).flat().flatMap(({ tests }) => tests)];
  const expression = (pattern) => new RegExp(`^${pattern.replaceAll('.', '\\.').replaceAll('*', '.*')}$`);
  const isOf = (pattern) => {
    const [, plain] = /^(?:\w+\/)?(.*)$/.exec(pattern);
    return names.some(({ suite, name, hasValues }) => expression(plain).test(name) || (hasValues && expression(plain.split('.')[0]).test(suite)));
  };
  assert.deepEqual(patterns.filter((pattern) => !isOf(pattern)), []);
});

/** The metadata of an assembly with two streams and these signatures. */
function assembly(...signatures) {
  const entries = [[], ...signatures].map((bytes) => Buffer.from([bytes.length, ...bytes]));
  const heap = Buffer.concat(entries);
  const version = Buffer.from('v4.0.30319\0\0');
  const root = Buffer.alloc(16);
  root.write('BSJB');
  root.writeUInt32LE(version.length, 12);
  const headers = Buffer.alloc(4 + 12 + 16);
  headers.writeUInt16LE(2, 2);
  headers.write('#~\0\0', 4 + 8);
  const offset = root.length + version.length + headers.length;
  headers.writeUInt32LE(offset, 4);
  headers.writeUInt32LE(offset, 16);
  headers.writeUInt32LE(heap.length, 20);
  headers.write('#Blob\0\0\0', 24);
  return { bytes: Buffer.concat([Buffer.from('code'), root, version, headers, heap]), at: 4 + offset + 1 };
}

test('a signature "instance !0 modreq(X)& get_Item(int)" loses its mark, and no other signature changes', () => {
  const marked = [0x20, 1, 0x1f, 0x12, 0x10, 0x13, 0, 0x08];
  const markedWide = [0x20, 0, 0x1f, 0x81, 0x09, 0x10, 0x13, 0];
  const plain = [0x20, 1, 0x10, 0x13, 0, 0x08];
  const setter = [0x20, 1, 0x1f, 0x12, 0x01, 0x08];
  const { bytes, at } = assembly(marked, plain, setter, markedWide);
  const before = Buffer.from(bytes);
  assert.equal(withoutReadOnlyMarks(bytes), 2);
  assert.deepEqual([...bytes.subarray(at, at + 7)], [6, ...plain]);
  const last = at + 9 + 7 + 7;
  assert.deepEqual([...bytes.subarray(last, last + 6)], [5, 0x20, 0, 0x10, 0x13, 0]);
  assert.deepEqual(bytes.subarray(0, at), before.subarray(0, at));
  assert.deepEqual(bytes.subarray(at + 9, last), before.subarray(at + 9, last));
});

test('only complaints about the core count, each once', () => {
  const core = '/x/HaptoFlow.Core.dll : warning IL2104: Assembly \'HaptoFlow.Core\' produced trim warnings.';
  const source = '/x/Packages/com.haptoflow.runtime/Runtime/Core/A.cs(3): Trim analysis warning IL2026: uses reflection';
  const others = 'ILC : warning IL3000: NUnit.Framework\n/x/Newtonsoft.Json.dll : warning IL2104: Assembly\nHaptoFlow.Core -> HaptoFlow.Core.dll';
  assert.deepEqual(complaintsAboutCore([others, core, core, source].join('\n')), [core, source]);
  assert.deepEqual(complaintsAboutCore(others), []);
});

test('bytes that are no assembly are refused', () => {
  assert.throws(() => withoutReadOnlyMarks(Buffer.from('MZ')), /no \.NET metadata/);
});
