import { copyFileSync, cpSync, existsSync, mkdirSync, rmSync } from 'node:fs';
import { committedPlatforms, fileInPackage } from '../natives/committed.mjs';
import { runtimeLibrary } from '../pack/dependency.mjs';
import { shippedModel } from './model_stamp.mjs';
import { presetFolder } from './native_build.mjs';
import { CommandError, runOrFail } from './process.mjs';
import { inRepository } from './repository.mjs';
import { addCounts, countsOfAttempt, noCounts } from './test_counts.mjs';

/** Debian 11: the newest Debian with glibc 2.31, the C library of Ubuntu 20.04. */
const suite = 'bullseye';

/** Makes a bare Debian 11 with a C compiler in a folder, once (330 MB). */
async function makeSystem(folder) {
  if (existsSync(`${folder}/usr/bin/gcc`)) return;
  console.log('setup: debootstrap of Debian 11');
  rmSync(folder, { recursive: true, force: true });
  await runOrFail('debootstrap', ['--variant=minbase', '--include=gcc,libc6-dev', suite, folder], { quiet: true });
}

/** The Linux x64 libraries that are tried: the one built here, and the one in git, which Unity loads in a clone. */
const libraries = () => [
  inRepository(presetFolder('release'), 'libaudioplugin_haptoflow.so'),
  fileInPackage(committedPlatforms.find(({ id }) => id === 'linux-x64')),
];

/**
 * Two tests: in a bare Debian 11 a program opens a Linux x64 library by dlopen, as Unity does, and renders a stroke with the
 * shipped model, ONNX Runtime and the worker's thread. Skipped with a sentence where that system cannot be made: without root
 * or without a network.
 */
export async function runsOnOldGlibc(folder = inRepository('build', 'debian-11')) {
  if (process.getuid?.() !== 0) return skipped('chroot needs root');
  try {
    await makeSystem(folder);
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    return skipped(error.message.trim().split('\n').at(-1));
  }
  const place = `${folder}/haptoflow`;
  rmSync(place, { recursive: true, force: true });
  mkdirSync(place);
  cpSync(inRepository('NativePlugin', 'include'), `${place}/include`, { recursive: true });
  copyFileSync(runtimeLibrary('linux-x64'), `${place}/onnxruntime.so`);
  copyFileSync(shippedModel, `${place}/default.haptoflow`);
  copyFileSync(inRepository('Tests', 'Platforms', 'touch.c'), `${place}/touch.c`);
  let counts = noCounts;
  for (const library of libraries()) {
    copyFileSync(library, `${place}/plugin.so`);
    counts = addCounts(counts, await judgeTouch(folder));
  }
  return counts;
}

function judgeTouch(folder) {
  const commands = 'cd /haptoflow && gcc -std=c11 -Wall -Wextra -Werror -Iinclude touch.c -lm -ldl -o touch && ./touch ./plugin.so ./onnxruntime.so default.haptoflow';
  return countsOfAttempt(async () => {
    console.log(`test: ${(await runOrFail('chroot', [folder, '/bin/sh', '-c', commands], { quiet: true })).trim().split('\n').at(-1)}`);
  });
}

function skipped(why) {
  console.log(`test: the library was not tried with glibc 2.31: ${why}`);
  return { ...noCounts, skipped: libraries().length };
}
