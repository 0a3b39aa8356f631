import { existsSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { cachedVariable, presetFolder } from '../lib/native_build.mjs';
import { CommandError, inRepository, repositoryRoot, runOrFail } from '../lib/process.mjs';
import { findCmake, findJsonHeader, findNdk, thisMachine } from './android_tools.mjs';

/** The preset whose cache variables are passed on the command line: the CMake of Android's SDK is too old to read presets. */
export const androidPreset = 'android-arm64';
export const androidTarget = 'audioplugin_haptoflow';

/** The cache variables of a preset with those that it inherits. */
export function presetVariables(name, presets = JSON.parse(readFileSync(inRepository('CMakePresets.json'), 'utf8')).configurePresets) {
  const preset = presets.find((candidate) => candidate.name === name);
  const inherited = preset.inherits ? presetVariables(preset.inherits, presets) : {};
  return { ...inherited, ...preset.cacheVariables };
}

const list = (looked) => looked.map((line) => `  ${line}`).join('\n');

/**
 * Finds the tools that the Android build needs.
 * @throws CommandError that lists the places searched and what to install
 */
export function androidTools(machine = thisMachine()) {
  const { ndk, looked } = findNdk(machine);
  if (ndk === null) {
    throw new CommandError(
      `no Android NDK r23 or newer: in Unity's Hub choose Installs > (gear) > Add modules > Android Build Support with SDK & NDK Tools, or set ANDROID_NDK_HOME. Looked at:\n${list(looked)}`,
      2,
    );
  }
  const programs = findCmake(machine);
  if (programs.cmake === null || programs.ninja === null) {
    throw new CommandError(
      `no ${programs.cmake === null ? 'CMake 3.22' : 'Ninja 1.10'} or newer: Android Studio's SDK Manager > SDK Tools > CMake has both, as Unity's own SDK does. Looked at:\n${list(programs.looked)}`,
      2,
    );
  }
  const json = findJsonHeader(machine, repositoryRoot);
  if (json.folder === null) {
    throw new CommandError(
      'the header library nlohmann-json is not there: `vcpkg install nlohmann-json` with VCPKG_ROOT set, `brew install nlohmann-json`, ' +
        `or HAPTOFLOW_JSON_INCLUDE_DIR as the folder that holds nlohmann/json.hpp. Looked at:\n${list(json.looked)}`,
      2,
    );
  }
  return { ndk, cmake: programs.cmake, ninja: programs.ninja, json: json.folder };
}

/** The command lines that configure and build the library. */
export function androidCommands({ ndk, cmake, ninja, json }, folder) {
  const variables = {
    ...presetVariables(androidPreset),
    CMAKE_TOOLCHAIN_FILE: path.join(ndk, 'build', 'cmake', 'android.toolchain.cmake'),
    CMAKE_MAKE_PROGRAM: ninja,
    HAPTOFLOW_nlohmann_INCLUDE_DIR: json,
  };
  const defines = Object.entries(variables).map(([name, value]) => `-D${name}=${value}`);
  return {
    configure: [cmake, '-S', repositoryRoot, '-B', folder, '-G', 'Ninja', ...defines],
    build: [cmake, '--build', folder, '--target', androidTarget, '-j', String(os.cpus().length)],
  };
}

/**
 * Rebuilds a library in the folder of an earlier build, with the tools that this folder is configured with, so that `pack`
 * needs no NDK in the environment. @returns {Promise<string>} the library's path
 */
export async function rebuildAndroid(folder = inRepository(presetFolder(androidPreset))) {
  const cmake = cachedVariable(readFileSync(path.join(folder, 'CMakeCache.txt'), 'utf8'), 'CMAKE_COMMAND');
  const [command, ...args] = androidCommands({ ndk: '', cmake, ninja: '', json: '' }, folder).build;
  await runOrFail(command, args, { quiet: !process.stdout.isTTY });
  return builtLibrary(folder);
}

/** Builds the Android library. @returns {Promise<string>} its path */
export async function buildAndroid(tools = androidTools(), folder = inRepository(presetFolder(androidPreset))) {
  console.log(`build: with the NDK ${tools.ndk}`);
  forgetOtherToolchain(folder, path.join(tools.ndk, 'build', 'cmake', 'android.toolchain.cmake'));
  const { configure, build } = androidCommands(tools, folder);
  for (const [command, ...args] of [configure, build]) await runOrFail(command, args, { quiet: !process.stdout.isTTY });
  return builtLibrary(folder);
}

function builtLibrary(folder) {
  const library = path.join(folder, `lib${androidTarget}.so`);
  if (!existsSync(library)) throw new CommandError(`${library}: the build ended well, but made no library`);
  return library;
}

/** Deletes the cache of a folder configured with another toolchain, since CMake cannot change the toolchain of a folder. */
function forgetOtherToolchain(folder, toolchain) {
  const cache = path.join(folder, 'CMakeCache.txt');
  if (existsSync(cache) && cachedVariable(readFileSync(cache, 'utf8'), 'CMAKE_TOOLCHAIN_FILE') !== toolchain) {
    rmSync(cache);
    rmSync(path.join(folder, 'CMakeFiles'), { recursive: true, force: true });
  }
}
