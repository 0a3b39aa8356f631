// Checks the tarballs of the Unity packages as `npm run pack` checks the folders that it packs; --help
import { existsSync } from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { CommandError, callerFolder, runMain } from '../lib/process.mjs';
import { checkPackage } from '../pack/check_package.mjs';
import { complaintOfGlibc, oldestGlibc, platforms, pluginsFolder } from '../pack/natives.mjs';
import { readTarball } from '../pack/package_files.mjs';

const help = `usage: node scripts/release/check_tarball.mjs FILE [STUDIES] [--require NAMES]

Unpacks FILE, and STUDIES, the tarball of the studies that needs it, and checks them for what Unity would refuse, leave
out or lose, and that a library of Linux needs no newer glibc than ${oldestGlibc.join('.')}. Ends with 1 and one line for each
complaint.

  --require NAMES  platforms whose library must be there: ${platforms.map(({ id }) => id).join(',')}`;

/** What is wrong with a package's files: the checker's complaints, libraries that are missing, and those for newer systems. */
function complaintsOf(files, required) {
  const natives = platforms.flatMap((platform) => {
    const { id, place } = platform;
    const name = `${pluginsFolder}/${place}`;
    if (!files.has(name)) return required.includes(id) ? [`${name}: is missing; it is the library of ${id}`] : [];
    const complaint = complaintOfGlibc(platform, files.bytes(name));
    return complaint === null ? [] : [`${name}: ${complaint}`];
  });
  return [...checkPackage(files), ...natives];
}

await runMain('check_tarball', async (words) => {
  let parsed;
  try {
    parsed = parseArgs({ args: words, options: { require: { type: 'string', default: '' } }, allowPositionals: true });
  } catch (error) {
    throw new CommandError(error.message, 2);
  }
  const { values, positionals } = parsed;
  if (positionals.length < 1 || positionals.length > 2) throw new CommandError(`expected one tarball, or that of the studies behind it\n\n${help}`, 2);
  const required = values.require.split(',').filter((name) => name !== '');
  const unknown = required.find((name) => !platforms.some(({ id }) => id === name));
  if (unknown !== undefined) throw new CommandError(`--require ${unknown}: expected some of ${platforms.map(({ id }) => id).join(', ')}`, 2);
  const tarballs = positionals.map((word) => path.resolve(callerFolder(), word));
  const missing = tarballs.find((file) => !existsSync(file));
  if (missing !== undefined) throw new CommandError(`${missing}: is not there; \`npm run pack\` makes it`, 2);
  const [files, studies] = await Promise.all(tarballs.map(readTarball));
  const complaints = [...complaintsOf(files, required), ...(studies ? checkPackage(studies, files) : [])];
  complaints.forEach((complaint) => console.error(complaint));
  console.log(`check_tarball: ${files.names.length} files, ${complaints.length === 0 ? 'good' : `${complaints.length} complaints`}`);
  return complaints.length > 0 ? 1 : 0;
}, { help });
