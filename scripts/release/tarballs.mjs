import { existsSync, readdirSync } from 'node:fs';
import { CommandError } from '../lib/process.mjs';

/** The name of the one tarball of a package in a folder. */
export function tarballOf(name, folder) {
  const found = existsSync(folder) ? readdirSync(folder).filter((file) => file.startsWith(`${name}-`) && file.endsWith('.tgz')) : [];
  if (found.length !== 1) throw new CommandError(`${folder}: holds ${found.length} tarballs of ${name}; expected one: \`npm run pack\` makes it`);
  return found[0];
}
