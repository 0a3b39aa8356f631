import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { androidPreset, androidTarget, buildAndroid, findNdk } from '../lib/android.mjs';
import { buildNative, presetFolder } from '../lib/native_build.mjs';
import { CommandError, inRepository, runOrFail } from '../lib/process.mjs';
import { onDebian, setUp } from '../lib/setup.mjs';
import { isNewerThan, neededGlibc, needsLibrary } from './binaries.mjs';

/** Where the package keeps its native libraries. */
export const pluginsFolder = 'Runtime/Plugins';

/**
 * The platforms of the package: the library's place below Runtime/Plugins, its binary format, the presets that build it,
 * where `npm run build -- --platform ID`, the command that adds it, runs, and whether git has it (`npm run natives`).
 */
export const platforms = [
  { name: 'Linux x86-64', id: 'linux-x64', place: 'Linux/x64/libaudioplugin_haptoflow.so', kind: 'elf-x86-64', presets: ['release'], where: 'on Linux x64', isInGit: true },
  { name: 'Linux arm64', id: 'linux-arm64', place: 'Linux/arm64/libaudioplugin_haptoflow.so', kind: 'elf-arm64', presets: ['linux-arm64', 'release'], where: 'on Linux', isInGit: true },
  { name: 'Windows x86-64', id: 'windows-x64', place: 'Windows/x64/audioplugin_haptoflow.dll', kind: 'pe-x86-64', presets: ['windows-x64', 'windows-msvc', 'release'], where: 'on Linux or Windows', isInGit: true },
  { name: 'macOS arm64', id: 'macos', place: 'macOS/libaudioplugin_haptoflow.dylib', kind: 'macho-arm64', presets: ['macos'], where: 'on a Mac' },
  { name: 'Android arm64', id: 'android-arm64', place: 'Android/arm64-v8a/libaudioplugin_haptoflow.so', kind: 'android-arm64', presets: ['android-arm64'], where: 'with Unity\'s Android Build Support, or ANDROID_NDK_ROOT set' },
];

/** The oldest glibc of the systems that Unity 2022.3 supports (Ubuntu 20.04): a library of a release needs no newer one. */
export const oldestGlibc = [2, 31];

/** What is wrong with the C library that a Linux library needs; null where nothing is, and for other platforms. */
export function complaintOfGlibc({ kind }, bytes) {
  const glibc = kind.startsWith('elf-') ? neededGlibc(bytes) : null;
  if (glibc === null || !isNewerThan(glibc, oldestGlibc)) return null;
  return `needs glibc ${glibc.join('.')}; expected ${oldestGlibc.join('.')} or older: build it on Debian 12`;
}

const elfMachines = { 62: 'x86-64', 183: 'arm64' };
const peMachines = { 0x8664: 'pe-x86-64', 0xaa64: 'pe-arm64' };
const machoMachines = { 0x0100000c: 'arm64', 0x01000007: 'x86-64' };

/** The name of Android's C library differs from that of every other Linux. */
function kindOfElf(bytes) {
  const machine = elfMachines[bytes.readUInt16LE(18)];
  if (machine === undefined) return null;
  return `${needsLibrary(bytes, 'libc.so') ? 'android' : 'elf'}-${machine}`;
}

/** The format and processor of a library by its bytes, such as "elf-x86-64"; null for anything else. */
export function kindOfLibrary(bytes) {
  if (bytes.length >= 20 && bytes.readUInt32BE(0) === 0x7f454c46) return kindOfElf(bytes);
  if (bytes.length >= 8 && bytes.readUInt32LE(0) === 0xfeedfacf) return `macho-${machoMachines[bytes.readUInt32LE(4)] ?? 'other'}`;
  if (bytes.length >= 64 && bytes.toString('latin1', 0, 2) === 'MZ') {
    const header = bytes.readUInt32LE(60);
    const isPe = header + 6 <= bytes.length && bytes.toString('latin1', header, header + 4) === 'PE\0\0';
    return isPe ? (peMachines[bytes.readUInt16LE(header + 4)] ?? null) : null;
  }
  return null;
}

