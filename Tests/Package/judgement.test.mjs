import assert from 'node:assert/strict';
import test from 'node:test';
import { judgementOf } from '../../scripts/lib/judgement.mjs';

test('a training on own recordings is followed by a comparison with the same recordings and labels', () => {
  const words = ['--recordings', 'a', 'b', '--labels=l.toml', '--out', 'o', '--export', 'own.haptoflow'];
  assert.deepEqual(judgementOf(words), [
    'evaluate', '--model', 'own.haptoflow', '--recordings', 'a', 'b', '--labels', 'l.toml', '--beside-learn',
  ]);
});

test('the default model, a run without a file, and one that asks for none are not compared', () => {
  assert.equal(judgementOf([]), null);
  assert.equal(judgementOf(['--recordings', 'a', '--out', 'o']), null);
  assert.equal(judgementOf(['--recordings', 'a', '--export', 'f', '--no-judgement']), null);
  assert.equal(judgementOf(['--config', 'c.toml', '--out', 'o', '--export', 'f']), null);
});
