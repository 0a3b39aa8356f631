import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { presetFolder } from './native_build.mjs';
import { CommandError, inRepository, run } from './process.mjs';

/** Reads the results of several test runners as {passed, failed, skipped}. */

const attribute = (tag, name) => Number(tag.match(new RegExp(`\\b${name}="(\\d+)"`))?.[1] ?? 0);

/** Of a JUnit file: ctest's (one <testsuite>) or pytest's (<testsuites> around one). Errors count as failed. */
export function countsOfJunit(xml) {
  const suites = xml.match(/<testsuite\s[^>]*>/g) ?? [];
  const sum = (name) => suites.reduce((total, tag) => total + attribute(tag, name), 0);
  const failed = sum('failures') + sum('errors');
  const skipped = sum('skipped') + sum('disabled');
  return { passed: sum('tests') - failed - skipped, failed, skipped };
}

/** Of the closing lines that `node --test --test-reporter=tap` prints. Cancelled tests count as failed. */
export function countsOfTap(output) {
  const line = (name) => Number(output.match(new RegExp(`^# ${name} (\\d+)$`, 'm'))?.[1] ?? 0);
  return { passed: line('pass'), failed: line('fail') + line('cancelled'), skipped: line('skipped') + line('todo') };
}

/**
 * Of a TRX file of `dotnet test`. Ignored, explicit and inconclusive tests count as skipped, everything else that did not
 * pass as failed. NUnit leaves its skipped tests out of `notExecuted`: they are those that were not executed.
 */
export function countsOfTrx(xml) {
  const tag = xml.match(/<Counters\s[^>]*>/)?.[0] ?? '';
  const [total, executed, passed] = ['total', 'executed', 'passed'].map((name) => attribute(tag, name));
  const inconclusive = attribute(tag, 'inconclusive');
  return { passed, failed: executed - passed - inconclusive, skipped: total - executed + inconclusive };
}

export const addCounts = (a, b) => ({ passed: a.passed + b.passed, failed: a.failed + b.failed, skipped: a.skipped + b.skipped });

export const noCounts = { passed: 0, failed: 0, skipped: 0 };

/** One test: it passes unless the attempt ends with a CommandError, which is printed. @param {() => Promise<void>} attempt */
export async function countsOfAttempt(attempt) {
  try {
    await attempt();
    return { ...noCounts, passed: 1 };
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    console.error(`test: ${error.message}`);
    return { ...noCounts, failed: 1 };
  }
}

/**
 * The counts of a runner, with one failure added where its exit code reports one that the counts do not have, or where it
 * ran no test.
 */
export function judged(counts, exitCode) {
  const ranNothing = counts.passed + counts.failed === 0;
  return (exitCode !== 0 && counts.failed === 0) || ranNothing ? { ...counts, failed: counts.failed + 1 } : counts;
}

/** The last line of a test run. */
export function closingLine({ passed, failed, skipped }) {
  return `${passed} passed, ${failed} failed${skipped > 0 ? `, ${skipped} skipped` : ''}`;
}

/** Runs one runner. An error that keeps it from running counts as one failed test. */
async function judge(name, execute) {
  const begin = performance.now();
  console.log(`test: ${name}`);
  let counts;
  try {
    counts = await execute(name);
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    console.error(`test: ${name}: ${error.message}`);
    counts = { ...noCounts, failed: 1 };
  }
  return { name, ...counts, seconds: Math.round((performance.now() - begin) / 100) / 10 };
}

/**
 * Runs the runners that can run, in order, and names those that cannot.
 * @param {string[]} names
 * @param {{execute: (name: string) => Promise<object>, isBeside: (name: string) => boolean, needsSdk: (name: string) => boolean,
 *   bringSdk: () => Promise<unknown>}} ways isBeside: runs at the same time as the runner before it; bringSdk: installs the .NET
 *   SDK, while the runners before the first one that needs it run; a CommandError where no source can be reached
 * @returns {Promise<{rows: object[], notRun: string | null}>} notRun: one sentence that says what was not run and why
 */
export async function runRunners(names, { execute, isBeside, needsSdk, bringSdk }) {
  const withSdk = names.filter(needsSdk);
  const reasonOf = (error) => {
    if (!(error instanceof CommandError)) throw error;
    return error.message;
  };
  const whyNone = withSdk.length > 0 ? bringSdk().then(() => null, reasonOf) : Promise.resolve(null);
  const groups = [];
  for (const name of names) {
    if (isBeside(name) && groups.length > 0) groups.at(-1).push(name);
    else groups.push([name]);
  }
  const rows = [];
  for (const group of groups) {
    const possible = group.some(needsSdk) && (await whyNone) !== null ? group.filter((name) => !needsSdk(name)) : group;
    rows.push(...(await Promise.all(possible.map((name) => judge(name, execute)))));
  }
  const reason = await whyNone;
  return { rows, notRun: reason === null ? null : `not run: ${withSdk.join(', ')}, because ${reason}` };
}

