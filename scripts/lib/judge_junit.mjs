import { existsSync, mkdirSync, readFileSync, rmSync } from 'node:fs';
import { run } from './process.mjs';
import { inRepository } from './repository.mjs';
import { countsOfJunit, judged, noCounts } from './test_counts.mjs';

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
