import assert from 'node:assert/strict';
import test from 'node:test';
import { closingLine, countsOfJunit, countsOfTap, countsOfTrx, judged } from '../../scripts/lib/test_results.mjs';

test('ctest\'s JUnit file is read, disabled tests counted as skipped', () => {
  const xml = '<?xml version="1.0"?>\n<testsuite name="Linux"\n\ttests="9"\n\tfailures="2"\n\tdisabled="1"\n\tskipped="1"\n\thostname="">';
  assert.deepEqual(countsOfJunit(xml), { passed: 5, failed: 2, skipped: 2 });
});

test('pytest\'s JUnit file is read, errors counted as failed', () => {
  const xml = '<testsuites><testsuite name="pytest" errors="1" failures="1" skipped="2" tests="10" time="1.0"></testsuite></testsuites>';
  assert.deepEqual(countsOfJunit(xml), { passed: 6, failed: 2, skipped: 2 });
});

test('node\'s TAP is read, cancelled tests counted as failed', () => {
  const tap = '# tests 5\n# pass 2\n# fail 1\n# cancelled 1\n# skipped 1\n# todo 0\n';
  assert.deepEqual(countsOfTap(tap), { passed: 2, failed: 2, skipped: 1 });
});

test('a TRX file of dotnet test is read, and tests that neither passed nor were skipped count as failed', () => {
  const trx = '<ResultSummary outcome="Failed">\n<Counters total="9" executed="8" passed="5" failed="1" error="1" timeout="1" aborted="0" ' +
    'inconclusive="0" notExecuted="1" passedButRunAborted="0" /></ResultSummary>';
  assert.deepEqual(countsOfTrx(trx), { passed: 5, failed: 3, skipped: 1 });
});

test('an explicit test of NUnit, executed by name only, counts as skipped', () => {
  const trx = '<Counters total="240" executed="239" passed="239" failed="0" error="0" inconclusive="0" notExecuted="0" />';
  assert.deepEqual(countsOfTrx(trx), { passed: 239, failed: 0, skipped: 1 });
});

test('a TRX file without counters has no tests', () => {
  assert.deepEqual(countsOfTrx('<TestRun></TestRun>'), { passed: 0, failed: 0, skipped: 0 });
});

test('a runner that ran nothing has failed, even with exit code 0', () => {
  assert.equal(judged({ passed: 0, failed: 0, skipped: 3 }, 0).failed, 1);
});

test('a runner with a non-zero exit code has failed, even where every counted test passed', () => {
  assert.equal(judged({ passed: 7, failed: 0, skipped: 0 }, 139).failed, 1);
});

test('a runner whose failures explain its exit code keeps its count', () => {
  assert.deepEqual(judged({ passed: 7, failed: 2, skipped: 0 }, 1), { passed: 7, failed: 2, skipped: 0 });
});

test('the closing line names skipped tests only where there are some', () => {
  assert.equal(closingLine({ passed: 3, failed: 0, skipped: 0 }), '3 passed, 0 failed');
  assert.equal(closingLine({ passed: 3, failed: 1, skipped: 2 }), '3 passed, 1 failed, 2 skipped');
});
