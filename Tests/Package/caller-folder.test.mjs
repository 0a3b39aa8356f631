import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, realpathSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { callerFolder, inRepository } from '../../scripts/lib/process.mjs';

const posixOnly = process.platform === 'win32' ? 'run is a POSIX script' : false;

/** Calls a function with a temporary folder outside the repository. */
async function elsewhere(body) {
  const folder = realpathSync(mkdtempSync(path.join(os.tmpdir(), 'haptoflow-caller-')));
  try {
    return await body(folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

test('the folder of the user is npm\'s INIT_CWD, and without npm the current folder', () => {
  const before = process.env.INIT_CWD;
  try {
    process.env.INIT_CWD = os.tmpdir();
    assert.equal(callerFolder(), path.resolve(os.tmpdir()));
    delete process.env.INIT_CWD;
    assert.equal(callerFolder(), process.cwd());
  } finally {
    if (before === undefined) delete process.env.INIT_CWD;
    else process.env.INIT_CWD = before;
  }
});

test('paths of ./run train are relative to the folder of the user', { skip: posixOnly }, () =>
  elsewhere((folder) => {
    const words = ['train', '--recordings', 'gone', '--labels', 'labels.toml', '--out', 'out'];
    const asked = spawnSync(inRepository('run'), words, { cwd: folder, encoding: 'utf8' });
    assert.equal(asked.status, 3, asked.stderr);
    assert.ok(asked.stderr.includes(`${path.join(folder, 'gone')}: does not exist`), asked.stderr);
  }));
