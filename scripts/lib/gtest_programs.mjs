import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { results } from './judge_junit.mjs';
import { presetFolder } from './native_build.mjs';
import { run } from './process.mjs';
import { inRepository } from './repository.mjs';
import { addCounts, countsOfJunit, noCounts } from './test_counts.mjs';

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
