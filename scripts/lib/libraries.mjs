import { createHash } from 'node:crypto';
import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { dependencyName } from '../pack/dependency.mjs';
import { exportedNames } from '../pack/binaries.mjs';
import { packageName } from '../pack/layout.mjs';
import { complaintOfGlibc, kindOfLibrary, platforms, pluginsFolder } from '../pack/natives.mjs';
import { sha256OfBytes } from './measured_part.mjs';
import { inRepository, repositoryRoot } from './process.mjs';

/** The entry point that Unity looks up by name; Unity's plugin SDK declares it, not haptoflow.h. */
const unitysEntry = 'UnityGetAudioEffectDefinitions';

const header = () => readFileSync(inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h'), 'utf8');

/** The names that the library must export, from the text of haptoflow.h. Tests/Native/capi/exports_test.cpp checks the same of an ELF. */
export function declaredNames(headerText = header()) {
  return [...headerText.matchAll(/^HAPTOFLOW_API [^(;]*?(haptoflow_\w+)\(/gm)].map(([, name]) => name).concat(unitysEntry).sort();
}

/** How the exported names of a library differ from those of the header: a line for each kind. */
export function complaintsOfExports(file) {
  const [declared, exported] = [declaredNames(), exportedNames(file)];
  const missing = declared.filter((name) => !exported.includes(name));
  const unwanted = exported.filter((name) => !declared.includes(name));
  return [
    ...(missing.length > 0 ? [`does not export ${missing.join(', ')} of haptoflow.h`] : []),
    ...(unwanted.length > 0 ? [`exports ${unwanted.join(', ')}, which haptoflow.h does not declare`] : []),
  ];
}

/** What the build of the plugin reads in the repository; headless, bench and cli are not in the plugin. */
const roots = ['CMakeLists.txt', 'CMakePresets.json', 'NativePlugin/CMakeLists.txt', 'NativePlugin/cmake', 'NativePlugin/include', 'NativePlugin/profiles', 'NativePlugin/src'];

// An editor's backup beside a source is no source.
const read = /\.(c|cpp|h|hpp|in|cmake|txt|json|map)$/;

/** Unity's plugin interface, whose structs the library shares with Unity. */
const unitysHeader = 'NativePlugin/src/unity/audio_effect_sdk.hpp';
const publicHeader = 'NativePlugin/include/haptoflow/haptoflow.h';

/** The text of a file with the line ends of git, whatever a checkout on Windows made of them. */
const textOf = (root, name) => readFileSync(path.join(root, name), 'utf8').replaceAll('\r\n', '\n');

function filesBelow(root, name) {
  if (statSync(path.join(root, name)).isFile()) return [name];
  return readdirSync(path.join(root, name)).flatMap((entry) => filesBelow(root, `${name}/${entry}`));
}

/** The files that the build of the plugin reads, relative to the repository, in one order on every system. */
export const sourceFiles = (root = repositoryRoot) => roots.flatMap((name) => filesBelow(root, name)).filter((name) => read.test(name)).sort();

const hashOf = (parts) => {
  const hash = createHash('sha256');
  for (const part of parts) hash.update(`${Buffer.byteLength(part)}:${part}`);
  return hash.digest('hex');
};

/** A hash of everything that the build of the plugin reads: the sources, and which ONNX Runtime's headers. */
export function hashOfSources(root = repositoryRoot) {
  const runtime = JSON.parse(textOf(root, 'package.json')).devDependencies[dependencyName];
  return hashOf([`${dependencyName} ${runtime}`, ...sourceFiles(root).flatMap((name) => [name, textOf(root, name)])]);
}

/** Declarations without comments and spacing, which change no layout. */
const bare = (code) => code.replace(/\/\*[\s\S]*?\*\/|\/\/[^\n]*/g, ' ').replace(/\s+/g, ' ').trim();

/**
 * A hash of what the library's callers depend on: version, functions, enums and structs of haptoflow.h, the structs that it
 * shares with Unity, and the exported names. C#'s structs are compared with the library itself (LibraryAgreement).
 */
export function hashOfInterface(root = repositoryRoot) {
  const header = textOf(root, publicHeader);
  return hashOf([bare(header), bare(textOf(root, unitysHeader)), ...declaredNames(header)]);
}

/** The command that builds the libraries in git anew. */
export const renewal = '`npm run natives`';

/** The platforms whose library is in git: those of editors, and Linux arm64. */
export const committedPlatforms = platforms.filter(({ isInGit }) => isInGit);

/** The most bytes that a library in git may have: every clone carries each version of it. */
export const largestBytes = 3.5e6;

/** Where a platform's library lies in the package. */
export const fileInPackage = ({ place }) => inRepository('Packages', packageName, pluginsFolder, place);

const recordFile = inRepository('NativePlugin', 'natives.json');

/**
 * What the libraries in git were built from, and what they are.
 * @returns {{interface: string, sources: string, files: Record<string, {bytes: number, sha256: string}>}} files: by the
 *   platforms' ids
 */
export const readRecord = (file = recordFile) => JSON.parse(readFileSync(file, 'utf8'));

/** Records the libraries that lie in the package as built from the sources of now. */
export function writeRecord() {
  const files = Object.fromEntries(committedPlatforms.map((platform) => {
    const bytes = readFileSync(fileInPackage(platform));
    return [platform.id, { bytes: bytes.length, sha256: sha256OfBytes(bytes) }];
  }));
  writeFileSync(recordFile, `${JSON.stringify({ interface: hashOfInterface(), sources: hashOfSources(), files }, null, 2)}\n`);
}

/** Whether the libraries in git were built from the sources of now. */
export const areOfTheseSources = (record = readRecord()) => record.sources === hashOfSources();

/** What is wrong with a platform's library that was just built, by binutils too: a line for each complaint. */
export function complaintsOf(platform, file) {
  const bytes = readFileSync(file);
  const kind = kindOfLibrary(bytes);
  if (kind !== platform.kind) return [`${platform.id}: is ${kind ?? 'no library'}; expected ${platform.kind}`];
  const glibc = complaintOfGlibc(platform, bytes);
  return [
    ...(bytes.length > largestBytes ? [`has ${bytes.length} bytes; expected ${largestBytes} at most`] : []),
    ...(glibc === null ? [] : [glibc]),
    ...complaintsOfExports(file),
  ].map((complaint) => `${platform.id}: ${complaint}`);
}

/** Where the libraries in git are not those of their record, which were looked at before it was written: a line for each. */
export function complaintsOfRecord(record = readRecord()) {
  const isRecorded = (platform) => {
    const bytes = existsSync(fileInPackage(platform)) ? readFileSync(fileInPackage(platform)) : Buffer.alloc(0);
    return record.files[platform.id]?.bytes === bytes.length && record.files[platform.id]?.sha256 === sha256OfBytes(bytes);
  };
  return committedPlatforms.filter((platform) => !isRecorded(platform))
    .map(({ id }) => `${id}: is not the file that NativePlugin/natives.json records: ${renewal} builds it anew`);
}

/** Why the system cannot load a library, null where it can: of a good one Node says only that it is no module of Node's. */
export function complaintOfLoading(file) {
  try {
    process.dlopen({ exports: {} }, file);
  } catch (error) {
    const { message } = error;
    return message.includes('did not self-register') ? null : message;
  }
  return null;
}

/** The platforms' libraries in git, for `findNatives`: null for a platform without one, and where the sources are newer. */
export function committedNatives() {
  const isCurrent = existsSync(recordFile) && areOfTheseSources();
  return (platform) => (isCurrent && platform.isInGit && existsSync(fileInPackage(platform)) ? fileInPackage(platform) : null);
}

/**
 * Import settings of the libraries that are not in git. Unity deletes a .meta without its file from a project, so that they
 * lie here, at the same places as below Runtime/Plugins.
 */
export const importFolder = 'NativePlugin/import';

/**
 * Puts a built library, its .meta and those of its folders into the package of this project, where git ignores them.
 * @param {string} place below Runtime/Plugins @param {string} file the built library
 * @returns {string} where the library lies now, relative to the repository
 */
export function putIntoPackage(place, file, root = inRepository()) {
  const pieces = place.split('/');
  const plugins = path.join(root, 'Packages', packageName, pluginsFolder);
  mkdirSync(path.join(plugins, ...pieces.slice(0, -1)), { recursive: true });
  for (const [index] of pieces.entries()) {
    const meta = path.join(...pieces.slice(0, index + 1)).concat('.meta');
    copyFileSync(path.join(root, importFolder, meta), path.join(plugins, meta));
  }
  copyFileSync(file, path.join(plugins, place));
  return path.posix.join('Packages', packageName, pluginsFolder, place);
}
