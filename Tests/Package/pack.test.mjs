import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, readFileSync, symlinkSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { findNatives, kindOfLibrary, platforms, presetsToBuild } from '../../scripts/pack/natives.mjs';
import { placeInPackage, studiesName } from '../../scripts/pack/layout.mjs';
import { stagePackage } from '../../scripts/pack/stage.mjs';
import { filesOfZip, runtimeBytes, tableOfContents } from '../../scripts/pack/dependency.mjs';
import { elfOf } from './support/elf.mjs';
import { inFolder } from './support/folder.mjs';

const pack = (...words) => spawnSync(process.execPath, [inRepository('scripts', 'pack.mjs'), ...words], { encoding: 'utf8' });

const elf = (machine) => elfOf({ machine });
const android = (versions = ['LIBC']) => elfOf({ machine: 183, libraries: ['libc.so'], versions });

function pe(machine) {
  const bytes = Buffer.alloc(256);
  bytes.write('MZ', 0, 'latin1');
  bytes.writeUInt32LE(128, 60);
  bytes.write('PE\0\0', 128, 'latin1');
  bytes.writeUInt16LE(machine, 132);
  return bytes;
}

function macho(machine) {
  const bytes = Buffer.alloc(64);
  bytes.writeUInt32LE(0xfeedfacf, 0);
  bytes.writeUInt32LE(machine, 4);
  return bytes;
}

test('the help starts in a fresh checkout without npm packages, and names the command of each platform', () => {
  inFolder((folder) => {
    for (const name of ['scripts', 'package.json', 'CMakePresets.json']) cpSync(inRepository(name), path.join(folder, name), { recursive: true });
    const { status, stdout, stderr } = spawnSync(process.execPath, [path.join(folder, 'scripts', 'pack.mjs'), '--help'], { encoding: 'utf8' });
    assert.equal(status, 0, stderr);
    for (const { name, id, where } of platforms) assert.match(stdout, new RegExp(`^ {2}${name} +npm run build -- --platform ${id} +${where}$`, 'm'));
  });
});

test('an option or a platform that does not exist ends with 2 before anything is built', () => {
  for (const [words, message] of [[['--no-biuld'], /--no-biuld/], [['--require', 'andriod-arm64'], /--require andriod-arm64: expected some of linux-x64, linux-arm64, windows-x64, macos, android-arm64/]]) {
    const { status, stdout, stderr } = pack(...words);
    assert.deepEqual([status, stdout], [2, '']);
    assert.match(stderr, message);
  }
});

