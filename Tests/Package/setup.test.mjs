// What set-up installs.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { chmodSync, existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { bringDotnet, dotnetEnvironment, findDotnet, missingFromLock, missingPackages, offeredPackages, selectPackages } from '../../scripts/lib/setup.mjs';

test('the demo installs no PyTorch, no test library and no cross compiler', () => {
  for (const name of selectPackages(['build', 'drawings'])) assert.doesNotMatch(name, /torch|gtest|mingw|aarch64|wine|clang/);
});

test('a purpose that does not exist is an error', () => {
  assert.throws(() => selectPackages(['tset']), /"tset"/);
});

test('only packages that dpkg does not list as installed are missing', () => {
  const listing = 'cmake installed\nninja-build config-files\n';
  assert.deepEqual(missingPackages(['cmake', 'ninja-build', 'g++'], listing), ['ninja-build', 'g++']);
});

test('npm packages are missing where absent or of another version than the lock says', () => {
  const lock = {
    packages: {
      '': { name: 'root' },
      'node_modules/a': { version: '1.0.0' },
      'node_modules/b': { version: '2.0.0' },
      'node_modules/linked': { resolved: 'Packages/linked', link: true },
      'node_modules/only-elsewhere': { version: '3.0.0', optional: true },
      'Packages/linked': { version: '0.1.0' },
    },
  };
  const installed = { 'node_modules/a': '1.0.0', 'node_modules/b': '1.9.0', 'node_modules/linked': '0.1.0' };
  assert.deepEqual(missingFromLock(lock, (location) => installed[location] ?? null), ['node_modules/b']);
  assert.deepEqual(missingFromLock(lock, () => null), ['node_modules/a', 'node_modules/b', 'node_modules/linked']);
});

test('the lock file names no host and pins every development package to one version', () => {
  const lock = JSON.parse(readFileSync(inRepository('package-lock.json'), 'utf8'));
  // Where an author takes donations is no host that packages come from.
  for (const each of Object.values(lock.packages)) delete each.funding;
  assert.doesNotMatch(JSON.stringify(lock), /https?:/);
  const { devDependencies } = JSON.parse(readFileSync(inRepository('package.json'), 'utf8'));
  for (const [name, version] of Object.entries(devDependencies)) assert.match(version, /^\d+\.\d+\.\d+$/, name);
});

test('a package is offered where apt names a candidate version', () => {
  const policy = [
    'clang-22:', '  Installed: (none)', '  Candidate: 1:22.1.8-1~deb12u1', '  Version table:', '     1:22.1.8 500',
    'libclang-rt-22-dev:', '  Installed: (none)', '  Candidate: (none)', '  Version table:',
    'git:', '  Installed: 1:2.39', '  Candidate: 1:2.39', '',
  ].join('\n');
  assert.deepEqual(offeredPackages(['clang-22', 'libclang-rt-22-dev', 'git', 'unknown'], policy), ['clang-22', 'git']);
  assert.deepEqual(offeredPackages(['git'], ''), []);
});

test('every package of the lock file runs on the Node that the README asks for', () => {
  const [, oldest] = readFileSync(inRepository('README.md'), 'utf8').match(/Node (\d+)\.\d+/);
  const { packages } = JSON.parse(readFileSync(inRepository('package-lock.json'), 'utf8'));
  const tooNew = Object.entries(packages).filter(([, { engines }]) => engines?.node).filter(([, { engines }]) => {
    const lowest = engines.node.split('||').map((range) => Number(range.match(/\d+/)?.[0] ?? 0));
    return Math.min(...lowest) > Number(oldest);
  });
  assert.deepEqual(tooNew.map(([name, { engines }]) => `${name} needs Node ${engines.node}`), []);
});

const posixOnly = process.platform === 'win32' ? 'the programs of this test are shell scripts' : false;
const sdk = (version) => `test "$1" = --list-sdks && echo "${version} [/somewhere]"`;

/** Runs a function on a simulated machine that has only the given programs: name -> shell text. `log` holds what they wrote. */
async function onMachine(programs, act) {
  const root = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-dotnet-'));
  try {
    const bin = path.join(root, 'bin');
    mkdirSync(bin);
    for (const tool of ['sh', 'bash', 'mkdir', 'chmod', 'cat', 'env']) {
      symlinkSync(spawnSync('sh', ['-c', `command -v ${tool}`], { encoding: 'utf8' }).stdout.trim(), path.join(bin, tool));
    }
    for (const [name, text] of Object.entries(programs)) {
      writeFileSync(path.join(bin, name), `#!/bin/sh\n${text}\n`);
      chmodSync(path.join(bin, name), 0o755);
    }
    const log = path.join(root, 'log');
    const folder = path.join(root, 'build', 'dotnet');
    const notes = () => (existsSync(log) ? readFileSync(log, 'utf8') : '');
    return await act({ place: { folder, env: { PATH: bin, BIN: bin, LOG: log } }, folder, notes });
  } finally {
    rmSync(root, { recursive: true, force: true });
  }
}