/**
 * The presets that `pack` builds on this machine: its own; on Debian for x64 those of the cross compilers that set-up
 * installs; where an NDK is found Android's; and every preset that is configured, so that no library in the package is out of
 * date.
 * @param {{platform: string, arch: string, isDebian: boolean, hasNdk: boolean, isConfigured: (preset: string) => boolean}} machine
 */
export function presetsToBuild({ platform, arch, isDebian, hasNdk, isConfigured }) {
  const own = platform === 'darwin' ? 'macos' : 'release';
  const crossed = isDebian && arch === 'x64' ? ['linux-arm64', 'windows-x64'] : [];
  const ofNdk = hasNdk ? [androidPreset] : [];
  const configured = platforms.flatMap(({ presets }) => presets).filter(isConfigured);
  return [...new Set([own, ...crossed, ...configured, ...ofNdk])];
}

/** Builds the libraries that this machine can build. @returns {Promise<Set<string>>} the presets that could not be built */
export async function buildNatives() {
  const isDebian = onDebian();
  const hasNdk = findNdk().ndk !== null;
  const isConfigured = (preset) => existsSync(inRepository(presetFolder(preset), 'build.ninja'));
  const presets = presetsToBuild({ platform: process.platform, arch: process.arch, isDebian, hasNdk, isConfigured });
  await setUp(['build', 'files', ...(presets.some((preset) => ['linux-arm64', 'windows-x64'].includes(preset)) ? ['cross'] : [])]);
  const failed = new Set();
  for (const preset of presets) {
    if (preset !== androidPreset) await buildNative({ preset, targets: ['audioplugin_haptoflow'] });
    else if (!(await triesAndroid(hasNdk))) failed.add(preset);
  }
  return failed;
}

/**
 * Android's compiler was never tried here: where it fails, the tarball has the other libraries. The folder of an earlier build
 * has its NDK, so that none is needed in the environment.
 */
async function triesAndroid(hasNdk) {
  try {
    if (hasNdk) await buildAndroid();
    else await runOrFail('cmake', ['--build', inRepository(presetFolder(androidPreset)), '--target', androidTarget], { quiet: !process.stdout.isTTY });
    return true;
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    console.error(`pack: Android arm64: ${error.message}`);
    return false;
  }
}

/** Folders that may hold a platform's library. HAPTOFLOW_NATIVE_DIR replaces the folder of the preset "release". */
export function foldersFor(platform) {
  const folderOf = (preset) => (preset === 'release' && process.env.HAPTOFLOW_NATIVE_DIR) || inRepository(presetFolder(preset));
  // Visual Studio writes to a subfolder named after the configuration.
  return platform.presets.map(folderOf).flatMap((folder) => [folder, path.join(folder, 'Release')]);
}

/** The command that adds a platform's library, and where it runs. */
export const commandFor = ({ id, where }) => `\`npm run build -- --platform ${id}\` ${where}`;

/**
 * Finds the built libraries, where there is none that of git, and the platforms without either.
 * @param {(platform: object) => string[]} folders where to look, in this order
 * @param {Set<string>} failed presets whose last build failed: an older library of theirs is left out
 * @param {(platform: object) => string | null} [fromGit] a platform's library in git, null where the sources are newer
 * @returns {{found: {platform: object, file: string, isFromGit: boolean}[], absent: {platform: object, why: string}[]}}
 */
export function findNatives(folders = foldersFor, failed = new Set(), fromGit = undefined) {
  const found = [];
  const absent = [];
  const hasFailed = ({ presets }) => presets.some((preset) => failed.has(preset));
  const whyNotBuilt = (platform) => {
    if (hasFailed(platform)) return 'its build failed (the reason is above)';
    return fromGit && platform.isInGit ? 'not built, and that of git is older than the sources' : 'not built';
  };
  for (const platform of platforms) {
    const files = folders(platform).map((folder) => path.join(folder, path.basename(platform.place)));
    const file = files.find((candidate) => existsSync(candidate) && kindOfLibrary(readFileSync(candidate)) === platform.kind);
    const built = hasFailed(platform) ? undefined : file;
    const taken = built ?? fromGit?.(platform);
    if (taken) found.push({ platform, file: taken, isFromGit: built === undefined });
    else absent.push({ platform, why: `${whyNotBuilt(platform)}; ${commandFor(platform)} adds it` });
  }
  return { found, absent };
}
