import { existsSync } from 'node:fs';
import path from 'node:path';
import { judgeAndroidPages } from './android_pages.mjs';
import { judgeCommittedTouch } from './committed_touch.mjs';
import { judgeExportsOfDll } from './exported_names.mjs';
import { judgeJunit, results } from './judge_junit.mjs';
import { buildNative, presetFolder } from './native_build.mjs';
import { runsOnOldGlibc } from './old_glibc.mjs';
import { runNpmOrFail } from './process.mjs';
import { inRepository } from './repository.mjs';
import { addCounts, noCounts } from './test_counts.mjs';

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
    { because: 'how a trained network sounds does not depend on this compiler, and the shorter tests of the same network run', tests: ['Label/*', '*Shipped*', 'BlendSoundTest.EveryBlendLies*'] },
    { because: 'the races that a storm of threads finds are those of the code; sanitizers watch it, too', tests: ['ApiStorm*'] },
  ],
  'linux-arm64': [
    {
      because: 'a trained network generates seconds of sound, or a level for each of hundreds of motions',
      tests: ['Label/*', 'OnModel/*', '*Shipped*', 'BlendSoundTest.*', 'AddedLabelTest.*', 'RangeSweepTest.*', 'OnsetLevelsCostTest.TheGraphIsEvaluatedAt640Points*',
        'MaterialApiTest.RegisteringReplacingAndTouching*', 'LoadingApiTest.ATierThatIsTooSlow*'],
    },
    {
      because: 'a material is learnt, which asks the network hundreds of times, or registered thousands of times',
      tests: ['LearningApiTest.*', 'DescriptorSizesTest.AnInputOfA*', 'ArgumentTest.NullPointers*', 'MaterialApiTest.ThousandsOfReplacements*'],
    },
    {
      because: 'qemu runs threads in the memory order of this machine, so that a storm of them finds there what it finds here',
      tests: ['ApiStorm*', 'MaterialLibraryTest.PublishersReadConsistentMaterials*', 'SegmentQueueTest.NoSegmentIsLostOrTorn*', 'VoiceTableTest.ASecondThreadThatRenders*', 'VoiceTableTest.EachBlockIsRenderedOnce*',
        'MaterialApiTest.VoicesPublishRenderAndGenerate*', 'LiveEngineTest.ManyConcurrentVoices*'],
    },
    { because: 'it depends on the pace of threads or on measured time, which emulation changes', tests: ['EngineApiTest.TheWorkerServesAVoiceInRealTime', '*MeasuredTime*', '*TenMinutes*'] },
    { because: 'millions of small steps that other tests of the same code take by the thousand', tests: ['MutationTest.Changed*', 'ProcessorsTest.ProcessorChangesAtAnyTime*'] },
  ],
};

/** Limit for one program, which takes at most a minute on an idle machine: a program that hangs must not lose the results of the others. */
const limitSeconds = 600;

/** The emulator of each platform. */
const emulators = {
  'windows-x64': {
    command: 'wine',
    args: [],
    env: { WINEDEBUG: '-all', WINEPREFIX: inRepository('build', 'wine'), WINEPATH: inRepository(presetFolder('windows-x64')) },
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
      counts = addCounts(counts, judgeExportsOfDll(inRepository(presetFolder(preset), 'audioplugin_haptoflow.dll')));
    }
  }
  console.log('test: pages of the library for Android');
  counts = addCounts(counts, await judgeAndroidPages());
  console.log('test: the Linux library on Debian 11');
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  return addCounts(counts, await runsOnOldGlibc());
}
