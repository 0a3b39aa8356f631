// What a library exports, and what it needs of the system that loads it.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { committedPlatforms, declaredNames, exportedNames, fileInPackage } from '../../scripts/lib/libraries.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { onDebian } from '../../scripts/lib/setup.mjs';
import { isNewerThan, neededGlibc, needsOf } from '../../scripts/pack/binaries.mjs';
import { findNatives, oldestGlibc } from '../../scripts/pack/natives.mjs';
import { dllOf } from './support/dll.mjs';
import { elfOf, elfWithSymbols } from './support/elf.mjs';

test('the library must export the functions of the header and the entry that Unity looks up', () => {
  const header = 'HAPTOFLOW_API const char* haptoflow_version(void);\n\nHAPTOFLOW_API haptoflow_status\nhaptoflow_panic(void);\n';
  assert.deepEqual(declaredNames(header), ['UnityGetAudioEffectDefinitions', 'haptoflow_panic', 'haptoflow_version']);
  const real = readFileSync(inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h'), 'utf8');
  assert.equal(declaredNames(real).length, real.match(/^HAPTOFLOW_API /gm).length + 1);
});

test('a DLL\'s exported names are read from its bytes, and a DLL that breaks off has none', () => {
  const whole = dllOf(['haptoflow_version', 'a_stray_one']);
  assert.deepEqual(exportedNames(whole), ['a_stray_one', 'haptoflow_version']);
  for (const length of [2, 64, 200, 400]) assert.deepEqual(exportedNames(whole.subarray(0, length)), [], `${length} bytes`);
});

test('an ELF exports the dynamic symbols that have a place in it, and neither its own local ones nor those of other libraries', () => {
  const whole = elfWithSymbols([{ name: 'memcpy', section: 0 }, { name: '.init', section: 9, isLocal: true }, { name: 'haptoflow_version', section: 12 }, { name: 'a_stray_one', section: 9 }]);
  assert.deepEqual(exportedNames(whole), ['a_stray_one', 'haptoflow_version']);
  for (const length of [2, 63, 70, whole.length - 10]) assert.deepEqual(exportedNames(whole.subarray(0, length)), [], `${length} bytes`);
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
    const { libraries, versions } = needsOf(bytes);
    assert.ok(versions.length > 3, versions.join());
    // Before glibc 2.34 the functions of these two were not in libc.
    for (const name of ['libc.so.6', 'libpthread.so.0', 'libdl.so.2']) assert.ok(libraries.includes(name), `${libraries.join()} without ${name}`);
    assert.ok(!libraries.includes('libstdc++.so.6'));
  });
}

test('the newest version of glibc that a library wants is compared by its numbers, not by its letters', () => {
  assert.deepEqual(neededGlibc(elfOf({ machine: 62, versions: ['GLIBC_2.4', 'GLIBC_2.30', 'GLIBC_2.2.5', 'GLIBCXX_3.4.29', 'GLIBC_PRIVATE'] })), [2, 30]);
  assert.equal(neededGlibc(elfOf({ machine: 183, libraries: ['libc.so'], versions: ['LIBC'] })), null);
  assert.ok(isNewerThan([2, 34], oldestGlibc) && isNewerThan([3, 0], oldestGlibc));
  assert.ok(!isNewerThan([2, 31], oldestGlibc) && !isNewerThan([2, 9], oldestGlibc) && !isNewerThan([1, 99], oldestGlibc));
});

test('a file that breaks off, or has no dynamic section, needs nothing', () => {
  const whole = elfOf({ machine: 62, versions: ['GLIBC_2.34'] });
  for (const bytes of [Buffer.alloc(20), whole.subarray(0, 64), whole.subarray(0, 120)]) assert.deepEqual(needsOf(bytes), { libraries: [], versions: [] });
  for (let length = 0; length < whole.length; length += 1) needsOf(whole.subarray(0, length));
});
