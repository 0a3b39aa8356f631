// test: runs every test and sums them into out/test/summary.json (--only native|sanitizers|platforms|training|dotnet|package)
import { mkdirSync, writeFileSync } from 'node:fs';
import { parseArgs } from 'node:util';
import { CommandError, runMain } from './lib/process.mjs';
import { inRepository } from './lib/repository.mjs';
import { setUp } from './lib/setup.mjs';
import { addCounts, closingLine, noCounts } from './lib/test_counts.mjs';
import { runners } from './lib/test_runners.mjs';

function chosenRunners(words) {
  const names = Object.keys(runners);
  let only;
  try {
    ({ values: { only } } = parseArgs({ args: words, options: { only: { type: 'string' } } }));
  } catch (error) {
    throw new CommandError(error.message, 2);
  }
  if (only !== undefined && !names.includes(only)) throw new CommandError(`--only ${only}: expected one of ${names.join(', ')}`, 2);
  return only === undefined ? names : [only];
}

/** Runs one runner; whatever stops it from running is one failure of its own. */
async function execute(name) {
  const begin = performance.now();
  console.log(`test: ${name}`);
  let counts;
  try {
    counts = await runners[name].execute();
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    console.error(`test: ${name}: ${error.message}`);
    counts = { ...noCounts, failed: 1 };
  }
  return { name, ...counts, seconds: Math.round((performance.now() - begin) / 100) / 10 };
}

function showTable(rows) {
  const line = (cells) => cells.map((cell, column) => (column === 0 ? String(cell).padEnd(12) : String(cell).padStart(9))).join('');
  console.log(`\n${line(['runner', 'passed', 'failed', 'skipped', 'seconds'])}`);
  for (const row of rows) console.log(line([row.name, row.passed, row.failed, row.skipped, row.seconds.toFixed(1)]));
}

const help = `usage: ./run test [--only ${Object.keys(runners).join('|')}]

Installs what is missing (Debian, with root or sudo; the .NET SDK 10 without), builds, runs every test or those of one
runner, and sums them into out/test/summary.json. What the system's packages do not have is named, counted as skipped, and
said where it can be had.`;

await runMain('test', async (words) => {
  const chosen = chosenRunners(words);
  const leftOut = await setUp([...new Set(chosen.flatMap((name) => runners[name].purposes))]);
  const rows = [];
  for (const name of chosen) rows.push(await execute(name));
  const { passed, failed, skipped } = rows.reduce(addCounts, noCounts);
  mkdirSync(inRepository('out', 'test'), { recursive: true });
  writeFileSync(inRepository('out', 'test', 'summary.json'), `${JSON.stringify({ passed, failed, skipped, left_out: leftOut, runners: rows }, null, 2)}\n`);
  showTable(rows);
  if (leftOut.length > 0) console.log('');
  leftOut.forEach((sentence) => console.log(`test: ${sentence}`));
  console.log(`\n${closingLine({ passed, failed, skipped })}`);
  return failed > 0 ? 1 : 0;
}, { help });
