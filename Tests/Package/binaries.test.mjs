// What a library exports, and what it needs of the system that loads it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { committedPlatforms, declaredNames, fileInPackage } from '../../scripts/lib/libraries.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { onDebian } from '../../scripts/lib/setup.mjs';
import { isNewerThan, neededGlibc, needsLibrary } from '../../scripts/pack/binaries.mjs';
import { findNatives, oldestGlibc } from '../../scripts/pack/natives.mjs';
import { elfOf } from './support/elf.mjs';

test('the library must export the functions of the header and the entry that Unity looks up', () => {
  const header = 'HAPTOFLOW_API const char* haptoflow_version(void);\n\nHAPTOFLOW_API haptoflow_status\nhaptoflow_panic(void);\n';
  assert.deepEqual(declaredNames(header), ['UnityGetAudioEffectDefinitions', 'haptoflow_panic', 'haptoflow_version']);
  const real = readFileSync(inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h'), 'utf8');
  assert.equal(declaredNames(real).length, real.match(/^HAPTOFLOW_API /gm).length + 1);
});

// What a Linux library needs of the system that loads it.
const isOfGlibc = ({ platform }) => platform.kind.startsWith('elf-');
const inGit = committedPlatforms.map((platform) => ({ platform, file: fileInPackage(platform), where: 'in git' })).filter(isOfGlibc);
const built = findNatives().found.map((each) => ({ ...each, where: 'built here' })).filter(isOfGlibc);
const onDebian12 = onDebian() && readFileSync('/etc/debian_version', 'utf8').startsWith('12.');

for (const { platform, file, where } of [...inGit, ...built]) {
  test(`the library of ${platform.name} that is ${where} needs no newer glibc than ${oldestGlibc.join('.')}, and no C++ library`, { skip: where === 'built here' && !onDebian12 && 'only Debian 12 builds libraries of a release' }, () => {
    const bytes = readFileSync(file);
    const glibc = neededGlibc(bytes);
    assert.ok(!isNewerThan(glibc, oldestGlibc), `needs ${glibc.join('.')}`);
    // Before glibc 2.34 the functions of these two were not in libc.
    for (const name of ['libc.so.6', 'libpthread.so.0', 'libdl.so.2']) assert.ok(needsLibrary(bytes, name), name);
    assert.ok(!needsLibrary(bytes, 'libstdc++.so.6'));
  });
}

test('the newest version of glibc that a library wants is compared by its numbers, not by its letters', () => {
  assert.deepEqual(neededGlibc(elfOf({ machine: 62, versions: ['GLIBC_2.4', 'GLIBC_2.30', 'GLIBC_2.2.5', 'GLIBCXX_3.4.29', 'GLIBC_PRIVATE'] })), [2, 30]);
  assert.equal(neededGlibc(elfOf({ machine: 183, libraries: ['libc.so'], versions: ['LIBC'] })), null);
  assert.ok(isNewerThan([2, 34], oldestGlibc) && isNewerThan([3, 0], oldestGlibc));
  assert.ok(!isNewerThan([2, 31], oldestGlibc) && !isNewerThan([2, 9], oldestGlibc) && !isNewerThan([1, 99], oldestGlibc));
});
