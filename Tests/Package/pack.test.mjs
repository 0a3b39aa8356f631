import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, existsSync, mkdirSync, mkdtempSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { gzipSync } from 'node:zlib';
import { inRepository } from '../../scripts/lib/repository.mjs';
import { findNatives, foldersFor, kindOfLibrary, platforms } from '../../scripts/pack/natives.mjs';
import { placeInPackage } from '../../scripts/pack/layout.mjs';
import { stagePackage } from '../../scripts/pack/stage.mjs';
import { readTarball } from '../../scripts/pack/tarball.mjs';

const pack = (...words) => spawnSync(process.execPath, [inRepository('scripts', 'pack.mjs'), ...words], { encoding: 'utf8' });

function inFolder(act) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-pack-'));
  try {
    return act(folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

function elf(machine) {
  const bytes = Buffer.alloc(64);
  bytes.writeUInt32BE(0x7f454c46, 0);
  bytes.writeUInt16LE(machine, 18);
  return bytes;
}

function pe(machine) {
  const bytes = Buffer.alloc(256);
  bytes.write('MZ', 0, 'latin1');
  bytes.writeUInt32LE(128, 60);
  bytes.write('PE\0\0', 128, 'latin1');
  bytes.writeUInt16LE(machine, 132);
  return bytes;
}

function universal(...machines) {
  const bytes = Buffer.alloc(8 + 20 * machines.length);
  bytes.writeUInt32BE(0xcafebabe, 0);
  bytes.writeUInt32BE(machines.length, 4);
  machines.forEach((machine, index) => bytes.writeUInt32BE(machine, 8 + 20 * index));
  return bytes;
}

function macho(machine) {
  const bytes = Buffer.alloc(64);
  bytes.writeUInt32LE(0xfeedfacf, 0);
  bytes.writeUInt32LE(machine, 4);
  return bytes;
}

test('--help explains the command and builds nothing', () => {
  const { status, stdout } = pack('--help');
  assert.equal(status, 0);
  for (const word of ['--no-build', 'Install package from tarball', 'HAPTOFLOW_NATIVE_DIR']) assert.ok(stdout.includes(word), word);
  for (const { name, id, presets } of platforms) assert.match(stdout, new RegExp(`^ {2}${name} +${id} +cmake --preset ${presets[0]} `, 'm'));
});

test('an option that does not exist ends with 2 before anything is built', () => {
  const { status, stdout, stderr } = pack('--no-biuld');
  assert.equal(status, 2);
  assert.match(stderr, /--no-biuld/);
  assert.equal(stdout, '');
});

test('a platform that does not exist cannot be required', () => {
  const { status, stderr } = pack('--no-build', '--require', 'linux-x64,andriod-arm64');
  assert.equal(status, 2);
  assert.match(stderr, /--require andriod-arm64: expected some of linux-x64, windows-x64, macos, android-arm64/);
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
    assert.match(none.stderr, /Android arm64: not built; the preset android-arm64 needs the Android NDK/);

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
  assert.equal(kindOfLibrary(pe(0x8664)), 'pe-x86-64');
  assert.equal(kindOfLibrary(pe(0xaa64)), 'pe-arm64');
  assert.equal(kindOfLibrary(macho(0x0100000c)), 'macho-arm64');
  assert.equal(kindOfLibrary(universal(0x01000007, 0x0100000c)), 'macho-universal');
  assert.equal(kindOfLibrary(universal(0x01000007)), null);
  for (const other of [elf(40), Buffer.alloc(0), Buffer.from('MZ'), Buffer.from('#!/bin/sh\n'), pe(0x8664).subarray(0, 100)]) assert.equal(kindOfLibrary(other), null);
});

test('each platform takes a library of its own kind from the folders of its own presets', () => {
  inFolder((folder) => {
    const put = (place, bytes) => {
      mkdirSync(path.join(folder, path.dirname(place)), { recursive: true });
      writeFileSync(path.join(folder, place), bytes);
    };
    // On an arm64 Linux machine: an Android library has the same name and kind, and is another file.
    put('release/libaudioplugin_haptoflow.so', elf(183));
    put('windows-msvc/Release/audioplugin_haptoflow.dll', pe(0x8664));
    put('macos/libaudioplugin_haptoflow.dylib', macho(0x0100000c));
    const { found, absent } = findNatives(({ presets }) => presets.flatMap((preset) => [path.join(folder, preset), path.join(folder, preset, 'Release')]));
    assert.deepEqual(found.map(({ platform, file }) => [platform.name, path.relative(folder, file)]), [
      ['Windows x86-64', path.join('windows-msvc', 'Release', 'audioplugin_haptoflow.dll')],
    ]);
    assert.deepEqual(absent.map(({ platform }) => platform.name), ['Linux x86-64', 'macOS', 'Android arm64']);
  });
});

test('a platform without a library is listed with the preset that builds it and what the preset needs', () => {
  const { absent } = findNatives(() => []);
  assert.equal(absent.length, platforms.length);
  assert.match(absent.find(({ platform }) => platform.name === 'Android arm64').why, /preset android-arm64 needs the Android NDK/);
});

test('the presets are those of CMakePresets.json, and HAPTOFLOW_NATIVE_DIR stands for the release build\'s folder', () => {
  const before = process.env.HAPTOFLOW_NATIVE_DIR;
  process.env.HAPTOFLOW_NATIVE_DIR = 'elsewhere';
  try {
    const folders = platforms.map((platform) => foldersFor(platform)[0]);
    assert.deepEqual(folders, ['elsewhere', ...['windows-x64', 'macos', 'android-arm64'].map((preset) => inRepository('build', preset))]);
  } finally {
    if (before === undefined) delete process.env.HAPTOFLOW_NATIVE_DIR;
    else process.env.HAPTOFLOW_NATIVE_DIR = before;
  }
});

test('files of the package go to their places, and other files of the repository are not packed', () => {
  assert.equal(placeInPackage('Packages/com.haptoflow.runtime/Runtime/HaptoFlow.asmdef'), 'Runtime/HaptoFlow.asmdef');
  assert.equal(placeInPackage('Samples~/StylusTracing/README.md'), 'Samples~/StylusTracing/README.md');
  assert.equal(placeInPackage('Tests/Runtime/Support/SceneTest.cs'), 'Tests/Runtime/Support/SceneTest.cs');
  for (const name of ['README.md', 'Tests/Native/CMakeLists.txt', 'Tests/Runtime.meta', 'NativePlugin/include/haptoflow/haptoflow.h', 'Samples~/.editorconfig']) {
    assert.equal(placeInPackage(name), null, name);
  }
});

test('a staged package has the .meta of a library exactly where it has the library', () => {
  inFolder((folder) => {
    const library = path.join(folder, 'libaudioplugin_haptoflow.so');
    writeFileSync(library, elf(62));
    const root = 'Packages/com.haptoflow.runtime';
    const plugins = platforms.flatMap(({ place }) => [`${place}.meta`, `${path.posix.dirname(place)}.meta`, `${place.split('/')[0]}.meta`]);
    const files = [`${root}/package.json`, `${root}/Runtime/Plugins.meta`, ...plugins.map((name) => `${root}/Runtime/Plugins/${name}`)];
    const linux = platforms.find(({ name }) => name === 'Linux x86-64');
    const staged = path.join(folder, 'package');
    const has = (name) => existsSync(path.join(staged, 'Runtime', name));

    stagePackage(staged, files, [{ platform: linux, file: library }]);
    for (const name of ['Plugins.meta', 'Plugins/Linux.meta', 'Plugins/Linux/x64.meta', `Plugins/${linux.place}`, `Plugins/${linux.place}.meta`]) assert.ok(has(name), name);
    for (const name of ['Plugins/Windows', 'Plugins/Windows.meta', 'Plugins/Android', 'Plugins/macOS.meta']) assert.ok(!has(name), name);

    stagePackage(staged, files, []);
    for (const name of ['Plugins', 'Plugins.meta']) assert.ok(!has(name), name);
  });
});

/** One entry of a tar archive. */
function entry(name, content, type = '0', prefix = '') {
  const header = Buffer.alloc(512);
  header.write(name, 0, 'utf8');
  header.write(content.length.toString(8).padStart(11, '0'), 124, 'latin1');
  header.write(type, 156, 'latin1');
  header.write(prefix, 345, 'utf8');
  const body = Buffer.alloc(512 * Math.ceil(content.length / 512));
  content.copy(body);
  return Buffer.concat([header, body]);
}

test('the files of an archive are read, long names included', () => {
  const long = `package/${'n'.repeat(120)}.cs`;
  const archive = gzipSync(Buffer.concat([
    entry('package/', Buffer.alloc(0), '5'),
    entry('a.txt', Buffer.from('first'), '0', 'package/folder'),
    entry('PaxHeader', Buffer.from(`${long.length + 10} path=${long}\n`), 'x'),
    entry('package/short', Buffer.alloc(513, 7)),
    Buffer.alloc(1024),
  ]));
  const files = readTarball(archive);
  assert.deepEqual([...files.keys()], ['package/folder/a.txt', long]);
  assert.equal(files.get('package/folder/a.txt').toString(), 'first');
  assert.deepEqual(files.get(long), Buffer.alloc(513, 7));
});

test('an archive with a link in it is refused', () => {
  assert.throws(() => readTarball(gzipSync(entry('package/link', Buffer.alloc(0), '2'))), /package\/link: .* "2"/);
});
