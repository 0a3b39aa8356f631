import { existsSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { dotnetEnvironment, dotnetOrFail } from './dotnet.mjs';
import { judgeJunit, results } from './judge_junit.mjs';
import { withoutReadOnlyMarks } from './mono_signatures.mjs';
import { committedPlatforms, fileInPackage } from '../natives/committed.mjs';
import { runtimeLibrary } from '../pack/dependency.mjs';
import { buildNative, presetFolder } from './native_build.mjs';
import { CommandError, run, runOrFail, succeeds } from './process.mjs';
import { inRepository } from './repository.mjs';
import { addCounts, noCounts } from './test_counts.mjs';

/** The test projects that run under Mono. */
export const monoProjects = ['RepositoryTests', 'Tests', 'EditorTests', 'ShimTests', 'PreviewTests', 'SampleTests', 'MissingLibraryTests'];

/**
 * Tests that another runtime leaves out, and why.
 * @type {Record<string, {because: string, tests: string[]}[]>} tests: parts of full names
 */
export const leftOut = {
  mono: [],
  aot: [
    {
      because: 'they look for methods and structs of the core by reflection, and trimming removes what only reflection finds',
      tests: ['NativeStructsAndCallbacksArePreservedFromStripping', 'EveryFunctionOfTheHeaderIsDeclaredAndExported'],
    },
    {
      because: 'NUnit makes the values of their parameters by generic methods or attributes that a compiler cannot make ahead of time',
      tests: [
        'RandomStrokesHitchesStopsAndLossesLeaveNoStuckVibration', 'RandomStrokesHitchesStopsAndLossesObeyTheRulesOfStreams',
        'PlayableFrequenciesKeepTheirLevel', 'AliasingFrequenciesAreSuppressed', 'AHitchCausesAGapWithAFadeAtBothEnds',
        'AHitchOfAQueueingDeviceEndsAtASmallSampleAndFadesIn',
      ],
    },
  ],
};

const exceptions = (runner) => leftOut[runner].flatMap(({ tests }) => tests).map((name) => `-${name}`);

/** Tests that load the library in git, compare its structs with C#'s, and play; of HaptoFlow.RepositoryTests. */
export const testsOfCommitted = ['EveryStructOfTheHeaderIsComparedWithTheLibrary', 'ASlidingTipIsAudibleAndALiftedOneFallsSilent'];

/** The folder of the library in git for this machine. */
const committedFolder = () => path.dirname(fileInPackage(committedPlatforms.find(({ id }) => id === 'linux-x64')));

/** Runs `testsOfCommitted` by a test program; where not each of them passed, one counts as failed. */
async function judgeCommitted(file, command, args, env) {
  console.log('test: the Linux library in git');
  const counts = await judgeJunit(file, command, [...args, results(file), ...testsOfCommitted.map((name) => `+${name}`)], { env, limitSeconds: 300 });
  if (counts.passed + counts.failed >= testsOfCommitted.length) return counts;
  console.error(`test: ${file}: expected the tests ${testsOfCommitted.join(', ')}`);
  return addCounts(counts, { ...noCounts, failed: 1 });
}

const onnxRuntime = () => path.dirname(runtimeLibrary('linux-x64'));

/** Builds one project as a program for Mono and runs it. A project that does not build counts as one failure. */
async function judgeUnderMono(command, project) {
  const build = inRepository('build', 'mono');
  const words = ['build', inRepository('Tests', 'Dotnet', `HaptoFlow.${project}`), `-m:${os.cpus().length}`, '-c', 'Release', '--nologo', '-v', 'quiet'];
  const { exitCode } = await run(command, [...words, '-p:TestRuntime=mono', `-p:ArtifactsPath=${build}`], { env: dotnetEnvironment(command) });
  if (exitCode !== 0) {
    console.error(`test: HaptoFlow.${project} does not build for Mono: its tests may use what only .NET has`);
    return { ...noCounts, failed: 1 };
  }
  const folder = path.join(build, 'bin', `HaptoFlow.${project}`, 'release');
  for (const name of readdirSync(folder).filter((each) => each.endsWith('.dll'))) {
    const bytes = readFileSync(path.join(folder, name));
    if (withoutReadOnlyMarks(bytes) > 0) writeFileSync(path.join(folder, name), bytes);
  }
  const librariesIn = (place) => ({ LD_LIBRARY_PATH: [place, onnxRuntime()].join(':') });
  const env = project === 'MissingLibraryTests' ? {} : librariesIn(inRepository(presetFolder('release')));
  const file = `mono-${project.toLowerCase()}.xml`;
  const program = ['--debug', path.join(folder, `HaptoFlow.${project}.dll`)];
  const counts = await judgeJunit(file, 'mono', [...program, results(file), ...exceptions('mono')], { env, limitSeconds: 1800 });
  if (project !== 'RepositoryTests') return counts;
  return addCounts(counts, await judgeCommitted('mono-committed.xml', 'mono', program, librariesIn(committedFolder())));
}

/** The tests of the package's C# under Debian's Mono, each project as a program of its own. */
export async function mono() {
  if (!succeeds('mono', ['--version'])) return { ...noCounts, skipped: monoProjects.length };
  const command = dotnetOrFail();
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  let counts = noCounts;
  for (const project of monoProjects) counts = addCounts(counts, await judgeUnderMono(command, project));
  return counts;
}

/** The compiler's complaints about the core: of code that trimming or compiling ahead of time may break. */
export const complaintsAboutCore = (output) => [...new Set(output.split('\n').filter((line) => /warning IL\d+/.test(line) && /HaptoFlow\.Core\b|com\.haptoflow\.runtime/.test(line)))];

/**
 * The tests of the engine-free core as a program that is trimmed and compiled ahead of time, and one more: the compiler has
 * no complaint about the core.
 */
export async function aot() {
  if (process.platform !== 'linux' || process.arch !== 'x64') return { ...noCounts, skipped: 1 };
  const command = dotnetOrFail();
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  const build = inRepository('build', 'aot');
  const words = ['publish', inRepository('Tests', 'Dotnet', 'HaptoFlow.AotTests'), '-c', 'Release', '--nologo', '-v', 'quiet'];
  // The compiler complains only where it compiles.
  rmSync(path.join(build, 'obj', 'HaptoFlow.AotTests'), { recursive: true, force: true });
  const output = await runOrFail(command, [...words, `-p:ArtifactsPath=${build}`], { env: dotnetEnvironment(command), quiet: true });
  const complaints = complaintsAboutCore(output);
  complaints.forEach((line) => console.error(`test: ${line}`));
  const program = path.join(build, 'publish', 'HaptoFlow.AotTests', 'release_linux-x64', 'HaptoFlow.AotTests');
  if (!existsSync(program)) throw new CommandError(`${program} was not built`);
  const built = await judgeJunit('aot.xml', program, [results('aot.xml'), ...exceptions('aot')], { limitSeconds: 1800 });
  const counts = addCounts(built, await judgeCommitted('aot-committed.xml', program, [], { HAPTOFLOW_NATIVE_DIR: committedFolder() }));
  return addCounts(counts, { ...noCounts, passed: complaints.length === 0 ? 1 : 0, failed: complaints.length === 0 ? 0 : 1 });
}