test('without the library of a required platform, or without any, no tarball is made', () => {
  inFolder((folder) => {
    // A copy of the scripts has its own, empty build folder.
    for (const name of ['scripts', 'package.json', 'CMakePresets.json']) cpSync(inRepository(name), path.join(folder, name), { recursive: true });
    symlinkSync(inRepository('node_modules'), path.join(folder, 'node_modules'), 'junction');
    const there = (...words) => spawnSync(process.execPath, [path.join(folder, 'scripts', 'pack.mjs'), '--no-build', ...words], { encoding: 'utf8', env: { ...process.env, HAPTOFLOW_NATIVE_DIR: path.join(folder, 'natives') } });

    const none = there();
    assert.equal(none.status, 1, none.stdout);
    assert.match(none.stderr, /there is no native library/);
    assert.match(none.stderr, /Android arm64: not built; `npm run build -- --platform android-arm64` with Unity's Android Build Support/);

    mkdirSync(path.join(folder, 'natives'));
    writeFileSync(path.join(folder, 'natives', 'libaudioplugin_haptoflow.so'), elf(62));
    const other = there('--require', 'linux-x64,android-arm64');
    assert.equal(other.status, 1, other.stdout);
    assert.match(other.stderr, /without android-arm64: not built/);
    assert.doesNotMatch(other.stderr, /without linux-x64/);
    assert.ok(!existsSync(path.join(folder, 'out')));
  });
});

test('the platform of a library is read from its first bytes', () => {
  assert.equal(kindOfLibrary(elf(62)), 'elf-x86-64');
  assert.equal(kindOfLibrary(elf(183)), 'elf-arm64');
  assert.equal(kindOfLibrary(android()), 'android-arm64');
  assert.equal(kindOfLibrary(pe(0x8664)), 'pe-x86-64');
  assert.equal(kindOfLibrary(pe(0xaa64)), 'pe-arm64');
  assert.equal(kindOfLibrary(macho(0x0100000c)), 'macho-arm64');
  assert.equal(kindOfLibrary(macho(0x01000007)), 'macho-x86-64');
  for (const other of [elf(40), Buffer.alloc(0), Buffer.from('MZ'), Buffer.from('#!/bin/sh\n'), pe(0x8664).subarray(0, 100)]) assert.equal(kindOfLibrary(other), null);
});

test('each platform takes a library of its own kind from the folders of its own presets', () => {
  inFolder((folder) => {
    const put = (place, bytes) => {
      mkdirSync(path.join(folder, path.dirname(place)), { recursive: true });
      writeFileSync(path.join(folder, place), bytes);
    };
    // On an arm64 Linux machine: an Android library has the same name and processor, and is another file.
    put('release/libaudioplugin_haptoflow.so', elf(183));
    put('android-arm64/libaudioplugin_haptoflow.so', elf(183));
    put('windows-msvc/Release/audioplugin_haptoflow.dll', pe(0x8664));
    put('macos/libaudioplugin_haptoflow.dylib', macho(0x01000007));
    const { found, absent } = findNatives(({ presets }) => presets.flatMap((preset) => [path.join(folder, preset), path.join(folder, preset, 'Release')]));
    assert.deepEqual(found.map(({ platform, file }) => [platform.name, path.relative(folder, file)]), [
      ['Linux arm64', path.join('release', 'libaudioplugin_haptoflow.so')],
      ['Windows x86-64', path.join('windows-msvc', 'Release', 'audioplugin_haptoflow.dll')],
    ]);
    assert.deepEqual(absent.map(({ platform }) => platform.name), ['Linux x86-64', 'macOS arm64', 'Android arm64']);
    assert.equal(absent[1].why, 'not built; `npm run build -- --platform macos` on a Mac adds it');
  });
});

test('on Debian for x64 three libraries are built, with an NDK four, elsewhere the machine\'s own and what is configured', () => {
  const debian = { platform: 'linux', arch: 'x64', isDebian: true, hasNdk: false, isConfigured: () => false };
  assert.deepEqual(presetsToBuild(debian), ['release', 'linux-arm64', 'windows-x64']);
  assert.deepEqual(presetsToBuild({ ...debian, hasNdk: true }), ['release', 'linux-arm64', 'windows-x64', 'android-arm64']);
  assert.deepEqual(presetsToBuild({ ...debian, arch: 'arm64' }), ['release']);
  assert.deepEqual(presetsToBuild({ ...debian, isDebian: false, isConfigured: (preset) => preset === 'windows-x64' }), ['release', 'windows-x64']);
  assert.deepEqual(presetsToBuild({ ...debian, platform: 'darwin', isDebian: false, hasNdk: true }), ['macos', 'android-arm64']);
});

test('an older library of a build that failed is left out, and the reason is named', () => {
  inFolder((folder) => {
    writeFileSync(path.join(folder, 'libaudioplugin_haptoflow.so'), android());
    const ids = ({ found }) => found.map(({ platform }) => platform.id);
    assert.deepEqual(ids(findNatives(() => [folder])), ['android-arm64']);
    const { found, absent } = findNatives(() => [folder], new Set(['android-arm64']));
    assert.deepEqual(ids({ found }), []);
    assert.match(absent.find(({ platform }) => platform.id === 'android-arm64').why, /its build failed/);
  });
});

test('the table has sizes on the device, what a library needs, and the command for each platform without one', () => {
  inFolder((folder) => {
    const file = path.join(folder, 'library');
    writeFileSync(file, Buffer.concat([elfOf({ machine: 62, versions: ['GLIBC_2.38'] }), Buffer.alloc(3 * 2 ** 20)]));
    const [x64, arm64, ...others] = platforms;
    const lines = tableOfContents({ found: [{ platform: x64, file }, { platform: arm64, file }], absent: others.map((platform) => ({ platform, why: 'not built; do this' })) });
    assert.equal(lines.length, 6);
    const [, own, model, runtime, sum] = lines[1].match(/^ {2}Linux x86-64 +([\d.]+) +([\d.]+) +([\d.]+) +([\d.]+) {2}needs glibc 2\.38: built on Debian 12 it would need 2\.31 at most$/);
    assert.equal(own, '3.0');
    assert.ok(Math.abs(Number(own) + Number(model) + Number(runtime) - Number(sum)) < 0.2);
    assert.match(lines[2], /Linux arm64 .* - .*bring ONNX Runtime for it yourself: its package has none/);
    assert.match(lines[3], /^ {2}Windows x86-64 +missing: not built; do this$/);
  });
});

test('ONNX Runtime takes on each device what its package holds for it: uncompressed from the archive for Android', () => {
  const mebibytes = (id) => Math.round(runtimeBytes(id) / 2 ** 20);
  assert.deepEqual(['linux-x64', 'linux-arm64', 'windows-x64', 'macos', 'android-arm64'].map(mebibytes), [27, 0, 15, 41, 31]);
  assert.throws(() => filesOfZip(Buffer.from('no archive')), /no ZIP archive/);
});

test('files go to their places in the package or in that of the studies, and other files of the repository are not packed', () => {
  const rows = [
    ['Packages/com.haptoflow.runtime/Runtime/HaptoFlow.asmdef', 'Runtime/HaptoFlow.asmdef', null],
    ['Packages/com.haptoflow.studies/Samples~/LatencyStudy/Marker.cs', null, 'Samples~/LatencyStudy/Marker.cs'],
    ['Samples~/StylusTracing/README.md', 'Samples~/StylusTracing/README.md', null],
    ['Tests/Unity/Runtime.meta', 'Tests/Runtime.meta', null],
    ['Assets/Workshop.unity', 'Samples~/Workshop/Workshop.unity', null],
    ['Documentation~/index.md', 'Documentation~/index.md', null],
    ...['studies.md', 'study-files.md', 'images/delay-budget.png'].map((name) => [`Documentation~/${name}`, null, `Documentation~/${name}`]),
    ...['README.md', 'Assets/Desk.unity', 'Samples~/samples.json', 'Tests/Native/CMakeLists.txt', 'Tests/Unity/package.json', 'Samples~/.editorconfig'].map((name) => [name, null, null]),
  ];
  assert.deepEqual(rows.map(([name]) => [name, placeInPackage(name), placeInPackage(name, studiesName)]), rows);
});

test('a staged package has the .meta of a library exactly where it has the library', () => {
  inFolder((folder) => {
    const library = path.join(folder, 'libaudioplugin_haptoflow.so');
    writeFileSync(library, elf(62));
    const root = 'Packages/com.haptoflow.runtime';
    const plugins = platforms.flatMap(({ place, isInGit }) =>
      [place, path.posix.dirname(place), place.split('/')[0]].map((name) => `${isInGit ? `${root}/Runtime/Plugins` : 'NativePlugin/import'}/${name}.meta`));
    const inGit = platforms.filter(({ isInGit }) => isInGit).map(({ place }) => `${root}/Runtime/Plugins/${place}`);
    const files = [`${root}/package.json`, `${root}/Runtime/Plugins.meta`, ...plugins, ...inGit];
    const [linux, android] = ['linux-x64', 'android-arm64'].map((id) => platforms.find((platform) => platform.id === id));
    const staged = path.join(folder, 'package');
    const has = (name) => existsSync(path.join(staged, 'Runtime', name));

    stagePackage(staged, files, [linux, android].map((platform) => ({ platform, file: library })));
    for (const name of ['Plugins/Android.meta', 'Plugins/Android/arm64-v8a.meta', `Plugins/${android.place}.meta`]) assert.ok(has(name), name);

    stagePackage(staged, files, [{ platform: linux, file: library }]);
    assert.deepEqual(readFileSync(path.join(staged, 'Runtime', 'Plugins', linux.place)), elf(62), 'the library that was chosen, not that of git');
    for (const name of ['Plugins.meta', 'Plugins/Linux.meta', 'Plugins/Linux/x64.meta', `Plugins/${linux.place}`, `Plugins/${linux.place}.meta`]) assert.ok(has(name), name);
    for (const name of ['Plugins/Windows', 'Plugins/Windows.meta', 'Plugins/Android', 'Plugins/macOS.meta']) assert.ok(!has(name), name);

    stagePackage(staged, files, []);
    for (const name of ['Plugins', 'Plugins.meta']) assert.ok(!has(name), name);
  });
});
