import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const read = (...parts) => readFileSync(inRepository(...parts), 'utf8');
const runtime = ['Packages', 'com.haptoflow.runtime', 'Runtime'];

const fullScaleMps2 = 200;

/** The number in the only line of a file that matches a pattern. */
function numberIn(parts, pattern) {
  const found = [...read(...parts).matchAll(new RegExp(pattern, 'g'))];
  assert.equal(found.length, 1, `${parts.join('/')}: expected one line of the form ${pattern}`);
  return Number(found[0][1]);
}

test('every language has the same default full scale as the C header', () => {
  const header = numberIn(['NativePlugin', 'include', 'haptoflow', 'haptoflow.h'], '#define HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2 ([\\d.]+)');
  const homes = {
    'C++': numberIn(['NativePlugin', 'src', 'dsp', 'limiter.hpp'], 'defaultFullScaleMps2 = ([\\d.]+)F;'),
    'C#': numberIn([...runtime, 'Core', 'Native', 'HapticEngine.cs'], 'DefaultFullScaleMps2 = ([\\d.]+);'),
    Python: numberIn(['Training', 'haptoflow_benchmark', 'engine_render.py'], '\\nFULL_SCALE_MPS2 = ([\\d.]+)'),
    'the demo': numberIn(['scripts', 'demo', 'demo.py'], '\\nFULL_SCALE_MPS2 = ([\\d.]+)'),
    "the command line's help": numberIn(['NativePlugin', 'cli', 'render_command.cpp'], '\\+-1 in the WAV is (\\d+) m/s'),
  };
  for (const [language, value] of Object.entries(homes)) assert.equal(value, header, language);
});
