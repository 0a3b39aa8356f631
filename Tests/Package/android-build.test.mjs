// The build for Android: finding its tools in simulated installations of three systems, and the commands that use them.
import assert from 'node:assert/strict';
import { chmodSync, existsSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { androidCommands, androidTools, buildAndroid, findCmake, findJsonHeader, findNdk, presetVariables } from '../../scripts/lib/android.mjs';
import { inFolder } from './support/folder.mjs';

function write(file, text = '') {
  mkdirSync(path.dirname(file), { recursive: true });
  writeFileSync(file, text);
}

const makeNdk = (folder, revision = '23.1.7779620') => {
  write(path.join(folder, 'build', 'cmake', 'android.toolchain.cmake'));
  write(path.join(folder, 'source.properties'), `Pkg.Desc = Android NDK\nPkg.Revision = ${revision}\n`);
  return folder;
};

/** A simulated machine without any tools, whose files are below a folder. */
const bare = (folder, platform, more = {}) => ({
  platform,
  env: {},
  home: path.join(folder, 'home'),
  applications: path.join(folder, 'Applications'),
  includes: [path.join(folder, 'include')],
  versionOf: () => null,
  ...more,
});

/** Where each system keeps the editors and settings of Unity's Hub, Android Studio's SDK, and the Android support in an editor. */
const systems = {
  win32: { env: (folder) => ({ ProgramFiles: path.join(folder, 'Program Files') }), hub: 'Program Files/Unity/Hub/Editor', settings: 'home/AppData/Roaming/UnityHub', sdk: 'home/AppData/Local/Android/Sdk', support: 'Editor/Data/PlaybackEngines/AndroidPlayer' },
  darwin: { env: () => ({}), hub: 'Applications/Unity/Hub/Editor', settings: 'home/Library/Application Support/UnityHub', sdk: 'home/Library/Android/sdk', support: 'PlaybackEngines/AndroidPlayer' },
  linux: { env: () => ({}), hub: 'home/Unity/Hub/Editor', settings: 'home/.config/UnityHub', sdk: 'home/Android/Sdk', support: 'Editor/Data/PlaybackEngines/AndroidPlayer' },
};

for (const [platform, { env, hub, settings, sdk, support }] of Object.entries(systems)) {
  test(`${platform}: the tools are found that Unity's Hub installed, those of the newest Unity first, where the Hub's user put them, or else Android Studio's`, () =>
    inFolder((folder) => {
      const suffix = platform === 'win32' ? '.exe' : '';
      const versionOf = (program) => (path.isAbsolute(program) ? (program.includes('ninja') ? '1.10.2' : '3.22.1') : null);
      const machine = bare(folder, platform, { env: env(folder), versionOf });
      const ndks = path.join(folder, sdk, 'ndk');

      const { ndk, looked } = findNdk(machine);
      assert.equal(ndk, null);
      assert.deepEqual(looked, ['ANDROID_NDK_HOME: is not set', `${path.join(folder, hub)}: is not there`, `${ndks}: is not there`]);

      for (const version of ['9.0.1', '26.1.10909125', '23.1.7779620']) makeNdk(path.join(ndks, version), version);
      assert.equal(findNdk(machine).ndk, path.join(ndks, '26.1.10909125'), 'the newest that is new enough');

      const player = (version) => path.join(folder, hub, version, support);
      for (const version of ['2022.3.9f1', '2022.3.10f1']) {
        makeNdk(path.join(player(version), 'NDK'));
        for (const name of ['cmake', 'ninja']) write(path.join(player(version), 'SDK', 'cmake', '3.22.1', 'bin', name + suffix));
      }
      mkdirSync(player('6000.0.78f1'), { recursive: true });
      const found = findNdk(machine);
      assert.equal(found.ndk, path.join(player('2022.3.10f1'), 'NDK'));
      assert.deepEqual(found.looked, [`${path.join(player('6000.0.78f1'), 'NDK')}: is not there`], 'without Android support');
      const { cmake, ninja } = findCmake(machine);
      const programs = path.join(player('2022.3.10f1'), 'SDK', 'cmake', '3.22.1', 'bin');
      assert.deepEqual([cmake, ninja], [path.join(programs, `cmake${suffix}`), path.join(programs, `ninja${suffix}`)]);

      const chosen = path.join(folder, 'disk two');
      write(path.join(folder, settings, 'secondaryInstallPath.json'), JSON.stringify(chosen));
      const ofUser = makeNdk(path.join(chosen, '6000.0.1f1', support, 'NDK'), '27.2.12479018');
      assert.equal(findNdk(machine).ndk, ofUser);
    }));
}

test('ANDROID_NDK_HOME takes precedence over installed NDKs, and a wrong one is named and not used', () =>
  inFolder((folder) => {
    const installed = makeNdk(path.join(folder, 'home', 'Android', 'Sdk', 'ndk', '26.1.1'), '26.1.1');
    const own = makeNdk(path.join(folder, 'own ndk'));
    const found = (place) => findNdk(bare(folder, 'linux', { env: { ANDROID_NDK_HOME: place } }));
    assert.equal(found(own).ndk, own);
    const old = makeNdk(path.join(folder, 'old'), '21.4.7075529');
    assert.equal(found(old).ndk, installed);
    assert.deepEqual(found(old).looked, [`ANDROID_NDK_HOME=${old}: is r21; r23 or newer is needed`]);
    assert.match(found(path.join(folder, 'nowhere')).looked[0], /nowhere: is not there$/);
    assert.match(found(folder).looked[0], /has no build\/cmake\/android.toolchain.cmake$/);
  }));

test('CMake and Ninja on PATH are used where they are new enough', () =>
  inFolder((folder) => {
    const sdk = path.join(folder, 'home', 'Android', 'Sdk', 'cmake', '3.31.0', 'bin');
    write(path.join(sdk, 'cmake'));
    const found = (version) => findCmake(bare(folder, 'linux', { versionOf: (program) => (program === 'cmake' ? version : program === 'ninja' ? '1.11.1' : '3.31.0') }));
    assert.deepEqual([found('3.25.1').cmake, found('3.25.1').ninja], ['cmake', 'ninja']);
    assert.equal(found('3.18.4').cmake, path.join(sdk, 'cmake'));
    assert.match(found('3.18.4').looked[0], /^cmake: is 3\.18\.4; 3\.22 or newer is needed$/);
    assert.equal(findCmake(bare(path.join(folder, 'none'), 'linux')).cmake, null);
  }));

test('the JSON library is found in vcpkg, in the system and in a folder that the user names', () =>
  inFolder((folder) => {
    assert.equal(findJsonHeader(bare(folder, 'linux'), folder).folder, null);
    write(path.join(folder, 'include', 'nlohmann', 'json.hpp'));
    assert.equal(findJsonHeader(bare(folder, 'linux'), folder).folder, path.join(folder, 'include'));
    assert.equal(findJsonHeader(bare(folder, 'win32'), folder).folder, null, 'Windows has no such folder');
    const vcpkg = path.join(folder, 'vcpkg', 'installed', 'x64-windows', 'include');
    write(path.join(vcpkg, 'nlohmann', 'json.hpp'));
    assert.equal(findJsonHeader(bare(folder, 'win32', { env: { VCPKG_ROOT: path.join(folder, 'vcpkg') } }), folder).folder, vcpkg);
    const own = path.join(folder, 'include');
    assert.equal(findJsonHeader(bare(folder, 'win32', { env: { HAPTOFLOW_JSON_INCLUDE_DIR: own } }), folder).folder, own);
  }));

test('the command names the tool that is missing, how to bring it, and every place searched', () =>
  inFolder((folder) => {
    assert.throws(() => androidTools(bare(folder, 'linux')), { exitCode: 2, message: /Android Build Support[\s\S]*\bUnity\W+Hub\W+Editor: is not there/ });
    const env = { ANDROID_NDK_HOME: makeNdk(path.join(folder, 'ndk')) };
    assert.throws(() => androidTools(bare(folder, 'darwin', { env })), /no CMake 3\.22 or newer[\s\S]*cmake: cannot be started/);
    const versionOf = (program) => (program === 'cmake' ? '3.25.1' : null);
    assert.throws(() => androidTools(bare(folder, 'darwin', { env, versionOf })), /no Ninja 1\.10 or newer/);
    const both = () => '3.25.1';
    assert.throws(() => androidTools(bare(folder, 'win32', { env, versionOf: both })), /nlohmann-json[\s\S]*vcpkg install/);
  }));

test('the command line has the preset\'s variables, the toolchain and Ninja, and no preset, which old CMake cannot read', () => {
  const tools = { ndk: path.join('an ndk'), cmake: 'some-cmake', ninja: 'some-ninja', json: 'headers' };
  const { configure, build } = androidCommands(tools, 'out folder');
  assert.deepEqual(configure.slice(0, 1).concat(configure.slice(3, 7)), ['some-cmake', '-B', 'out folder', '-G', 'Ninja']);
  for (const define of ['ANDROID_ABI=arm64-v8a', 'ANDROID_STL=c++_static', 'CMAKE_BUILD_TYPE=Release', 'HAPTOFLOW_BUILD_CLI=OFF', 'HAPTOFLOW_BUILD_TESTS=OFF', 'CMAKE_MAKE_PROGRAM=some-ninja', 'HAPTOFLOW_nlohmann_INCLUDE_DIR=headers']) {
    assert.ok(configure.includes(`-D${define}`), define);
  }
  assert.ok(configure.includes(`-DCMAKE_TOOLCHAIN_FILE=${path.join('an ndk', 'build', 'cmake', 'android.toolchain.cmake')}`));
  assert.ok(!configure.includes('--preset'));
  assert.deepEqual(build.slice(0, 5), ['some-cmake', '--build', 'out folder', '--target', 'audioplugin_haptoflow']);
  assert.equal(presetVariables('android-arm64').ANDROID_PLATFORM, 'android-29');
});

test('a folder that was configured with another NDK is configured anew; a build without library is an error', { skip: process.platform === 'win32' }, () =>
  inFolder(async (folder) => {
    const out = path.join(folder, 'out');
    const log = path.join(folder, 'log');
    const cmake = path.join(folder, 'cmake');
    write(cmake, `#!/bin/sh\necho "$1 $2" >> '${log}'\n[ "$1" = -S ] || [ -e '${folder}/fails' ] || { mkdir -p '${out}'; : > '${out}/libaudioplugin_haptoflow.so'; }\n`);
    chmodSync(cmake, 0o755);
    const tools = { ndk: makeNdk(path.join(folder, 'ndk')), cmake, ninja: 'ninja', json: folder };
    write(path.join(out, 'CMakeCache.txt'), 'CMAKE_TOOLCHAIN_FILE:FILEPATH=another\n');
    write(path.join(out, 'CMakeFiles', 'old'));
    assert.equal(await buildAndroid(tools, out), path.join(out, 'libaudioplugin_haptoflow.so'));
    assert.ok(!existsSync(path.join(out, 'CMakeFiles', 'old')));
    assert.match(readFileSync(log, 'utf8'), /^-S .*\n--build /);
    rmSync(path.join(out, 'libaudioplugin_haptoflow.so'));
    write(path.join(folder, 'fails'));
    await assert.rejects(buildAndroid(tools, out), /made no library/);
  }));
