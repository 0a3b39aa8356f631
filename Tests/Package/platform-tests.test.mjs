import assert from 'node:assert/strict';
import test from 'node:test';
import { leftOut } from '../../scripts/lib/platform_tests.mjs';
import { nativeTests, patternOf, testsIn } from './support/native_tests.mjs';

const all = nativeTests();

test('names of native tests are found in their sources, parametrised ones too', () => {
  assert.ok(all.length > 500);
  assert.deepEqual(testsIn('TEST(A, One) {} TEST_P(B, Two) {}\nINSTANTIATE_TEST_SUITE_P(Of, B, x)'), ['A.One', 'B.Two', 'Of/B.Two/0']);
});

for (const [platform, groups] of Object.entries(leftOut)) {
  test(`every test that ${platform} leaves out exists, and at most a fifth of all tests is left out`, () => {
    const patterns = groups.flatMap(({ tests }) => tests);
    for (const filter of patterns) {
      assert.ok(all.some((name) => patternOf(filter).test(name)), `${filter} names no test`);
    }
    const isLeftOut = (name) => patterns.some((filter) => patternOf(filter).test(name));
    assert.ok(all.filter(isLeftOut).length < all.length / 5);
  });

  test(`${platform} states a reason for each group of tests that it leaves out`, () => {
    for (const { because, tests } of groups) {
      assert.ok(because.length > 20 && tests.length > 0, tests.join());
    }
  });
}
