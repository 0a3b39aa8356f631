import { createHash } from 'node:crypto';
import { readFileSync, readdirSync, statSync } from 'node:fs';
import path from 'node:path';
import { declaredNames } from '../lib/exported_names.mjs';
import { repositoryRoot } from '../lib/repository.mjs';
import { dependencyName } from '../pack/dependency.mjs';

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
