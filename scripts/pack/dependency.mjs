import { existsSync, readFileSync, readdirSync, statSync } from 'node:fs';
import path from 'node:path';
import { shippedModel } from '../lib/measured_part.mjs';
import { CommandError, inRepository } from '../lib/process.mjs';
import { isNewerThan, neededGlibc } from './binaries.mjs';
import { manifestPath } from './layout.mjs';
import { oldestGlibc } from './natives.mjs';
import { makeTarball } from './package_files.mjs';

/** The package that HaptoFlow depends on: ONNX Runtime for Unity, installed by npm. */
export const dependencyName = 'com.github.asus4.onnxruntime';

/**
 * Where that package keeps a platform's libraries: a folder, or an archive with a folder in it; and the name of ONNX Runtime's
 * own library there.
 */
export const runtimePlaces = {
  'linux-x64': { folder: 'Plugins/Linux/x64', library: 'libonnxruntime.so' },
  'windows-x64': { folder: 'Plugins/Windows/x64', library: 'onnxruntime.dll' },
  macos: { folder: 'Plugins/macOS/arm64', library: 'libonnxruntime.dylib' },
  'android-arm64': { archive: 'Plugins/Android/onnxruntime.aar', folder: 'jni/arm64-v8a' },
};

/** ONNX Runtime's library for the editor or player of a desktop platform, by the platform's id. */
export const runtimeLibrary = (id) => inRepository('node_modules', dependencyName, runtimePlaces[id].folder, runtimePlaces[id].library);

const readJson = (file) => JSON.parse(readFileSync(file, 'utf8'));

/**
 * Writes the dependency's tarball beside HaptoFlow's, so that a project needs no scoped registry: npm packs the package, as
 * its author's npm did, licence and notices included. An existing tarball is kept: a published version never changes.
 * @param {string} destination folder for the tarball
 * @param {{source?: string, manifest?: string}} options the unpacked package, and the manifest that names its version
 * @returns {Promise<{file: string, bytes: number, isNew: boolean}>}
 */
export async function packDependency(destination, { source = inRepository('node_modules', dependencyName), manifest = manifestPath } = {}) {
  const wanted = readJson(manifest).dependencies[dependencyName];
  const { name, version } = existsSync(path.join(source, 'package.json')) ? readJson(path.join(source, 'package.json')) : {};
  if (name !== dependencyName || version !== wanted) {
    throw new CommandError(`${source}: holds ${name ? `${name} ${version}` : 'no package'}; expected ${dependencyName} ${wanted}: run \`npm ci\``);
  }
  if (!existsSync(path.join(source, 'LICENSE'))) throw new CommandError(`${source}: has no LICENSE; it must go with the package: run \`npm ci\``);
  const file = path.join(destination, `${name}-${version}.tgz`);
  const isNew = !existsSync(file);
  if (isNew) await makeTarball(source, destination);
  return { file, bytes: statSync(file).size, isNew };
}

/** The files of a ZIP archive with their sizes when unpacked, from its central directory. */
export function filesOfZip(bytes) {
  const end = bytes.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1'));
  if (end < 0 || end + 22 > bytes.length) throw new RangeError('no ZIP archive');
  const files = [];
  let place = bytes.readUInt32LE(end + 16);
  for (let left = bytes.readUInt16LE(end + 10); left > 0; left -= 1) {
    const [nameBytes, extraBytes, commentBytes] = [28, 30, 32].map((offset) => bytes.readUInt16LE(place + offset));
    files.push({ name: bytes.toString('utf8', place + 46, place + 46 + nameBytes), bytes: bytes.readUInt32LE(place + 24) });
    place += 46 + nameBytes + extraBytes + commentBytes;
  }
  return files;
}

/** Bytes of ONNX Runtime's libraries on a platform's device; 0 where its package has none. */
export function runtimeBytes(id, root = inRepository('node_modules', dependencyName)) {
  const { archive, folder } = runtimePlaces[id] ?? {};
  if (folder === undefined) return 0;
  const files = archive
    ? filesOfZip(readFileSync(path.join(root, archive))).filter(({ name }) => name.startsWith(`${folder}/`))
    : (existsSync(path.join(root, folder)) ? readdirSync(path.join(root, folder)) : []).map((name) => ({ name, bytes: statSync(path.join(root, folder, name)).size }));
  return files.filter(({ name }) => /\.(so|dll|dylib)$/.test(name)).reduce((sum, { bytes }) => sum + bytes, 0);
}

const mebibytes = (bytes) => (bytes / 2 ** 20).toFixed(1);

/** What a person has to know of a platform's library beyond its size. */
function noteOf(platform, glibc, isFromGit) {
  const notes = isFromGit ? ['as in git'] : [];
  if (glibc !== null) {
    const remedy = isNewerThan(glibc, oldestGlibc) ? `: built on Debian 12 it would need ${oldestGlibc.join('.')} at most` : '';
    notes.push(`needs glibc ${glibc.join('.')}${remedy}`);
  }
  if (runtimeBytes(platform.id) === 0) notes.push('bring ONNX Runtime for it yourself: its package has none');
  return notes.join('; ');
}

/**
 * The table of what a tarball holds: a line for each platform with the sizes in MiB that it takes on a device, then the
 * missing platforms with the command that adds each.
 * @param {{found: {platform: object, file: string, isFromGit?: boolean}[], absent: {platform: object, why: string}[]}} natives
 */
export function tableOfContents({ found, absent }) {
  const model = statSync(shippedModel).size;
  const rows = found.map((entry) => {
    const [own, runtime] = [statSync(entry.file).size, runtimeBytes(entry.platform.id)];
    const cells = [own, model, runtime, own + model + runtime].map(mebibytes);
    if (runtime === 0) cells[2] = '-';
    return [entry.platform.name, ...cells, noteOf(entry.platform, neededGlibc(readFileSync(entry.file)), entry.isFromGit)];
  });
  const head = ['on the device, MiB', 'library', 'model', 'ONNX Runtime', 'together', ''];
  const lines = [head, ...rows].map(([name, own, of, runtime, sum, note]) =>
    `  ${name.padEnd(20)}${own.padStart(8)}${of.padStart(8)}${runtime.padStart(14)}${sum.padStart(10)}  ${note}`.trimEnd());
  return [...lines, ...absent.map(({ platform, why }) => `  ${platform.name.padEnd(20)}missing: ${why}`)];
}
