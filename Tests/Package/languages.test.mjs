// What C, C#, C++, JavaScript and Python each state is the same in all.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const read = (...parts) => readFileSync(inRepository(...parts), 'utf8');
const runtime = ['Packages', 'com.haptoflow.runtime', 'Runtime'];

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

/** The qualities of haptoflow.h by name, with their numbers. */
function qualities() {
  const found = [...read('NativePlugin', 'include', 'haptoflow', 'haptoflow.h').matchAll(/HAPTOFLOW_QUALITY_(\w+) = (\d+)/g)];
  return Object.fromEntries(found.map(([, name, number]) => [name.toLowerCase(), Number(number)]));
}

test('C, C#, JavaScript and its types have the same qualities with the same numbers', () => {
  const wanted = qualities();
  assert.deepEqual(Object.keys(wanted).sort(), ['auto', 'draft', 'sketch', 'standard']);
  const csharp = read('Packages', 'com.haptoflow.runtime', 'Runtime', 'Core', 'Native', 'HapticEngine.cs').match(/enum HapticQuality\s*\{([^}]*)\}/)[1];
  assert.deepEqual(Object.fromEntries([...csharp.matchAll(/^\s+(\w+) = (\d+),/gm)].map(([, name, number]) => [name.toLowerCase(), Number(number)])), wanted);
  const script = read('Web', 'engine', 'js', 'haptoflow.mjs').match(/const qualities = \{([^}]*)\}/)[1];
  assert.deepEqual(Object.fromEntries([...script.matchAll(/(\w+): (\d+)/g)].map(([, name, number]) => [name, Number(number)])), wanted);
  const types = read('Web', 'engine', 'js', 'haptoflow.d.ts').match(/export type Quality = ([^;]*);/)[1];
  assert.deepEqual([...types.matchAll(/'(\w+)'/g)].map(([, name]) => name).sort(), Object.keys(wanted).sort());
});
