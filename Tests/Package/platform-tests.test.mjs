import assert from 'node:assert/strict';
import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { leftOut } from '../../scripts/lib/platform_tests.mjs';
import { inRepository } from '../../scripts/lib/repository.mjs';

/** The full names of GoogleTest's tests in a source; of a parametrised one with each prefix and any parameter. */
function testsIn(source) {
  const prefixes = [...source.matchAll(/INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+)/g)];
  return [...source.matchAll(/\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)/g)].flatMap(([, suite, name]) => {
    const instances = prefixes.filter(([, , of]) => of === suite).map(([, prefix]) => `${prefix}/${suite}.${name}/0`);
    return [`${suite}.${name}`, ...instances];
  });
}

/** A GoogleTest filter's pattern as a regular expression. */
const patternOf = (filter) => new RegExp(`^${filter.replace(/[.+^${}()|[\]\\]/g, '\\$&').replaceAll('*', '.*').replaceAll('?', '.')}$`);

const sources = readdirSync(inRepository('Tests', 'Native'), { recursive: true }).filter((name) => name.endsWith('.cpp'));
const all = sources.flatMap((name) => testsIn(readFileSync(path.join(inRepository('Tests', 'Native'), name), 'utf8')));

test('names of native tests are found in their sources, parametrised ones too', () => {
  assert.ok(all.length > 500);
  assert.deepEqual(testsIn('TEST(A, One) {} TEST_P(B, Two) {}\nINSTANTIATE_TEST_SUITE_P(Of, B, x)'), ['A.One', 'B.Two', 'Of/B.Two/0']);
});

for (const [platform, groups] of Object.entries(leftOut)) {
  test(`everything that ${platform} leaves out is there, and no more than a fifth of all tests is left out`, () => {
    const patterns = groups.flatMap(({ tests }) => tests);
    for (const filter of patterns) {
      assert.ok(all.some((name) => patternOf(filter).test(name)), `${filter} names no test`);
    }
    const isLeftOut = (name) => patterns.some((filter) => patternOf(filter).test(name));
    assert.ok(all.filter(isLeftOut).length < all.length / 5);
  });

  test(`${platform} says why it leaves tests out`, () => {
    for (const { because, tests } of groups) {
      assert.ok(because.length > 20 && tests.length > 0, tests.join());
    }
  });
}
