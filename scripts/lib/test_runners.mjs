import { existsSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { dotnetEnvironment, findDotnet } from './dotnet.mjs';
import { judgeJunit, results } from './judge_junit.mjs';
import { buildNative, presetFolder } from './native_build.mjs';
import { platformTests } from './platform_tests.mjs';
import { CommandError, run, succeeds } from './process.mjs';
import { inRepository } from './repository.mjs';
import { pythonOrFail } from './setup.mjs';
import { addCounts, countsOfTap, countsOfTrx, judged, noCounts } from './test_counts.mjs';

/**
 * What runs under which sanitizers: folders of Tests/Native, and of their tests those that the sanitizers are for
 * (programs that read untrusted input, hand memory across the C ABI, or share it between threads).
 */
const sanitized = [
  { preset: 'asan-ubsan', folder: 'model' },
  { preset: 'asan-ubsan', folder: 'headless' },
  { preset: 'asan-ubsan', folder: 'engine', tests: 'LiveVoice|LiveEngine|StallTest|LeadTest|WaveformTimeline|MaterialLibrary|ToneVoice|SignalVoice' },
  { preset: 'asan-ubsan', folder: 'learning', except: 'LearnerTest' },
  { preset: 'asan-ubsan', folder: 'capi', except: 'ClosedLoop|Hard(Case|Scene)Test.*Shipped|RangeSweepSound' },
  { preset: 'tsan', folder: 'engine', tests: 'LiveEngine|Mailbox|SegmentQueue|MaterialLibrary' },
  { preset: 'asan-ubsan', folder: 'unity' },
  { preset: 'tsan', folder: 'capi', tests: 'ApiStorm|EngineApi|GeneratorApi|MaterialApi|VoiceTable' },
  { preset: 'tsan', folder: 'unity', tests: 'AudioThread' },
  // VoiceTable holds a render up inside the voice, which is what this one watches for.
  { preset: 'rtsan', folder: 'capi', except: 'ClosedLoop|Shipped|OpenModel|VoiceTable' },
  { preset: 'rtsan', folder: 'unity' },
];

/** Where Clang 22 is missing, set-up has said where it can be had; its runs count as skipped. */
const canBuild = ({ preset }) => preset !== 'rtsan' || succeeds('clang++-22', ['--version']);

/**
 * The library and the command line as the compiler and the library of Android, macOS and iOS read them, warnings as errors;
 * then that this command line says of a stroke what the other one says.
 */
async function withLibcxx() {
  if (!succeeds('clang++-16', ['--version'])) return { ...noCounts, skipped: 2 };
  console.log('test: Clang and libc++');
  try {
    await buildNative({ preset: 'libcxx', targets: ['audioplugin_haptoflow', 'haptoflow_cli'] });
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    console.error(`test: ${error.message}`);
    return { ...noCounts, failed: 2 };
  }
  const folder = inRepository('Samples~', 'HeadlessScenes');
  const words = ['contact', path.join(folder, 'crossing.scene.json'), '--stroke', path.join(folder, 'crossing.stroke.csv')];
  const [here, there] = await Promise.all(['release', 'libcxx'].map((preset) => run(inRepository(presetFolder(preset), 'haptoflow'), words, { quiet: true })));
  const isSame = here.exitCode === 0 && here.output.length > 1000 && here.output === there.output;
  if (!isSame) console.error(`test: the command line built with libc++ says something else of ${words[1]} (exit code ${there.exitCode})`);
  return { ...noCounts, passed: isSame ? 2 : 1, failed: isSame ? 0 : 1 };
}

async function native() {
  await buildNative({ tests: true });
  return addCounts(await nativeTests(), await withLibcxx());
}

function nativeTests() {
  return judgeJunit('native.xml', 'ctest', ['--preset', 'release', '-j', String(os.cpus().length), '--progress', '--output-junit', results('native.xml')]);
}

async function sanitizers() {
  const env = {
    LSAN_OPTIONS: `suppressions=${inRepository('Tests', 'Native', 'lsan.supp')}:print_suppressions=0`,
    UBSAN_OPTIONS: 'print_stacktrace=1',
    TSAN_OPTIONS: `suppressions=${inRepository('Tests', 'Native', 'tsan.supp')}:halt_on_error=1:second_deadlock_stack=1`,
  };
  const possible = sanitized.filter(canBuild);
  for (const preset of new Set(possible.map((entry) => entry.preset))) {
    const targets = possible.filter((entry) => entry.preset === preset).map((entry) => `${entry.folder}_tests`);
    await buildNative({ preset, tests: true, targets });
  }
  let counts = { ...noCounts, skipped: sanitized.length - possible.length };
  for (const { preset, folder, tests = '.', except = '^$' } of possible) {
    const file = `${preset}-${folder}.xml`;
    const args = ['--test-dir', inRepository(presetFolder(preset), 'Tests', 'Native', folder), '-R', tests, '-E', except];
    args.push('-j', String(os.cpus().length), '--timeout', '300', '--output-on-failure', '--progress', '--output-junit', results(file));
    counts = addCounts(counts, await judgeJunit(file, 'ctest', args, { env }));
  }
  return counts;
}

async function training() {
  const args = ['-m', 'pytest', inRepository('Tests', 'Training'), '-q', '-n', String(os.cpus().length), '--junitxml', results('training.xml')];
  const env = { OPENBLAS_NUM_THREADS: '1', PYTHONPATH: inRepository('Training'), PYTHONDONTWRITEBYTECODE: '1' };
  return judgeJunit('training.xml', pythonOrFail(), args, { env, limitSeconds: 1800 });
}

/**
 * The package's C# against the shim, all of it as players run it, and what must not allocate as the editor runs it too.
 */
const managed = [
  { configuration: 'Release', target: 'HaptoFlow.slnx' },
  { configuration: 'Debug', target: 'HaptoFlow.ShimTests', tests: 'FullyQualifiedName~Garbage' },
];

async function dotnet() {
  const command = findDotnet();
  if (command === null) throw new CommandError('the C# tests need the .NET SDK 10, on PATH or in build/dotnet', 2);
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  let counts = noCounts;
  for (const { configuration, target, tests } of managed) {
    const folder = results(`dotnet-${configuration.toLowerCase()}`);
    rmSync(folder, { recursive: true, force: true });
    const args = ['test', inRepository('Tests', 'Dotnet', target), '-m:1', '-c', configuration, '--nologo', '--logger', 'trx'];
    args.push('--blame-hang-timeout', '10m', '--blame-hang-dump-type', 'none');
    args.push('--results-directory', folder, ...(tests ? ['--filter', tests] : []));
    const { exitCode } = await run(command, args, { env: dotnetEnvironment(command) });
    const files = existsSync(folder) ? readdirSync(folder).filter((name) => name.endsWith('.trx')) : [];
    const sum = files.map((name) => countsOfTrx(readFileSync(path.join(folder, name), 'utf8'))).reduce(addCounts, noCounts);
    counts = addCounts(counts, judged(sum, exitCode));
  }
  return counts;
}

async function packageTests() {
  const folder = inRepository('Tests', 'Package');
  const files = readdirSync(folder).filter((name) => name.endsWith('.test.mjs')).map((name) => inRepository('Tests', 'Package', name));
  return runNodeTests(files);
}

/** Runs files of node:test, shows what failed, and counts. */
export async function runNodeTests(files) {
  const { exitCode, output } = await run(process.execPath, ['--test', '--test-reporter=tap', ...files], { quiet: true });
  if (exitCode !== 0) console.log(output);
  return judged(countsOfTap(output), exitCode);
}

/** The runners of `npm test`: what each needs installed, and how it runs. Names are what --only takes. */
export const runners = {
  native: { purposes: ['build', 'test', 'libcxx'], execute: native },
  sanitizers: { purposes: ['build', 'test', 'realtime'], execute: sanitizers },
  training: { purposes: ['python', 'files'], execute: training },
  platforms: { purposes: ['build', 'test', 'platforms'], execute: platformTests },
  dotnet: { purposes: ['build', 'dotnet'], execute: dotnet },
  package: { purposes: ['files'], execute: packageTests },
};
