/** Reads the results of several test runners as {passed, failed, skipped}. */
import { CommandError } from './process.mjs';

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
