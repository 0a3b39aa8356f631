import { existsSync, readFileSync, statSync } from 'node:fs';
import path from 'node:path';
import { CommandError, inRepository } from '../lib/process.mjs';
import { manifestPath } from './layout.mjs';
import { makeTarball } from './tarball.mjs';

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
