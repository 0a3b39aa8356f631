import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { cachedVariable, presetFolder } from './native_build.mjs';
import { CommandError, inRepository, repositoryRoot, runOrFail } from './process.mjs';

/** The oldest NDK with the C++20 library that the sources need, and the oldest CMake that the CMake files accept. */
const oldestNdkMajor = 23;
const oldestCmake = '3.22';

/** What the search reads of this machine. Tests pass machines of their own. */
export const thisMachine = () => ({
  env: process.env,
  platform: process.platform,
  home: os.homedir(),
  applications: '/Applications',
  versionOf: (program) => {
    const { error, status, stdout } = spawnSync(program, ['--version'], { encoding: 'utf8' });
    return error || status !== 0 ? null : (stdout.match(/\d+(\.\d+)+/)?.[0] ?? null);
  },
});

/** Orders versions by their numbers, newest first: by letters, "2022.3.9f1" would come before "2022.3.10f1". */
const byVersion = (one, other) => other.localeCompare(one, 'en', { numeric: true });

const foldersIn = (folder) =>
  existsSync(folder)
    ? readdirSync(folder, { withFileTypes: true }).filter((entry) => entry.isDirectory() || entry.isSymbolicLink()).map(({ name }) => name).sort(byVersion)
    : [];

/** Where each system keeps the settings of Unity's Hub, the Hub's editors, and the Android SDK that Android Studio installed. */
const systemFolders = {
  win32: ({ env, home }) => ({
    settings: path.join(env.APPDATA ?? path.join(home, 'AppData', 'Roaming'), 'UnityHub'),
    editors: path.join(env.ProgramFiles ?? 'C:\\Program Files', 'Unity', 'Hub', 'Editor'),
    sdk: path.join(env.LOCALAPPDATA ?? path.join(home, 'AppData', 'Local'), 'Android', 'Sdk'),
  }),
  darwin: ({ home, applications }) => ({
    settings: path.join(home, 'Library', 'Application Support', 'UnityHub'),
    editors: path.join(applications, 'Unity', 'Hub', 'Editor'),
    sdk: path.join(home, 'Library', 'Android', 'sdk'),
  }),
  linux: ({ home }) => ({
    settings: path.join(home, '.config', 'UnityHub'),
    editors: path.join(home, 'Unity', 'Hub', 'Editor'),
    sdk: path.join(home, 'Android', 'Sdk'),
  }),
};

const foldersOf = (machine) => (systemFolders[machine.platform] ?? systemFolders.linux)(machine);

/** Folders with one subfolder for each installed version of Unity: the one set in Unity's Hub, and the usual one. */
function editorFolders(machine) {
  const { settings, editors } = foldersOf(machine);
  try {
    const chosen = JSON.parse(readFileSync(path.join(settings, 'secondaryInstallPath.json'), 'utf8'));
    return typeof chosen === 'string' && chosen !== '' ? [chosen, editors] : [editors];
  } catch {
    return [editors];
  }
}

/** The Android support folder of every installed version of Unity; within one editor folder, newest first. */
function androidPlayers(machine) {
  const inEditor = machine.platform === 'darwin' ? [] : ['Editor', 'Data'];
  return editorFolders(machine).flatMap((folder) =>
    foldersIn(folder).map((version) => path.join(folder, version, ...inEditor, 'PlaybackEngines', 'AndroidPlayer')),
  );
}

/** Android SDKs that Android Studio installed. */
const androidSdks = (machine) => [...new Set([machine.env.ANDROID_HOME, machine.env.ANDROID_SDK_ROOT, foldersOf(machine).sdk].filter(Boolean))];

/** The reason why a folder is not a usable NDK; null for a usable one. */
function whyNoNdk(folder) {
  if (!existsSync(folder)) return 'is not there';
  if (!existsSync(path.join(folder, 'build', 'cmake', 'android.toolchain.cmake'))) return 'has no build/cmake/android.toolchain.cmake';
  const properties = path.join(folder, 'source.properties');
  const revision = existsSync(properties) ? readFileSync(properties, 'utf8').match(/Pkg\.Revision\s*=\s*([\d.]+)/)?.[1] : undefined;
  const major = revision === undefined ? oldestNdkMajor : Number(revision.split('.')[0]);
  return major < oldestNdkMajor ? `is r${major}; r${oldestNdkMajor} or newer is needed` : null;
}

