import { closeSync, existsSync, openSync, readSync } from 'node:fs';
import path from 'node:path';
import { androidPreset, rebuildAndroid } from '../build/android_build.mjs';
import { buildNative, presetFolder } from '../lib/native_build.mjs';
import { inRepository } from '../lib/repository.mjs';

/** Where the package keeps its native libraries. */
export const pluginsFolder = 'Runtime/Plugins';

/**
 * The platforms of the package: the library's place below Runtime/Plugins, its binary format, the presets that build it, and
 * what the first of them needs.
 */
export const platforms = [
  { name: 'Linux x86-64', id: 'linux-x64', place: 'Linux/x64/libaudioplugin_haptoflow.so', kind: 'elf-x86-64', presets: ['release'], needs: 'a Linux x64 machine' },
  { name: 'Windows x86-64', id: 'windows-x64', place: 'Windows/x64/audioplugin_haptoflow.dll', kind: 'pe-x86-64', presets: ['windows-x64', 'windows-msvc', 'release'], needs: 'mingw-w64' },
  { name: 'macOS', id: 'macos', place: 'macOS/libaudioplugin_haptoflow.dylib', kind: 'macho-universal', presets: ['macos'], needs: 'a Mac' },
  { name: 'Android arm64', id: 'android-arm64', place: 'Android/arm64-v8a/libaudioplugin_haptoflow.so', kind: 'elf-arm64', presets: ['android-arm64'], needs: 'the Android NDK' },
];

const elfMachines = { 62: 'elf-x86-64', 183: 'elf-arm64' };
const peMachines = { 0x8664: 'pe-x86-64', 0xaa64: 'pe-arm64' };
const machoMachines = { 0x0100000c: 'arm64', 0x01000007: 'x86-64' };

/** The format and processor of a library by the first bytes of its file, such as "elf-x86-64"; null for anything else. */
export function kindOfLibrary(bytes) {
  if (bytes.length >= 20 && bytes.readUInt32BE(0) === 0x7f454c46) return elfMachines[bytes.readUInt16LE(18)] ?? null;
  if (bytes.length >= 8 && bytes.readUInt32LE(0) === 0xfeedfacf) return `macho-${machoMachines[bytes.readUInt32LE(4)] ?? 'other'}`;
  if (bytes.length >= 8 && bytes.readUInt32BE(0) === 0xcafebabe) {
    const found = Array.from({ length: Math.min(bytes.readUInt32BE(4), Math.floor((bytes.length - 8) / 20)) }, (_, index) => machoMachines[bytes.readUInt32BE(8 + 20 * index)]);
    return found.includes('arm64') && found.includes('x86-64') ? 'macho-universal' : null;
  }
  if (bytes.length >= 64 && bytes.toString('latin1', 0, 2) === 'MZ') {
    const header = bytes.readUInt32LE(60);
    const isPe = header + 6 <= bytes.length && bytes.toString('latin1', header, header + 4) === 'PE\0\0';
    return isPe ? (peMachines[bytes.readUInt16LE(header + 4)] ?? null) : null;
  }
  return null;
}

function beginningOf(file) {
  const bytes = Buffer.alloc(4096);
  const descriptor = openSync(file, 'r');
  try {
    return bytes.subarray(0, readSync(descriptor, bytes, 0, bytes.length, 0));
  } finally {
    closeSync(descriptor);
  }
}

/** Builds the library of this machine and of every configured preset, so that no library in the package is out of date. */
export async function buildNatives() {
  const own = process.platform === 'darwin' ? 'macos' : 'release';
  const configured = platforms.flatMap(({ presets }) => presets).filter((preset) => existsSync(inRepository(presetFolder(preset), 'build.ninja')));
  for (const preset of new Set([own, ...configured])) {
    if (preset === androidPreset) await rebuildAndroid();
    else await buildNative({ preset, targets: ['audioplugin_haptoflow'] });
  }
}

/** Folders that may hold a platform's library. HAPTOFLOW_NATIVE_DIR replaces the folder of the preset "release". */
export function foldersFor(platform) {
  const folderOf = (preset) => (preset === 'release' && process.env.HAPTOFLOW_NATIVE_DIR) || inRepository(presetFolder(preset));
  // Visual Studio writes to a subfolder named after the configuration.
  return platform.presets.map(folderOf).flatMap((folder) => [folder, path.join(folder, 'Release')]);
}

/**
 * Finds the built libraries, and the platforms without one.
 * @param {(platform: object) => string[]} folders where to look, in this order
 * @returns {{found: {platform: object, file: string}[], absent: {platform: object, why: string}[]}}
 */
export function findNatives(folders = foldersFor) {
  const found = [];
  const absent = [];
  for (const platform of platforms) {
    const files = folders(platform).map((folder) => path.join(folder, path.basename(platform.place)));
    const file = files.find((candidate) => existsSync(candidate) && kindOfLibrary(beginningOf(candidate)) === platform.kind);
    const [preset] = platform.presets;
    if (file) found.push({ platform, file });
    else absent.push({ platform, why: `not built; the preset ${preset} needs ${platform.needs}` });
  }
  return { found, absent };
}
