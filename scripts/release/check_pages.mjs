// Checks that Android devices with pages of 16 KiB load a library; --help
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { androidPageBytes } from '../lib/android_pages.mjs';
import { CommandError, runMain } from '../lib/process.mjs';
import { callerFolder } from '../lib/repository.mjs';
import { loadAlignment } from '../pack/elf.mjs';
import { kindOfLibrary } from '../pack/natives.mjs';

const help = `usage: node scripts/release/check_pages.mjs LIBRARY

Reads the program headers of an Android library. Ends with 1 unless its segments are aligned to ${androidPageBytes} bytes or more.`;

await runMain('check_pages', async ([word, ...others]) => {
  if (word === undefined || others.length > 0) throw new CommandError(`expected one library\n\n${help}`, 2);
  const file = path.resolve(callerFolder(), word);
  if (!existsSync(file)) throw new CommandError(`${file}: is not there; \`npm run build -- --platform android-arm64\` makes it`, 2);
  const bytes = readFileSync(file);
  const kind = kindOfLibrary(bytes);
  if (kind !== 'android-arm64') throw new CommandError(`${file}: is ${kind ?? 'no library'}; expected android-arm64`);
  const alignment = loadAlignment(bytes);
  if (alignment < androidPageBytes) throw new CommandError(`${file}: segments are aligned to ${alignment} bytes, expected ${androidPageBytes}: link with -z max-page-size=${androidPageBytes}`);
  console.log(`check_pages: ${path.basename(file)}: segments are aligned to ${alignment} bytes`);
}, { help });
