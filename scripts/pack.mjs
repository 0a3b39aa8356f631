// pack: makes the tarballs of both Unity packages and ONNX Runtime's beside them, in out/ (--no-build, --help)
import { mkdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { repositoryFiles } from './lib/lint_checks.mjs';
import { CommandError, inRepository, parsed, runMain } from './lib/process.mjs';
import { committedNatives } from './lib/libraries.mjs';
import { checkPackage } from './pack/check_package.mjs';
import { packDependency, tableOfContents } from './pack/dependency.mjs';
import { buildNatives, complaintOfGlibc, findNatives, foldersFor, platforms } from './pack/natives.mjs';
import { makeTarball, PackageFiles } from './pack/package_files.mjs';

const help = `usage: npm run pack -- [--no-build] [--require NAMES] [--help]

Builds the native libraries that this machine can build, puts the package together in out/package, checks it as Unity would
read it, and makes out/com.haptoflow.runtime-VERSION.tgz. Beside it go the tarball of com.github.asus4.onnxruntime (ONNX Runtime
for Unity), which the package needs, and that of com.haptoflow.studies, the user studies. Lines at the end say where to click in
Unity.

  --no-build   pack the libraries that are in build/ (HAPTOFLOW_NATIVE_DIR replaces build/native), or in git
  --require    names of platforms whose library must go in, for example linux-x64,windows-x64,android-arm64: without one of
               them, or with one for a newer glibc than Ubuntu 20.04's, no tarball is made and the exit code is 1
  --help       this text

On Debian for x64 the libraries of Linux x64, Linux arm64 and Windows x64 are built; the cross compilers are installed first
(125 MB to download). Android's is built where an NDK is found: Unity's own, or that of ANDROID_NDK_ROOT. The first run
compiles each library for up to five minutes of one core; later runs compile what changed.

What goes in: Packages/com.haptoflow.runtime with the model, Samples~ (with the scene Workshop of Assets), Documentation~, the
tests in Tests/Unity, and a native library for each platform that has one; the pages of the studies go with them. One command adds one library, then pack again:

${platforms.map(({ name, id, where }) => `  ${name.padEnd(15)} npm run build -- --platform ${id.padEnd(14)} ${where}`).join('\n')}

A library that was built on another machine goes to the same place below build/. Where none was built, that of git goes in
(${platforms.filter(({ isInGit }) => isInGit).map(({ name }) => name).join(', ')}), unless the sources are newer. The table at the end lists platforms
with their size on a device, and platforms without a library; there, scenes go on without haptics. Without any library no
tarball is made and the exit code is 1.`;

function requiredPlatforms(names) {
  return names.split(',').map((name) => name.trim()).filter((name) => name !== '').map((name) => {
    const platform = platforms.find(({ id }) => id === name);
    if (!platform) throw new CommandError(`--require ${name}: expected some of ${platforms.map(({ id }) => id).join(', ')}`, 2);
    return platform;
  });
}

/** Refuses to pack without any library, or without one that --require names and old systems load: scenes would be silent. */
function requireNatives({ found, absent }, required) {
  if (found.length === 0) {
    throw new CommandError(`there is no native library, and without one every scene is silent; no tarball was made\n${absent.map(({ platform, why }) => `  ${platform.name}: ${why}`).join('\n')}`);
  }
  const lacking = absent.filter(({ platform }) => required.includes(platform));
  const tooNew = found.filter(({ platform }) => required.includes(platform)).map(({ platform, file }) => [platform.id, complaintOfGlibc(platform, readFileSync(file))]).filter(([, why]) => why !== null);
  const complaints = [...lacking.map(({ platform, why }) => `without ${platform.id}: ${why}`), ...tooNew.map(([id, why]) => `${id}: ${why}`)];
  if (complaints.length > 0) throw new CommandError(`--require: no tarball was made\n  ${complaints.join('\n  ')}`);
}

const mebibytes = (bytes) => `${(bytes / 2 ** 20).toFixed(1)} MiB`;

await runMain('pack', async (words) => {
  const { values: options } = parsed(words, { 'no-build': { type: 'boolean', default: false }, require: { type: 'string', default: '' } });
  const required = requiredPlatforms(options.require);
  const failed = options['no-build'] ? new Set() : await buildNatives();
  const { found, absent } = findNatives(foldersFor, failed, committedNatives());
  requireNatives({ found, absent }, required);
  const folder = inRepository('out', 'package');
  // Imported here, since set-up may just have installed the package that it needs.
  const { stagePackage, stageStudies } = await import('./pack/stage.mjs');
  const [names, ofStudies] = [await repositoryFiles(), inRepository('out', 'studies')];
  stagePackage(folder, names, found);
  stageStudies(ofStudies, names);
  const [files, studies] = [folder, ofStudies].map((each) => PackageFiles.inFolder(each));
  const complaints = [...checkPackage(files), ...checkPackage(studies, files)];
  if (complaints.length > 0) {
    throw new CommandError(`${complaints.join('\n')}\n${complaints.length} things that Unity would refuse, leave out or lose; no tarball was made`);
  }
  console.log(`pack: ${files.names.length} files and ${studies.names.length} of the studies, checked`);

  mkdirSync(inRepository('out'), { recursive: true });
  console.log('pack: packing ONNX Runtime (385 MB) and HaptoFlow');
  const runtime = await packDependency(inRepository('out'));
  const tarballs = [runtime, await makeTarball(folder, inRepository('out')), await makeTarball(ofStudies, inRepository('out'))];
  console.log(`\n${tableOfContents({ found, absent }).join('\n')}\n`);
  console.log('In Unity: Window > Package Manager > + > Install package from tarball... (2022.3: Add package from tarball...), in this order:');
  for (const [index, { file, bytes }] of tarballs.entries()) console.log(`  ${index + 1}. ${file} (${mebibytes(bytes)})${index === 2 ? ', for user studies only' : ''}`);
  return 0;
}, { help });
