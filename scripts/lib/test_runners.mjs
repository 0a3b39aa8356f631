import { existsSync, readdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { dotnetEnvironment, dotnetOrFail, pythonOrFail, trainingEnvironment } from './setup.mjs';
import { addCounts, countsOfTap, countsOfTrx, judgeJunit, judgePrograms, judged, nativeJob, noCounts, results } from './test_results.mjs';
import { longTestsOf } from './long_tests.mjs';
import { buildNative, presetFolder } from './native_build.mjs';
import { bringArmRuntime, platformTests } from './platform_tests.mjs';
import { CommandError, inRepository, run, succeeds } from './process.mjs';
import { aot, mono } from './runtime_tests.mjs';

/** Programs of Tests/Native that every platform builds. */
const portablePrograms = ['model', 'dsp', 'effects', 'clips', 'headless', 'inference', 'learning', 'engine', 'capi', 'unity'];

/**
 * What runs under which sanitizers: programs that read untrusted input, hand memory across the C ABI, or share it between
 * threads. `--only sanitizers` has one build, that of the address and undefined-behaviour sanitizers, and of it the programs
 * that reach all code of the shipped library from outside; `long` entries are those of `--all`.
 */
export const sanitized = [
  { preset: 'asan-ubsan', program: 'capi', except: ['*ClosedLoop*', '*HardCaseTest.*Shipped*', '*HardSceneTest.*Shipped*'] },
  { preset: 'asan-ubsan', program: 'unity' },
  { preset: 'asan-ubsan', program: 'model' },
  { preset: 'asan-ubsan', program: 'clips' },
  { preset: 'asan-ubsan', program: 'headless', long: true },
  { preset: 'asan-ubsan', program: 'learning', except: ['*LearnerTest*'], long: true },
  {
    preset: 'asan-ubsan',
    program: 'engine',
    tests: ['*LiveVoice*', '*LiveEngine*', '*StallTest*', '*LeadTest*', '*MaterialLibrary*', '*ToneVoice*', '*SignalVoice*'],
    long: true,
  },
  { preset: 'tsan', program: 'capi', tests: ['*ApiStorm*', '*EngineApi*', '*GeneratorApi*', '*MaterialApi*', '*VoiceTable*'], long: true },
  { preset: 'tsan', program: 'engine', tests: ['*LiveEngine*', '*Mailbox*', '*CorrectionQueue*', '*MaterialLibrary*'], long: true },
  { preset: 'tsan', program: 'unity', tests: ['*AudioThread*'], long: true },
  // RealtimeSanitizer ends a program that waits inside a render, which is what VoiceTable's tests make a render do.
  { preset: 'rtsan', program: 'capi', except: ['*ClosedLoop*', '*Shipped*', '*OpenModel*', '*VoiceTable*'], long: true },
  { preset: 'rtsan', program: 'unity', long: true },
];

/** Whether the compiler of a preset is installed. Without Clang 22, set-up names its source and the runs count as skipped. */
const canBuild = ({ preset }) => preset !== 'rtsan' || succeeds('clang++-22', ['--version']);

/**
 * Two tests: library and command line build without warnings with Clang and libc++, as on Android, macOS and iOS, and that
 * command line prints the same contact states as the release build.
 */
async function libcxx() {
  if (!succeeds('clang++-16', ['--version'])) return { ...noCounts, skipped: 2 };
  try {
    await buildNative({ targets: ['haptoflow_cli'] });
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
  if (!isSame) console.error(`test: the command line built with libc++ prints other contact states for ${words[1]} than the release build (exit code ${there.exitCode})`);
  return { ...noCounts, passed: isSame ? 2 : 1, failed: isSame ? 0 : 1 };
}

/** The preset of the native tests: Visual Studio on Windows, libraries from vcpkg on macOS, elsewhere the release build. */
const nativePreset = { win32: 'windows-msvc', darwin: 'macos-tests' }[process.platform] ?? 'release';

export function nativePrograms() {
  // The realtime program traps system calls of Linux x64; the command line is not built on Windows.
  const programs = [...(process.platform === 'win32' ? [] : ['cli']), ...portablePrograms];
  if (process.platform === 'linux' && process.arch === 'x64') programs.push('realtime');
  return programs;
}

async function native({ all, installed }) {
  if (process.platform === 'linux' && process.arch === 'arm64') await bringArmRuntime();
  const programs = nativePrograms();
  // The command line is for the runners that follow, two of which may not build at the same time.
  const targets = ['audioplugin_haptoflow', ...(process.platform === 'win32' ? [] : ['haptoflow_cli']), ...programs.map((name) => `${name}_tests`)];
  await buildNative({ preset: nativePreset, tests: true, targets });
  // Tests of time want the machine for themselves.
  await installed;
  const except = all ? [] : longTestsOf('native');
  const counts = await judgePrograms(programs.map((program) => nativeJob({ preset: nativePreset, program, except })));
  if (nativePreset !== 'release') return counts;
  const args = ['--preset', 'release', '-R', '^InstalledPackage', '--output-junit', results('installed-package.xml')];
  return addCounts(counts, await judgeJunit('installed-package.xml', 'ctest', args));
}

async function sanitizers({ all }) {
  const env = {
    LSAN_OPTIONS: `suppressions=${inRepository('Tests', 'Native', 'lsan.supp')}:print_suppressions=0`,
    UBSAN_OPTIONS: 'print_stacktrace=1',
    TSAN_OPTIONS: `suppressions=${inRepository('Tests', 'Native', 'tsan.supp')}:halt_on_error=1:second_deadlock_stack=1`,
  };
  const chosen = sanitized.filter((entry) => all || !entry.long);
  const possible = chosen.filter(canBuild);
  for (const preset of new Set(possible.map((entry) => entry.preset))) {
    const targets = possible.filter((entry) => entry.preset === preset).map((entry) => `${entry.program}_tests`);
    await buildNative({ preset, tests: true, targets });
  }
  const long = all ? [] : longTestsOf('native');
  const counts = await judgePrograms(possible.map((entry) => nativeJob({ ...entry, env, except: [...(entry.except ?? []), ...long] })));
  return { ...counts, skipped: counts.skipped + chosen.length - possible.length };
}

async function training({ all }) {
  // Own recordings are read by the library.
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  // Whole files: what a file's fixtures make is made once.
  const args = ['-m', 'pytest', inRepository('Tests', 'Training'), '-q', '-n', String(os.cpus().length), '--dist', 'loadfile'];
  args.push('--junitxml', results('training.xml'));
  if (!all) args.push('-m', 'not long');
  return judgeJunit('training.xml', pythonOrFail(), args, { env: trainingEnvironment(), limitSeconds: 1800 });
}

/**
 * The package's C# against the shim. All projects run in Release, as in a player. The long form also runs the tests of garbage
 * in Debug, which the editor runs.
 */
const managed = [
  { configuration: 'Release', target: 'HaptoFlow.slnx', projects: ['Tests', 'EditorTests', 'MissingLibraryTests', 'WrongLibraryTests'] },
  { configuration: 'Debug', target: 'HaptoFlow.Tests.csproj', projects: ['Tests'], tests: 'FullyQualifiedName~Garbage', long: true },
];

/** Where the tests of a project lie: those without the library have the assembly name to which the package opens its internals. */
function testAssembly(project, configuration) {
  const assembly = { MissingLibraryTests: 'EditorTests', WrongLibraryTests: 'Tests' }[project] ?? project;
  const build = process.env.HAPTOFLOW_DOTNET_BUILD || inRepository('build', 'dotnet');
  return path.join(build, 'bin', `HaptoFlow.${project}`, configuration.toLowerCase(), `HaptoFlow.${assembly}.dll`);
}

async function dotnet({ all }) {
  const command = dotnetOrFail();
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  const shortForm = longTestsOf('dotnet').map((name) => `FullyQualifiedName!~${name}`).join('&');
  let counts = noCounts;
  const env = dotnetEnvironment(command);
  for (const { configuration, target, projects, tests = all ? '' : shortForm } of managed.filter(({ long }) => all || !long)) {
    const folder = results(`dotnet-${configuration.toLowerCase()}`);
    rmSync(folder, { recursive: true, force: true });
    const build = ['build', inRepository('Tests', 'Dotnet', target), `-m:${os.cpus().length}`, '-c', configuration, '--nologo', '-v', 'quiet'];
    const built = await run(command, build, { env });
    if (built.exitCode !== 0) return addCounts(counts, judged(noCounts, built.exitCode));
    const args = ['test', ...projects.map((project) => testAssembly(project, configuration)), '--nologo', '--logger', 'trx'];
    args.push('--blame-hang-timeout', '10m', '--blame-hang-dump-type', 'none');
    args.push('--results-directory', folder, ...(tests ? ['--filter', tests] : []), '--', `RunConfiguration.MaxCpuCount=${os.cpus().length}`);
    const { exitCode } = await run(command, args, { env });
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
export async function runNodeTests(files, env = {}) {
  const { exitCode, output } = await run(process.execPath, ['--test', '--test-reporter=tap', ...files], { quiet: true, env });
  if (exitCode !== 0) console.log(output);
  return judged(countsOfTap(output), exitCode);
}

/** The engine for browsers: renders beside the command line's, in Node and in Chromium. Without Emscripten it is skipped. */
async function web({ all }) {
  if (!succeeds('emcc', ['--version'])) return { ...noCounts, skipped: 1 };
  await buildNative({ targets: ['haptoflow_cli'] });
  // Imported here, since set-up may just have installed the packages that it needs.
  const { buildEngine, stagePage } = await import('./web_build.mjs');
  await buildEngine();
  stagePage();
  const folder = inRepository('Tests', 'Web');
  const names = readdirSync(folder).filter((name) => name.endsWith('.test.mjs') && (all || !name.endsWith('.long.test.mjs')));
  // What is judged by time, as what is heard live, has nothing beside it.
  const isLive = (name) => name.startsWith('live');
  const environment = { HAPTOFLOW_PAGE_IS_STAGED: '1', ...(all ? { HAPTOFLOW_LONG_TESTS: '1' } : {}) };
  const counts = [];
  const runAll = async (queue) => {
    for (let name = queue.shift(); name !== undefined; name = queue.shift()) counts.push(await runNodeTests([path.join(folder, name)], environment));
  };
  const others = names.filter((name) => !isLive(name));
  await Promise.all(os.cpus().slice(0, 2).map(() => runAll(others)));
  await runAll(names.filter(isLive));
  return counts.reduce(addCounts, noCounts);
}

/**
 * The runners of `npm test`: what each needs installed, and how it runs. Names are what --only takes.
 * @type {Record<string, {purposes: string[], longPurposes?: string[], long?: boolean, isBeside?: boolean, execute: (form: {all: boolean, installed: Promise<unknown>}) => Promise<object>}>}
 *   longPurposes: what the long form needs besides; isBeside: runs at the same time as the one before it, which neither hears of
 *   time nor leaves all cores busy to its end; long: true for a runner of the long form, which runs by `--all` or by its
 *   name; all: true for the long form; installed: the packages of all runners are there
 */
export const runners = {
  native: { purposes: ['build', 'test'], execute: native },
  training: { purposes: ['build', 'python', 'files'], execute: training },
  // One test imports published weights, which the library measures.
  package: { purposes: ['files', 'build', 'python'], isBeside: true, execute: packageTests },
  dotnet: { purposes: ['build', 'dotnet', 'pictures'], execute: dotnet },
  web: { purposes: ['build', 'test', 'web', 'browser'], longPurposes: ['browsers'], execute: web },
  sanitizers: { purposes: ['build', 'test'], longPurposes: ['realtime'], long: true, execute: sanitizers },
  libcxx: { purposes: ['build', 'libcxx'], long: true, execute: libcxx },
  mono: { purposes: ['build', 'dotnet', 'pictures', 'mono'], long: true, execute: mono },
  aot: { purposes: ['build', 'dotnet'], long: true, execute: aot },
  platforms: { purposes: ['build', 'test', 'cross', 'platforms'], long: true, execute: platformTests },
};

/** The names of the runners to run: the one of --only, else those of the form. */
export function chosenRunners({ only, all }) {
  const names = Object.keys(runners);
  if (only === undefined) return names.filter((name) => all || !runners[name].long);
  if (!names.includes(only)) throw new CommandError(`--only ${only}: expected one of ${names.join(', ')}`, 2);
  return [only];
}

/** What has to be installed for a runner. */
export const purposesOf = (name, all) => [...runners[name].purposes, ...(all ? (runners[name].longPurposes ?? []) : [])];