/**
 * Finds the Android NDK: from the environment, else installed by Unity Hub, else by Android Studio.
 * @returns {{ndk: string | null, looked: string[]}} looked: each place searched, with the reason why it was not used
 */
export function findNdk(machine = thisMachine()) {
  const named = ['ANDROID_NDK_HOME', 'ANDROID_NDK_ROOT'].filter((name) => machine.env[name]).map((name) => ({ place: machine.env[name], label: `${name}=` }));
  const ofUnity = androidPlayers(machine).map((folder) => path.join(folder, 'NDK'));
  const ofStudio = androidSdks(machine).flatMap((sdk) => foldersIn(path.join(sdk, 'ndk')).map((version) => path.join(sdk, 'ndk', version)));
  const looked = [];
  for (const { place, label } of [...named, ...[...ofUnity, ...ofStudio].map((folder) => ({ place: folder, label: '' }))]) {
    const why = whyNoNdk(place);
    if (why === null) return { ndk: place, looked };
    looked.push(`${label}${place}: ${why}`);
  }
  if (named.length === 0) looked.unshift('ANDROID_NDK_HOME: is not set');
  const parents = [...editorFolders(machine), ...androidSdks(machine).map((sdk) => path.join(sdk, 'ndk'))];
  looked.push(...parents.filter((folder) => foldersIn(folder).length === 0).map((folder) => `${folder}: ${existsSync(folder) ? 'holds no version' : 'is not there'}`));
  return { ndk: null, looked };
}

/**
 * Finds CMake and Ninja: on PATH, else in an Android SDK, where Unity Hub installs both.
 * @returns {{cmake: string | null, ninja: string | null, looked: string[]}}
 */
export function findCmake(machine = thisMachine()) {
  const suffix = machine.platform === 'win32' ? '.exe' : '';
  const sdks = [...androidPlayers(machine).map((folder) => path.join(folder, 'SDK')), ...androidSdks(machine)];
  const folders = sdks.flatMap((sdk) => foldersIn(path.join(sdk, 'cmake')).map((version) => path.join(sdk, 'cmake', version, 'bin')));
  const looked = [];
  const firstGood = (name, oldest) => {
    for (const program of [name, ...folders.map((folder) => path.join(folder, name + suffix))]) {
      const version = program === name || existsSync(program) ? machine.versionOf(program) : null;
      if (version !== null && byVersion(oldest, version) >= 0) return program;
      looked.push(version === null ? `${program}: cannot be started` : `${program}: is ${version}; ${oldest} or newer is needed`);
    }
    return null;
  };
  return { cmake: firstGood('cmake', oldestCmake), ninja: firstGood('ninja', '1.10'), looked };
}

/**
 * Finds the folder that holds nlohmann/json.hpp, the only third-party library that the plugin's sources include.
 * @returns {{folder: string | null, looked: string[]}}
 */
export function findJsonHeader(machine = thisMachine(), repository = '.') {
  const { env, platform } = machine;
  const installed = [path.join(repository, 'vcpkg_installed'), ...[env.VCPKG_ROOT, env.VCPKG_INSTALLATION_ROOT].filter(Boolean).map((root) => path.join(root, 'installed'))];
  const ofVcpkg = installed.flatMap((folder) => foldersIn(folder).map((triplet) => path.join(folder, triplet, 'include')));
  const ofSystem = platform === 'win32' ? [] : (machine.includes ?? ['/usr/include', '/usr/local/include', '/opt/homebrew/include', '/opt/local/include']);
  const named = env.HAPTOFLOW_JSON_INCLUDE_DIR ? [env.HAPTOFLOW_JSON_INCLUDE_DIR] : [];
  const places = [...named, ...ofVcpkg, ...ofSystem];
  const folder = places.find((place) => existsSync(path.join(place, 'nlohmann', 'json.hpp'))) ?? null;
  const empty = installed.filter((place) => foldersIn(place).length === 0);
  return { folder, looked: [...places, ...empty].map((place) => `${place}: has no nlohmann/json.hpp`) };
}

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

/** Builds the Android library. @returns {Promise<string>} its path */
export async function buildAndroid(tools = androidTools(), folder = inRepository(presetFolder(androidPreset))) {
  console.log(`build: with the NDK ${tools.ndk}`);
  forgetOtherToolchain(folder, path.join(tools.ndk, 'build', 'cmake', 'android.toolchain.cmake'));
  const { configure, build } = androidCommands(tools, folder);
  for (const [command, ...args] of [configure, build]) await runOrFail(command, args, { quiet: !process.stdout.isTTY });
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
