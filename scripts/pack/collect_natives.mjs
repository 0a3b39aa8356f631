// Copies native libraries built on other machines to where `npm run pack -- --no-build` finds them; --help
import { copyFileSync, mkdirSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { presetFolder } from '../lib/native_build.mjs';
import { CommandError, callerFolder, inRepository, runMain } from '../lib/process.mjs';
import { findNatives, platforms } from './natives.mjs';

const help = `usage: node scripts/pack/collect_natives.mjs FOLDER [DESTINATION]

Looks below FOLDER for the native library of every platform (${platforms.map(({ id }) => id).join(', ')}) and copies
each to the build folder of its preset, from which \`npm run pack -- --no-build\` takes it. Ends with 1 where a platform
has none.

  DESTINATION  the repository that gets the libraries (this one)`;

/** Every folder at or below a folder. */
const foldersBelow = (folder) =>
  [folder, ...readdirSync(folder, { withFileTypes: true }).filter((entry) => entry.isDirectory()).flatMap(({ name }) => foldersBelow(path.join(folder, name)))];

await runMain('collect_natives', async (words) => {
  const [folder, destination = inRepository()] = words.map((word) => path.resolve(callerFolder(), word));
  if (folder === undefined || words.length > 2) throw new CommandError(`expected a folder\n\n${help}`, 2);
  const folders = foldersBelow(folder);
  const { found, absent } = findNatives(() => folders);
  for (const { platform, file } of found) {
    const place = path.join(destination, presetFolder(platform.presets[0]), path.basename(platform.place));
    mkdirSync(path.dirname(place), { recursive: true });
    copyFileSync(file, place);
    console.log(`collect_natives: ${platform.id}: ${path.relative(destination, place)}`);
  }
  if (absent.length > 0) throw new CommandError(`${folder}: has no library for ${absent.map(({ platform }) => platform.id).join(', ')}`);
}, { help });