const noApt = 'echo "N: Unable to locate package"';
const aptOffers = 'printf "dotnet-sdk-10.0:\\n  Installed: (none)\\n  Candidate: 10.0.1\\n  Version table:\\n"';
const aptInstalls = 'echo "apt $*" >> $LOG; printf "#!/bin/sh\\n%s\\n" \'echo "10.0.100 [/x]"\' > $BIN/dotnet; chmod +x $BIN/dotnet';
// A stand-in for Microsoft's script that logs its arguments and puts an SDK into the folder named in them.
const curlBrings = `echo "curl $*" >> $LOG
while [ $# -gt 1 ]; do [ "$1" = -o ] && to="$2"; shift; done
cat > "$to" <<'SCRIPT'
echo "script $*" >> $LOG
while [ $# -gt 1 ]; do [ "$1" = --install-dir ] && to="$2"; shift; done
printf '#!/bin/sh\\necho "10.0.203 [/y]"\\n' > "$to/dotnet"
chmod +x "$to/dotnet"
SCRIPT`;

test('an SDK 10 on PATH is used and nothing is installed', { skip: posixOnly }, () =>
  onMachine({ dotnet: sdk('10.0.401'), 'apt-cache': aptOffers, 'apt-get': aptInstalls, curl: curlBrings }, async ({ place, notes }) => {
    assert.equal(await bringDotnet({ ...place, asRoot: [] }), 'dotnet');
    assert.equal(notes(), '');
  }));

test('an older SDK is not used, and apt installs the right one where it offers it', { skip: posixOnly }, () =>
  onMachine({ dotnet: sdk('8.0.100'), 'apt-cache': aptOffers, 'apt-get': aptInstalls, curl: curlBrings }, async ({ place, notes }) => {
    assert.equal(findDotnet(place), null);
    assert.equal(await bringDotnet({ ...place, asRoot: [] }), 'dotnet');
    assert.match(notes(), /^apt install .*dotnet-sdk-10\.0$/m);
    assert.doesNotMatch(notes(), /curl/);
  }));

test('without an offer of apt the install script puts the SDK into the folder, without root, and it is used from there', { skip: posixOnly }, () =>
  onMachine({ 'apt-cache': noApt, 'apt-get': aptInstalls, curl: curlBrings }, async ({ place, folder, notes }) => {
    const brought = await bringDotnet({ ...place, asRoot: null });
    assert.equal(brought, path.join(folder, 'dotnet'));
    assert.match(notes(), /^curl .*https:\/\/dot\.net\/v1\/dotnet-install\.sh$/m);
    assert.match(notes(), new RegExp(`^script --channel 10\\.0 --install-dir ${folder} --no-path$`, 'm'));
    assert.doesNotMatch(notes(), /^apt /m);
    assert.equal(findDotnet(place), brought);
    assert.equal(dotnetEnvironment(brought).DOTNET_ROOT, folder);
    const again = await bringDotnet({ ...place, asRoot: null });
    assert.equal(again, brought);
    assert.equal(notes().match(/^curl/gm).length, 1);
  }));

for (const [what, curl] of [['cannot be fetched', 'echo "curl: (6) Could not resolve host: dot.net" >&2; exit 6'], ['fails', curlBrings.replace('echo "script', 'echo "no space left"; exit 1; echo "script')]]) {
  test(`where apt has none and the script ${what} one line gives the reasons and the command to run`, { skip: posixOnly }, () =>
    onMachine({ 'apt-cache': noApt, curl }, async ({ place, folder }) => {
      await assert.rejects(bringDotnet({ ...place, asRoot: [] }), (error) => {
        assert.equal(error.exitCode, 2);
        assert.doesNotMatch(error.message, /\n/);
        assert.match(error.message, /apt has no dotnet-sdk-10\.0; Microsoft's install script (cannot be fetched: curl: \(6\)|ended with 1: no space left)/);
        assert.ok(error.message.endsWith(`curl -fsSL https://dot.net/v1/dotnet-install.sh | bash -s -- --channel 10.0 --install-dir ${folder}`));
        return true;
      });
    }));
}
