import { CommandError } from './process.mjs';
import { noCounts } from './test_counts.mjs';

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
 * @param {{execute: (name: string) => Promise<object>, needsSdk: (name: string) => boolean, bringSdk: () => Promise<unknown>}} ways
 *   bringSdk: installs the .NET SDK; it throws a CommandError with exit code 2 where no source can be reached. It is called
 *   at most once, before the first runner, since the runners' output would bury its message.
 * @returns {Promise<{rows: object[], notRun: string | null}>} notRun: one sentence that says what was not run and why
 */
export async function runRunners(names, { execute, needsSdk, bringSdk }) {
  const withSdk = names.filter(needsSdk);
  let reason = null;
  if (withSdk.length > 0) {
    try {
      await bringSdk();
    } catch (error) {
      if (!(error instanceof CommandError)) throw error;
      reason = error.message;
    }
  }
  const rows = [];
  for (const name of names) {
    if (reason === null || !needsSdk(name)) rows.push(await judge(name, execute));
  }
  return { rows, notRun: reason === null ? null : `not run: ${withSdk.join(', ')}, because ${reason}` };
}

/** 1 where a test failed, else 2 where a runner did not run, else 0. */
export const exitCodeOf = ({ failed, notRun }) => (failed > 0 ? 1 : notRun !== null ? 2 : 0);
