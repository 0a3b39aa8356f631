import { existsSync, mkdirSync, readFileSync, renameSync, statSync } from 'node:fs';
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';
import { inRepository } from '../lib/repository.mjs';
import { manifestPath } from './layout.mjs';
import { streamTarball } from './stream_tarball.mjs';

/** The package that HaptoFlow depends on: ONNX Runtime for Unity, installed by npm. */
export const dependencyName = 'com.github.asus4.onnxruntime';

const readJson = (file) => JSON.parse(readFileSync(file, 'utf8'));

/**
 * Writes the dependency's tarball beside HaptoFlow's, so that a project needs no scoped registry. The unpacked package is
 * streamed into it, licence and notices included. An existing tarball is kept: a published version never changes.
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
  if (isNew) await makeWhole(source, destination, file);
  return { file, bytes: statSync(file).size, isNew };
}

/** Writes to a temporary name and renames at the end, so that an interrupted run leaves no incomplete tarball. */
async function makeWhole(source, destination, file) {
  mkdirSync(destination, { recursive: true });
  const partial = `${file}.partial`;
  await streamTarball(source, partial);
  renameSync(partial, file);
}
