import { copyFileSync, cpSync, existsSync, mkdirSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { runtimeLibrary } from '../pack/dependency.mjs';
import { committedPlatforms, complaintsOfExports, fileInPackage } from './libraries.mjs';
import { shippedModel } from './measured_part.mjs';
import { buildNative, presetFolder } from './native_build.mjs';
import { CommandError, inRepository, runNpmOrFail, runOrFail } from './process.mjs';
import { addCounts, countsOfAttempt, judgeJunit, noCounts, results } from './test_results.mjs';

/** The C compiler for each platform, and its ONNX Runtime. */
const ways = {
  'windows-x64': { compiler: 'x86_64-w64-mingw32-gcc', runtime: runtimeLibrary('windows-x64') },
  'linux-arm64': { compiler: 'aarch64-linux-gnu-gcc', runtime: inRepository('Tests', 'Platforms', 'node_modules', 'onnxruntime-node', 'bin', 'napi-v6', 'linux', 'arm64', 'libonnxruntime.so.1') },
};

/**
 * One test: a program for a platform opens the library in git by its file, as Unity does, and renders a stroke with the shipped
 * model, ONNX Runtime and the worker's thread.
 * @param {string} id of the platform @param {{command: string, args: string[], env: Record<string, string>, suffix: string}} emulator
 */
export function judgeCommittedTouch(id, { command, args, env, suffix }) {
  const { compiler, runtime } = ways[id];
  const folder = inRepository('build', 'touch', id);
  mkdirSync(folder, { recursive: true });
  const program = `${folder}/touch${suffix}`;
  return countsOfAttempt(async () => {
    await runOrFail(compiler, ['-std=c11', '-Wall', '-Wextra', '-Werror', `-I${inRepository('NativePlugin', 'include')}`, inRepository('Tests', 'Platforms', 'touch.c'), '-lm', '-o', program], { quiet: true });
    const library = fileInPackage(committedPlatforms.find((platform) => platform.id === id));
    const output = await runOrFail(command, [...args, program, library, runtime, shippedModel], { env, quiet: true, limitSeconds: 120 });
    // wine adds lines of its own.
    console.log(`test: ${output.split('\n').find((line) => line.includes('of full scale'))}`);
  });
}

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

/** Programs of Tests/Native that run on emulated platforms: parts of the library, then the whole library through its C interface and as a mixer effect. */
const programs = ['model', 'dsp', 'headless', 'engine', 'capi', 'unity'];

/**
 * Tests that an emulated platform leaves out, and why they show nothing there that they do not show natively, where all
 * tests run. ONNX Runtime takes at least 50 times as long under qemu, so that a trained network generates only one or two
 * segments there.
 * @type {Record<string, {because: string, tests: string[]}[]>}
 */
export const leftOut = {
  'windows-x64': [
    { because: 'how a trained network sounds does not depend on this compiler, and the shorter tests of the same network run', tests: ['Label/*', '*Shipped*', 'BlendSoundTest.EveryBlendLies*', 'Pairs/LabelChangeTest.*'] },
    { because: 'the races that a storm of threads finds are those of the code; sanitizers watch it, too', tests: ['ApiStorm*'] },
  ],
  'linux-arm64': [
    {
      because: 'a trained network generates seconds of sound, or a level for each of hundreds of motions',
      tests: ['Label/*', 'OnModel/*', '*Shipped*', 'BlendSoundTest.*', 'AddedLabelTest.*', 'RangeSweepTest.*',
        'LoadingApiTest.ATierThatIsTooSlow*'],
    },
    {
      because: 'a material is learnt, which asks the network hundreds of times',
      tests: ['LearningApiTest.*', 'ArgumentTest.NullPointers*'],
    },
    {
      because: 'qemu runs threads in the memory order of this machine, so that a storm of them finds there what it finds here',
      tests: ['ApiStorm*', 'MaterialLibraryTest.PublishersReadConsistentMaterials*', 'CorrectionQueueTest.NoCorrectionIsLostOrTorn*', 'VoiceTableTest.ASecondThreadThatRenders*', 'VoiceTableTest.EachBlockIsRenderedOnce*',
        'LiveEngineTest.ManyConcurrentVoices*'],
    },
    { because: 'it depends on the pace of threads or on measured time, which emulation changes', tests: ['EngineApiTest.TheWorkerServesAVoiceInRealTime', '*MeasuredTime*', '*FourMinutes*'] },
    { because: 'millions of small steps that other tests of the same code take by the thousand', tests: ['MutationTest.Changed*', 'ProcessorsTest.ProcessorChangesAtAnyTime*'] },
  ],
};

/** Limit for one program, which takes at most a minute on an idle machine: a program that hangs must not lose the results of the others. */
const limitSeconds = 600;

/** Not in the repository: wine links the whole disk into it, and `dotnet format` would walk through that. */
const winePrefix = path.join(os.tmpdir(), 'haptoflow-wine');

/** The emulator of each platform. */
const emulators = {
  'windows-x64': {
    command: 'wine',
    args: [],
    env: { WINEDEBUG: '-all', WINEPREFIX: winePrefix, WINEPATH: inRepository(presetFolder('windows-x64')) },
    suffix: '.exe',
  },
  'linux-arm64': { command: 'qemu-aarch64', args: ['-L', '/usr/aarch64-linux-gnu'], env: {}, suffix: '' },
};

/** Installs ONNX Runtime for Linux arm64 (214 MB), which the Unity package of ONNX Runtime lacks; only these tests need it. */
export async function bringArmRuntime() {
  if (existsSync(inRepository('Tests', 'Platforms', 'node_modules', 'onnxruntime-node'))) return;
  console.log('setup: npm ci in Tests/Platforms (ONNX Runtime for Linux arm64)');
  await runNpmOrFail(['ci', '--prefix', inRepository('Tests', 'Platforms')]);
}

/** Builds the tests for every platform with a cross compiler here, and runs them under emulation. */
export async function platformTests() {
  await bringArmRuntime();
  let counts = noCounts;
  for (const [preset, { command, args, env, suffix }] of Object.entries(emulators)) {
    await buildNative({ preset, tests: true, targets: programs.map((name) => `${name}_tests`) });
    for (const name of programs) {
      const program = inRepository(presetFolder(preset), 'Tests', 'Native', name, `${name}_tests${suffix}`);
      const file = `${preset}-${name}.xml`;
      const without = leftOut[preset].flatMap(({ tests }) => tests).join(':');
      const gtest = [`--gtest_filter=-${without}`, '--gtest_brief=1', `--gtest_output=xml:${path.relative(inRepository(), results(file))}`];
      console.log(`test: ${name} on ${preset}`);
      counts = addCounts(counts, await judgeJunit(file, command, [...args, program, ...gtest], { env, limitSeconds }));
    }
    console.log(`test: the library in git on ${preset}`);
    counts = addCounts(counts, await judgeCommittedTouch(preset, emulators[preset]));
    // The capi tests check the exports of an ELF themselves.
    if (preset === 'windows-x64') {
      console.log(`test: exports on ${preset}`);
      counts = addCounts(counts, await countsOfAttempt(async () => {
        const complaints = complaintsOfExports(inRepository(presetFolder(preset), 'audioplugin_haptoflow.dll'));
        if (complaints.length > 0) throw new CommandError(`the DLL ${complaints.join('; ')}`);
      }));
    }
  }
  console.log('test: the Linux library on Debian 11');
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  return addCounts(counts, await runsOnOldGlibc());
}
