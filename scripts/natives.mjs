// natives: builds the libraries that are in git anew, checks them and records what they were built from (--help)
import { copyFileSync, existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { buildNative, presetFolder } from './lib/native_build.mjs';
import { CommandError, inRepository, runMain } from './lib/process.mjs';
import { onDebian, setUp } from './lib/setup.mjs';
import { committedPlatforms, complaintsOf, fileInPackage, largestBytes, writeRecord } from './lib/libraries.mjs';

const help = `usage: npm run natives [-- --help]

Git has the native libraries of ${committedPlatforms.map(({ name }) => name).join(', ')}, so that Unity plays a clone without a compiler.
This builds them anew as \`npm run pack\` does, on Debian 12 for x64, and installs the cross compilers first. Each must be of
its platform, export the functions of haptoflow.h and no others, need no newer glibc than Ubuntu 20.04 has, and take
${largestBytes / 1e6} MB at most. Then they go into the package, and NativePlugin/natives.json records their hashes with those of the
sources and of the C interface. The same sources make the same bytes.

When: before a commit that changes haptoflow.h, which the package's tests require, and before a release. Lint says when the
sources are newer. Every version stays in git's history (about 4 MB), so not at every change.`;

const megabytes = (bytes) => `${(bytes / 1e6).toFixed(2)} MB`;

await runMain('natives', async () => {
  if (!onDebian() || process.arch !== 'x64') throw new CommandError('the libraries in git are built on Debian 12 for x64, whose compilers make all of them', 2);
  await setUp(['build', 'cross']);
  const built = [];
  for (const platform of committedPlatforms) {
    const [preset] = platform.presets;
    await buildNative({ preset, targets: ['audioplugin_haptoflow'] });
    built.push({ platform, file: inRepository(presetFolder(preset), path.basename(platform.place)) });
  }
  const complaints = built.flatMap(({ platform, file }) => complaintsOf(platform, file));
  if (complaints.length > 0) throw new CommandError(`${complaints.join('\n')}\nnothing was changed`);
  for (const { platform, file } of built) {
    const place = fileInPackage(platform);
    const bytes = readFileSync(file);
    const isSame = existsSync(place) && readFileSync(place).equals(bytes);
    if (!isSame) copyFileSync(file, place);
    console.log(`natives: ${platform.id}: ${megabytes(bytes.length)}, ${isSame ? 'as it was' : 'new'}`);
  }
  writeRecord();
  return 0;
}, { help, takesWords: false });
