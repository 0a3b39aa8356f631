import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';
import { inRepository } from '../lib/repository.mjs';
import { repositoryFiles } from '../lint/files.mjs';
import { dependencyName } from '../pack/dependency.mjs';
import { packageName, studiesName } from '../pack/layout.mjs';
import { PackageFiles } from '../pack/package_files.mjs';

/** Folders of the repository into which Unity writes a .meta for every asset, and deletes every .meta without one. */
export const writableFolders = ['Assets', `Packages/${packageName}`, `Packages/${studiesName}`, 'Tests/Unity'];

/** The list of the project's packages. */
export const manifestName = 'Packages/manifest.json';

const isOfProject = (name) => name.startsWith('ProjectSettings/') || name === manifestName || writableFolders.some((folder) => name.startsWith(`${folder}/`));

/** The files of the Unity project in the repository's root that git tracks or would track, by their names in the repository. */
export async function projectFiles() {
  const names = (await repositoryFiles()).filter(isOfProject);
  return new PackageFiles(new Map(names.map((name) => [name, readFileSync(inRepository(name))])));
}

/** The project as it lies on disk, also where there is no git: with what Unity, a build or a ZIP without .gitignore added. */
export function projectFilesOnDisk() {
  const contents = new Map();
  for (const folder of ['ProjectSettings', ...writableFolders].filter((name) => existsSync(inRepository(name)))) {
    const files = PackageFiles.inFolder(inRepository(folder));
    for (const name of files.names) contents.set(`${folder}/${name}`, files.bytes(name));
  }
  const manifest = inRepository(manifestName);
  if (!existsSync(manifest)) throw new CommandError(`${manifest}: is missing`);
  contents.set(manifestName, readFileSync(manifest));
  return new PackageFiles(contents);
}

/**
 * The project with what `npm ci` brings: of ONNX Runtime for Unity only the manifest, the .meta files and the assembly
 * definitions, since its libraries are large. Without `npm ci` the same as `files`.
 * @param {PackageFiles} files
 */
export function withDependency(files) {
  const folder = inRepository('node_modules', dependencyName);
  if (!existsSync(folder)) return files;
  const brought = PackageFiles.inFolder(folder, (name) => /\.(meta|asmdef)$|^package\.json$/.test(name));
  const contents = new Map(files.contents);
  for (const name of brought.names) contents.set(path.posix.join('node_modules', dependencyName, name), brought.bytes(name));
  return new PackageFiles(contents);
}
