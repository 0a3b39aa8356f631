import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { chmodSync, existsSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { findDotnet } from '../../scripts/lib/setup.mjs';
import { CommandError, inRepository } from '../../scripts/lib/process.mjs';
import { exitCodeOf, runRunners } from '../../scripts/lib/test_results.mjs';
import { runners } from '../../scripts/lib/test_runners.mjs';

const names = ['native', 'dotnet', 'package', 'mono'];
const needsSdk = (name) => runners[name].purposes.includes('dotnet');
const unreachable = async () => { throw new CommandError('the .NET SDK 10 could not be installed (apt has none)', 2); };

/** Runs simulated runners, and returns their names in order beside the result. */
async function simulate(bringSdk, execute = async () => ({ passed: 1, failed: 0, skipped: 0 })) {
  const ran = [];
  const run = await runRunners(names, { needsSdk, bringSdk, execute: (name) => (ran.push(name), execute(name)) });
  return { ...run, ran };
}

test('without a reachable SDK every other runner runs, one sentence says which did not and why, and the exit code is 2', async () => {
  const { ran, rows, notRun } = await simulate(unreachable);
  assert.deepEqual(ran, ['native', 'package']);
  assert.deepEqual(rows.map(({ name, passed }) => [name, passed]), [['native', 1], ['package', 1]]);
  assert.equal(notRun, 'not run: dotnet, mono, because the .NET SDK 10 could not be installed (apt has none)');
  assert.equal(exitCodeOf({ failed: 0, notRun }), 2);
});

test('a failed test is exit code 1 also where a runner did not run', () => {
  assert.equal(exitCodeOf({ failed: 3, notRun: 'not run: dotnet' }), 1);
  assert.equal(exitCodeOf({ failed: 3, notRun: null }), 1);
  assert.equal(exitCodeOf({ failed: 0, notRun: null }), 0);
});

test('with the SDK all runners run in their order, and it is brought once, before the first', async () => {
  let brought = 0;
  const { ran, notRun } = await simulate(async () => { brought += 1; });
  assert.deepEqual([ran, notRun, brought], [names, null, 1]);
});

test('a runner that cannot run counts as one failure, and the others run', async () => {
  const { ran, rows } = await simulate(async () => {}, async (name) => {
    if (name === 'dotnet') throw new CommandError('the build fails');
    return { passed: 2, failed: 0, skipped: 0 };
  });
  assert.deepEqual(ran, names);
  assert.deepEqual(rows.map(({ failed }) => failed), [0, 1, 0, 0]);
});

// A machine on which set-up finds its packages, and neither an SDK nor a way to one.
const bareMachine = {
  dotnet: 'exit 1',
  'dpkg-query': '[ "$1" = --version ] && exit; shift 3; for name in "$@"; do echo "$name installed"; done',
  'apt-cache': 'echo "N: Unable to locate package"',
  curl: 'echo "curl: (6) Could not resolve host: dot.net" >&2; exit 6',
};
const ownSdk = existsSync(inRepository('build', 'dotnet', 'dotnet')) && findDotnet();
const skip = process.platform !== 'linux' ? 'the machine of this test is a Debian' : ownSdk ? 'an SDK lies in build/dotnet' : false;

test('`./run test --only dotnet` on a machine without SDK and network ends with 2 and one sentence, and the summary has it', { skip }, () => {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-test-run-'));
  const summary = inRepository('out', 'test', 'summary.json');
  const before = existsSync(summary) ? readFileSync(summary) : null;
  try {
    for (const tool of ['sh', 'bash', 'mkdir', 'env']) {
      symlinkSync(spawnSync('sh', ['-c', `command -v ${tool}`], { encoding: 'utf8' }).stdout.trim(), path.join(folder, tool));
    }
    for (const [name, text] of Object.entries(bareMachine)) {
      writeFileSync(path.join(folder, name), `#!/bin/sh\n${text}\n`);
      chmodSync(path.join(folder, name), 0o755);
    }
    const ended = spawnSync(process.execPath, [inRepository('scripts', 'test.mjs'), '--only', 'dotnet'], { encoding: 'utf8', env: { PATH: folder } });
    assert.equal(ended.status, 2, ended.stderr);
    assert.match(ended.stdout, /\n0 passed, 0 failed\n$/);
    assert.match(ended.stderr, /^test: not run: dotnet, because the \.NET SDK 10 could not be installed \(apt has no dotnet-sdk-10\.0; .*curl: \(6\).*\n$/);
    assert.match(JSON.parse(readFileSync(summary, 'utf8')).not_run, /^not run: dotnet, because/);
  } finally {
    rmSync(folder, { recursive: true, force: true });
    if (before !== null) writeFileSync(summary, before);
    else rmSync(summary, { force: true });
  }
});
