// test: runs the tests and sums them into out/test/summary.json (--all: the long form; --only NAME; --help)
import { mkdirSync, writeFileSync } from 'node:fs';
import { bringDotnet, requireInstallable, rootCommand, setUp } from './lib/setup.mjs';
import { inRepository, parsed, runMain } from './lib/process.mjs';
import { addCounts, closingLine, exitCodeOf, noCounts, runRunners } from './lib/test_results.mjs';
import { chosenRunners, purposesOf, runners } from './lib/test_runners.mjs';

function showTable(rows) {
  const line = (cells) => cells.map((cell, column) => (column === 0 ? String(cell).padEnd(12) : String(cell).padStart(9))).join('');
  console.log(`\n${line(['runner', 'passed', 'failed', 'skipped', 'seconds'])}`);
  for (const row of rows) console.log(line([row.name, row.passed, row.failed, row.skipped, row.seconds.toFixed(1)]));
}

const namesOf = (wanted) => Object.keys(runners).filter((name) => (runners[name].long ?? false) === wanted).join(', ');

const help = `usage: ./run test [--all] [--only NAME]

Installs what is missing (Debian, with root or sudo; the .NET SDK 10 without), builds, runs the tests and sums them into
out/test/summary.json. What the system's packages do not have is named, with where to get it, and counted as skipped.
Where the .NET SDK can't be reached everything else runs; the exit code is then 2, and 1 where a test failed.

  --all        the long form: every test, all sanitizers, libc++ and the other platforms
  --only NAME  one runner. Of the default form: ${namesOf(false)}; of the long form: ${namesOf(true)}

Only the long form runs the tests of scripts/lib/long_tests.mjs, Python's with the mark "long" and Tests/Web/*.long.test.mjs.`;

await runMain('test', async (words) => {
  const { only, all } = parsed(words, { only: { type: 'string' }, all: { type: 'boolean', default: false } }).values;
  const chosen = chosenRunners({ only, all });
  const purposes = [...new Set(chosen.flatMap((name) => purposesOf(name, all)))];
  requireInstallable(purposes);
  await setUp(purposesOf(chosen[0], all));
  // The others' packages come while the first runner builds.
  const others = setUp(purposes);
  others.catch(() => {});
  const { rows, notRun } = await runRunners(chosen, {
    execute: async (name) => {
      if (name !== chosen[0]) await others;
      return runners[name].execute({ all, installed: others });
    },
    isBeside: (name) => runners[name].isBeside ?? false,
    needsSdk: (name) => runners[name].purposes.includes('dotnet'),
    bringSdk: () => others.then(() => bringDotnet({ asRoot: rootCommand() })),
  });
  const leftOut = await others;
  const { passed, failed, skipped } = rows.reduce(addCounts, noCounts);
  mkdirSync(inRepository('out', 'test'), { recursive: true });
  writeFileSync(inRepository('out', 'test', 'summary.json'), `${JSON.stringify({ passed, failed, skipped, left_out: leftOut, not_run: notRun, runners: rows }, null, 2)}\n`);
  showTable(rows);
  if (leftOut.length > 0) console.log('');
  leftOut.forEach((sentence) => console.log(`test: ${sentence}`));
  console.log(`\n${closingLine({ passed, failed, skipped })}`);
  if (notRun !== null) console.error(`test: ${notRun}`);
  return exitCodeOf({ failed, notRun });
}, { help });
