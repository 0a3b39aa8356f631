import { existsSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { runtimeLibrary } from '../pack/dependency.mjs';
import { committedPlatforms, fileInPackage } from './libraries.mjs';
import { buildNative, presetFolder } from './native_build.mjs';
import { CommandError, inRepository, run, runOrFail, succeeds } from './process.mjs';
import { dotnetEnvironment, dotnetOrFail } from './setup.mjs';
import { addCounts, judgeJunit, noCounts, results } from './test_results.mjs';

/**
 * Debian's Mono 6.8 has its base library built by Mono's old compiler, which leaves out the mark `modreq(InAttribute)` of
 * methods that return `ref readonly T`. It therefore does not find `ReadOnlySpan<T>`'s indexer by the signature of .NET
 * Standard 2.1, which Unity's Mono, built by the newer compiler, has. This file takes the mark out of compiled assemblies.
 */

/** The number at `at` in the metadata's compressed form, and where the next byte lies. */
function compressed(bytes, at) {
  if (bytes[at] < 0x80) return [bytes[at], at + 1];
  if (bytes[at] < 0xc0) return [((bytes[at] & 0x3f) << 8) | bytes[at + 1], at + 2];
  return [bytes.readUInt32BE(at) & 0x1fffffff, at + 4];
}

/** Where the heap of signatures of a .NET assembly begins and ends. Throws RangeError where the bytes hold no metadata. */
function blobHeap(bytes) {
  const root = bytes.indexOf('BSJB');
  if (root < 0) throw new RangeError('no .NET metadata');
  let at = root + 16 + bytes.readUInt32LE(root + 12);
  const streams = bytes.readUInt16LE(at + 2);
  at += 4;
  for (let stream = 0; stream < streams; stream += 1) {
    const [offset, size] = [bytes.readUInt32LE(at), bytes.readUInt32LE(at + 4)];
    const end = bytes.indexOf(0, at + 8);
    if (bytes.toString('latin1', at + 8, end) === '#Blob') return [root + offset, root + offset + size];
    at = at + 8 + 4 * Math.ceil((end + 1 - at - 8) / 4);
  }
  throw new RangeError('no heap of signatures');
}

const [instanceMethod, requiredModifier, byReference, typeParameter] = [0x20, 0x1f, 0x10, 0x13];

/**
 * Removes the modifier from every signature `instance !0 modreq(X)& method(...)`, in place; an entry of the heap becomes
 * shorter and the bytes behind it stay unused.
 * @param {Buffer} bytes an assembly
 * @returns {number} the number of signatures changed
 */
export function withoutReadOnlyMarks(bytes) {
  const [begin, end] = blobHeap(bytes);
  let changed = 0;
  for (let at = begin; at < end;) {
    const [length, first] = compressed(bytes, at);
    const next = first + length;
    if (length >= 6 && length < 0x80 && bytes[first] === instanceMethod && bytes[first + 2] === requiredModifier) {
      const [, type] = compressed(bytes, first + 3);
      if (bytes[type] === byReference && bytes[type + 1] === typeParameter) {
        bytes.copy(bytes, first + 2, type, next);
        bytes[at] = length - (type - first - 2);
        changed += 1;
      }
    }
    at = next;
  }
  return changed;
}

/** The test projects that run under Mono, and the names of their assemblies. */
const monoProjects = { EditorTests: 'EditorTests', Tests: 'Tests', MissingLibraryTests: 'EditorTests' };

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

/** Tests that load the library in git, compare its structs with C#'s, and play. Both programs, Mono's and the one compiled ahead of time, have them. */
const testsOfCommitted = ['EveryStructOfTheHeaderIsComparedWithTheLibrary', 'AVoicePlaysAClipWithoutContactAndPlaysOnAfterItWasDisposed'];

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
  const words = ['build', inRepository('Tests', 'Dotnet', `HaptoFlow.${project}.csproj`), `-m:${os.cpus().length}`, '-c', 'Release', '--nologo', '-v', 'quiet'];
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
  const program = ['--debug', path.join(folder, `HaptoFlow.${monoProjects[project]}.dll`)];
  const counts = await judgeJunit(file, 'mono', [...program, results(file), ...exceptions('mono')], { env, limitSeconds: 1800 });
  if (project !== 'EditorTests') return counts;
  return addCounts(counts, await judgeCommitted('mono-committed.xml', 'mono', program, librariesIn(committedFolder())));
}

/** The tests of the package's C# under Debian's Mono, each project as a program of its own. */
export async function mono() {
  if (!succeeds('mono', ['--version'])) return { ...noCounts, skipped: Object.keys(monoProjects).length };
  const command = dotnetOrFail();
  await buildNative({ targets: ['audioplugin_haptoflow'] });
  let counts = noCounts;
  for (const project of Object.keys(monoProjects)) counts = addCounts(counts, await judgeUnderMono(command, project));
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
  const words = ['publish', inRepository('Tests', 'Dotnet', 'HaptoFlow.AotTests.csproj'), '-c', 'Release', '--nologo', '-v', 'quiet'];
  // The compiler complains only where it compiles.
  rmSync(path.join(build, 'obj', 'HaptoFlow.AotTests'), { recursive: true, force: true });
  const output = await runOrFail(command, [...words, `-p:ArtifactsPath=${build}`], { env: dotnetEnvironment(command), quiet: true });
  const complaints = complaintsAboutCore(output);
  complaints.forEach((line) => console.error(`test: ${line}`));
  const program = path.join(build, 'publish', 'HaptoFlow.AotTests', 'release_linux-x64', 'HaptoFlow.Tests');
  if (!existsSync(program)) throw new CommandError(`${program} was not built`);
  const built = await judgeJunit('aot.xml', program, [results('aot.xml'), ...exceptions('aot')], { limitSeconds: 1800 });
  const counts = addCounts(built, await judgeCommitted('aot-committed.xml', program, [], { HAPTOFLOW_NATIVE_DIR: committedFolder() }));
  return addCounts(counts, { ...noCounts, passed: complaints.length === 0 ? 1 : 0, failed: complaints.length === 0 ? 0 : 1 });
}