/** 1 where a test failed, else 2 where a runner did not run, else 0. */
export const exitCodeOf = ({ failed, notRun }) => (failed > 0 ? 1 : notRun !== null ? 2 : 0);

/** The path of a result file of a test run. */
export const results = (name) => inRepository('out', 'test', name);

/**
 * Runs a command that writes a JUnit file and counts its tests. A file of an earlier run is deleted first.
 * @param {{env?: Record<string, string>, limitSeconds?: number}} options as of `run`
 */
export async function judgeJunit(file, command, args, options = {}) {
  mkdirSync(results('.'), { recursive: true });
  rmSync(results(file), { force: true });
  const { exitCode } = await run(command, args, options);
  const counts = existsSync(results(file)) ? countsOfJunit(readFileSync(results(file), 'utf8')) : noCounts;
  return judged(counts, exitCode);
}

/**
 * A GoogleTest program and the tests of it that run. The program is started once for each processor core, each time with
 * its share of the tests: a process for each test, as ctest starts them, loads ONNX Runtime hundreds of times.
 * @typedef {{name: string, file: string, tests?: string[], except?: string[], env?: Record<string, string>}} Job
 *   name: for the results' files; file: the program; tests, except: GoogleTest patterns, by default all and none
 */

/** The time after which one start of a program is taken to hang, in seconds. */
const limitSeconds = 900;

const suffix = process.platform === 'win32' ? '.exe' : '';

/**
 * The job of a folder of Tests/Native in the build of a preset. Visual Studio adds a folder for the configuration, and
 * Windows finds the library beside the program or on PATH only.
 * @returns {Job}
 */
export function nativeJob({ preset, program, tests, except, env = {} }) {
  const build = inRepository(presetFolder(preset));
  const folder = path.join(build, 'Tests', 'Native', program);
  const places = [folder, path.join(folder, 'Release')].map((place) => path.join(place, `${program}_tests${suffix}`));
  const file = places.find((place) => existsSync(place)) ?? places[0];
  const searched = process.platform === 'win32' ? { PATH: [build, path.join(build, 'Release'), process.env.PATH].join(path.delimiter) } : {};
  return { name: `${preset}-${program}`, file, tests, except, env: { ...searched, ...env } };
}

/** GoogleTest's filter of a job. */
export const filterOf = ({ tests = ['*'], except = [] }) => `${tests.join(':')}${except.length > 0 ? `-${except.join(':')}` : ''}`;

/** Runs one share of a job and shows its output where something failed. */
async function runShare(job, share, shares) {
  const file = `${job.name}-${share}.xml`;
  rmSync(results(file), { force: true });
  const args = [`--gtest_filter=${filterOf(job)}`, '--gtest_brief=1', `--gtest_output=xml:${results(file)}`];
  const env = { ...job.env, GTEST_TOTAL_SHARDS: String(shares), GTEST_SHARD_INDEX: String(share) };
  const { exitCode, output } = await run(job.file, args, { env, quiet: true, limitSeconds });
  const counts = existsSync(results(file)) ? countsOfJunit(readFileSync(results(file), 'utf8')) : noCounts;
  if (exitCode === 0) return counts;
  console.error(`${output.trimEnd()}\ntest: ${path.relative(inRepository(), job.file)} ended with ${exitCode}; ${results(file)} names the tests that failed`);
  return counts.failed > 0 ? counts : { ...counts, failed: 1 };
}

/**
 * Runs jobs, as many programs at once as there are cores. A job that ran no test has failed.
 * @param {Job[]} jobs @returns {Promise<{passed: number, failed: number, skipped: number}>}
 */
export async function judgePrograms(jobs, cores = os.cpus().length) {
  mkdirSync(results('.'), { recursive: true });
  const sums = jobs.map(() => noCounts);
  const shares = jobs.flatMap((job, index) => Array.from({ length: cores }, (_, share) => ({ job, index, share })));
  const worker = async () => {
    for (let next = shares.shift(); next !== undefined; next = shares.shift()) {
      if (next.share === 0) console.log(`test: ${next.job.name}`);
      const counts = await runShare(next.job, next.share, cores);
      sums[next.index] = addCounts(sums[next.index], counts);
    }
  };
  await Promise.all(Array.from({ length: cores }, worker));
  return sums.map((sum) => (sum.passed + sum.failed === 0 ? { ...sum, failed: 1 } : sum)).reduce(addCounts, noCounts);
}
