import assert from 'node:assert/strict';
import { test } from 'node:test';
import { inRepository, npmComplaint, run } from '../../scripts/lib/process.mjs';
import { spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';

test('a program that hangs is ended at its limit and counts as failed, and the message states the limit', async () => {
  const hanging = ['-e', 'setInterval(() => {}, 1000)'];
  const { exitCode, output } = await run(process.execPath, hanging, { quiet: true, limitSeconds: 0.3 });
  assert.notEqual(exitCode, 0);
  assert.match(output, /ended after 0\.3 s/);
});

test('a program that ends within its limit is judged by itself', async () => {
  const { exitCode, output } = await run(process.execPath, ['-e', 'console.log("whole")'], { quiet: true, limitSeconds: 30 });
  assert.deepEqual({ exitCode, output }, { exitCode: 0, output: 'whole\n' });
});

test('an unknown option is refused, so that an environment variable given as an option is not lost', () => {
  assert.throws(() => run(process.execPath, ['--version'], { quiet: true, HAPTOFLOW_TEST_CALLBACKS: '1' }), /unknown options HAPTOFLOW_TEST_CALLBACKS/);
});

/** The result of `runNpmOrFail` below a silent npm, with a registry that does not answer. */
function npmWithoutRegistry() {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-npm-'));
  try {
    writeFileSync(path.join(folder, 'package.json'), '{"name": "nothing", "version": "1.0.0", "dependencies": {"no-such-package-here": "1.0.0"}}');
    const module = JSON.stringify(inRepository('scripts', 'lib', 'process.mjs'));
    const program = `import(${module}).then(({ runNpmOrFail }) => runNpmOrFail(['install', '--prefix', ${JSON.stringify(folder)}])).catch((error) => { console.error(error.message); process.exitCode = 9; })`;
    const env = { ...process.env, npm_config_registry: 'http://127.0.0.1:9/', npm_config_loglevel: 'silent', npm_config_fetch_retry_mintimeout: '1', npm_config_fetch_retry_maxtimeout: '1', npm_config_cache: path.join(folder, 'cache') };
    delete env.npm_execpath;
    return spawnSync(process.execPath, ['-e', program], { encoding: 'utf8', env });
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

test('an npm that cannot reach its registry says so with a remedy, even below an npm that runs with --silent', () => {
  const { status, stderr } = npmWithoutRegistry();
  assert.equal(status, 9, stderr);
  assert.match(stderr, /ECONNREFUSED/);
  assert.match(stderr, /`npm install` ended with 1: npm's registry cannot be reached: check the network/);
});

test('an npm that fails for another reason shows its output and the command for more, and one without output says so', () => {
  assert.match(npmComplaint(['ci'], 1, 'npm ERR! lock file is wrong\n'), /^npm ERR! lock file is wrong\n`npm ci` ended with 1: `npm ci --loglevel=verbose` says more$/);
  assert.match(npmComplaint(['ci'], 1, ''), /^npm printed nothing\n/);
});
