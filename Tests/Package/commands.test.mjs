// The scripts as somebody types them.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { chmodSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { complaintOfLoading } from '../../scripts/lib/libraries.mjs';
import { callerFolder, inRepository } from '../../scripts/lib/process.mjs';
import { inFolder } from './support/folder.mjs';

const posixOnly = process.platform === 'win32' ? 'run is a POSIX script' : false;
const { scripts } = JSON.parse(readFileSync(inRepository('package.json'), 'utf8'));

/** Runs ./run on a machine that has only the programs given: name -> shell text. */
function onBareMachine(programs, args) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-run-'));
  try {
    for (const tool of ['dirname', 'sed', 'expand', 'env', 'sh', 'cat']) {
      const found = spawnSync('sh', ['-c', `command -v ${tool}`], { encoding: 'utf8' }).stdout.trim();
      if (found.startsWith('/')) symlinkSync(found, path.join(folder, tool));
    }
    for (const [name, text] of Object.entries(programs)) {
      writeFileSync(path.join(folder, name), `#!/bin/sh\n${text}\n`);
      chmodSync(path.join(folder, name), 0o755);
    }
    return spawnSync('/bin/sh', [inRepository('run'), ...args], { encoding: 'utf8', env: { PATH: folder, BIN: folder } });
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

test('without arguments every script is listed in one line, and nothing is installed', { skip: posixOnly }, () => {
  const result = onBareMachine({ 'apt-get': 'echo INSTALLED' }, []);
  assert.equal(result.status, 0, result.stderr);
  assert.ok(!result.stdout.includes('INSTALLED'));
  for (const name of Object.keys(scripts)) assert.match(result.stdout, new RegExp(`^  ${name} +\\w.+$`, 'm'));
});

test('root without Node gets Node from apt-get and the script runs with the arguments', { skip: posixOnly }, () => {
  const install = 'case "$*" in *install*) printf "#!/bin/sh\\ntest \\$1 = -e || echo node \\$*\\n" > $BIN/node; printf "#!/bin/sh\\n" > $BIN/npm; chmod +x $BIN/node $BIN/npm;; esac';
  const chmod = 'exec /bin/chmod "$@"';
  const result = onBareMachine({ id: 'echo 0', 'apt-get': install, chmod }, ['demo', '--flag', 'two words']);
  assert.equal(result.status, 0, result.stderr);
  assert.match(result.stdout, /^node scripts\/demo\.mjs --flag two words$/m);
});

for (const [what, programs, words, message] of [
  ['without root and sudo the one command to type is printed', { id: 'echo 1000', 'apt-get': 'echo INSTALLED', sudo: 'exit 1' }, ['test'], /sudo apt-get update && sudo apt-get install -y .* nodejs npm/],
  ['a Node that is too old counts as missing', { node: 'exit 1', npm: 'echo npm', id: 'echo 1000', 'apt-get': 'echo INSTALLED' }, ['test'], /nodejs npm/],
  ['a script that does not exist is refused before anything is installed', { id: 'echo 0', 'apt-get': 'echo INSTALLED' }, ['dmeo'], /no script "dmeo"/],
]) {
  test(`${what}, and the exit code is 2`, { skip: posixOnly }, () => {
    const result = onBareMachine(programs, words);
    assert.equal(result.status, 2);
    assert.match(result.stderr, message);
    assert.ok(!result.stdout.includes('INSTALLED'));
  });
}

test('every script shows its help with --help and does nothing else', () => {
  for (const name of Object.keys(scripts)) {
    const file = inRepository('scripts', `${name.replace(':', '-')}.mjs`);
    const result = spawnSync(process.execPath, [file, '--help'], { encoding: 'utf8', env: { ...process.env, PATH: '' } });
    assert.equal(result.status, 0, `${name}: ${result.stderr}`);
    assert.match(result.stdout, /^usage: /, name);
    assert.doesNotMatch(result.stdout, /^(setup|build): /m, name);
  }
});

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
  inFolder((folder) => {
    const words = ['train', '--recordings', 'gone', '--labels', 'labels.toml', '--out', 'out'];
    const asked = spawnSync(inRepository('run'), words, { cwd: folder, encoding: 'utf8' });
    assert.equal(asked.status, 3, asked.stderr);
    assert.ok(asked.stderr.includes(`${path.join(folder, 'gone')}: does not exist`), asked.stderr);
  }));

test('a part of the measurements, or another model, is not published', () => {
  for (const words of [['--quick'], ['--only', 'idle'], ['--events', '3'], ['--model', 'm.haptoflow'], ['--no-paper']]) {
    const { status, stderr } = spawnSync(process.execPath, [inRepository('scripts', 'bench.mjs'), '--publish', ...words], { encoding: 'utf8' });
    assert.equal(status, 2, words.join(' '));
    assert.match(stderr, /--publish goes with a whole run/);
  }
});

// What `npm run project` says.
const elsewhere = { skip: process.platform === 'linux' && process.arch === 'x64' ? false : 'its library is that of Linux x64' };

test('this folder is a project whose packages, references and libraries are in place', elsewhere, () => {
  const { status, stdout, stderr } = spawnSync(process.execPath, [inRepository('scripts', 'project.mjs')], { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
  assert.match(stdout, /references are in place[^]*libaudioplugin_haptoflow\.so[^]*load here/);
});

test('a file that the system cannot load is named with the system\'s reason', () => {
  assert.match(complaintOfLoading(inRepository('README.md')), /README\.md|not a valid/);
});
