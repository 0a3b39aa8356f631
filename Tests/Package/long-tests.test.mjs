import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { longTests } from '../../scripts/lib/long_tests.mjs';
import { inRepository } from '../../scripts/lib/repository.mjs';
import { chosenRunners, purposesOf, runners } from '../../scripts/lib/test_runners.mjs';
import { nativeTests, patternOf } from './support/native_tests.mjs';

/** The text of all files with an ending below folders of Tests. */
const textBelow = (ending, ...folders) =>
  folders.flatMap((folder) => readdirSync(inRepository('Tests', folder), { recursive: true }).map((name) => inRepository('Tests', folder, name)))
    .filter((name) => name.endsWith(ending) && !name.includes(`${path.sep}obj${path.sep}`))
    .map((name) => readFileSync(name, 'utf8')).join('\n');

/** Whether a runner has a test of that name. */
const isThere = {
  native: (pattern) => nativeTests().some((name) => patternOf(pattern).test(name)),
  training: (name) => textBelow('.py', 'Training').includes(`def ${name}(`),
  dotnet: (name) => new RegExp(`void ${name}\\(`).test(textBelow('.cs', 'Dotnet', 'Unity')),
};

for (const [runner, groups] of Object.entries(longTests)) {
  test(`every long test of ${runner} exists, and says why the default run does without it`, () => {
    for (const { because, tests } of groups) {
      assert.ok(because.length > 30, tests.join());
      for (const name of tests) {
        assert.ok(isThere[runner](name), `${name} names no test`);
      }
    }
  });
}

test('the default form runs no long runner, the long form all of them, and --only the named one', () => {
  assert.deepEqual(chosenRunners({ all: false }), ['native', 'training', 'dotnet', 'package', 'web']);
  assert.deepEqual(chosenRunners({ all: true }), Object.keys(runners));
  assert.deepEqual(chosenRunners({ only: 'platforms', all: false }), ['platforms']);
  assert.throws(() => chosenRunners({ only: 'nothing', all: false }), /--only nothing: expected one of native,/);
});

test('only the long form installs Clang 22, and the default form no cross compiler', () => {
  assert.ok(!purposesOf('sanitizers', false).includes('realtime'));
  assert.ok(purposesOf('sanitizers', true).includes('realtime'));
  for (const name of chosenRunners({ all: false })) assert.ok(!purposesOf(name, false).includes('platforms'), name);
});
