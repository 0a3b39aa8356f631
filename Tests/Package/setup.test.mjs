import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { missingFromLock, missingPackages, offeredPackages, optionalPurposes, packagesByPurpose, selectPackages } from '../../scripts/lib/setup.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';

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

test('the sentence of each optional purpose names its packages and where to get them', () => {
  for (const [purpose, sentence] of Object.entries(optionalPurposes)) {
    assert.ok(packagesByPurpose[purpose].length > 0, purpose);
    assert.match(sentence, /is left out: it needs .+ Debian 12/, purpose);
    for (const name of packagesByPurpose[purpose]) assert.ok(sentence.includes(name), `${purpose}: ${name}`);
  }
});
