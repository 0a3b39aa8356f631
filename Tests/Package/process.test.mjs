import assert from 'node:assert/strict';
import { test } from 'node:test';
import { run } from '../../scripts/lib/process.mjs';

test('a program that hangs is ended at its limit and has failed, with the limit in what is said', async () => {
  const hanging = ['-e', 'setInterval(() => {}, 1000)'];
  const { exitCode, output } = await run(process.execPath, hanging, { quiet: true, limitSeconds: 0.3 });
  assert.notEqual(exitCode, 0);
  assert.match(output, /ended after 0\.3 s/);
});

test('a program that ends within its limit is judged by itself', async () => {
  const { exitCode, output } = await run(process.execPath, ['-e', 'console.log("whole")'], { quiet: true, limitSeconds: 30 });
  assert.deepEqual({ exitCode, output }, { exitCode: 0, output: 'whole\n' });
});

test('an option that nothing knows is refused, so that a variable for the child cannot be lost among them', () => {
  assert.throws(() => run(process.execPath, ['--version'], { quiet: true, HAPTOFLOW_TEST_CALLBACKS: '1' }), /unknown options HAPTOFLOW_TEST_CALLBACKS/);
});
