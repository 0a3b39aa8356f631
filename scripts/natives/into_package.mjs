import { copyFileSync, mkdirSync } from 'node:fs';
import path from 'node:path';
import { inRepository } from '../lib/process.mjs';
import { packageName } from '../pack/layout.mjs';
import { pluginsFolder } from '../pack/natives.mjs';

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
