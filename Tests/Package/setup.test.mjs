import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { missingFromLock, missingPackages, packagesByPurpose, selectPackages } from '../../scripts/lib/packages.mjs';
import { cachedVariable } from '../../scripts/lib/native_build.mjs';
import { inRepository } from '../../scripts/lib/repository.mjs';

test('the demo asks for no Python, no PyTorch, no test library and no cross compiler', () => {
  for (const name of selectPackages(['build'])) assert.doesNotMatch(name, /python|torch|gtest|mingw|aarch64|wine|clang/);
});

test('purposes add up, each package once', () => {
  const selected = selectPackages(['python', 'lint']);
  assert.equal(new Set(selected).size, selected.length);
  for (const name of [...packagesByPurpose.python, ...packagesByPurpose.lint]) assert.ok(selected.includes(name), name);
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

test('a CMake cache variable is read by its exact name', () => {
  const cache = 'HAPTOFLOW_BUILD_TESTS_EXTRA:BOOL=OFF\nHAPTOFLOW_BUILD_TESTS:BOOL=ON\n';
  assert.equal(cachedVariable(cache, 'HAPTOFLOW_BUILD_TESTS'), 'ON');
  assert.equal(cachedVariable('', 'HAPTOFLOW_BUILD_TESTS'), null);
});

test('the lock file names no host and pins every development package to one version', () => {
  const lock = readFileSync(inRepository('package-lock.json'), 'utf8');
  assert.doesNotMatch(lock, /https?:/);
  const { devDependencies } = JSON.parse(readFileSync(inRepository('package.json'), 'utf8'));
  for (const [name, version] of Object.entries(devDependencies)) assert.match(version, /^\d+\.\d+\.\d+$/, name);
});
