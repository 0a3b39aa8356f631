// `./run evaluate` compares one model with recordings, or measures the rows of the comparison.
import assert from 'node:assert/strict';
import test from 'node:test';
import { evaluatingPackage } from '../../scripts/lib/evaluating_package.mjs';

test('arguments that name recordings, a model or labels go to the program that compares one model', () => {
  for (const words of [['--recordings', 'a'], ['--model=own.haptoflow'], ['--quick', '--labels', 'l.toml']]) {
    assert.equal(evaluatingPackage(words), 'haptoflow_benchmark', words.join(' '));
  }
});

test('all other arguments go to the program that measures the rows', () => {
  for (const words of [[], ['--quick'], ['--rows', 'standard'], ['--rows', 'model']]) {
    assert.equal(evaluatingPackage(words), 'haptoflow_paper', words.join(' '));
  }
});
