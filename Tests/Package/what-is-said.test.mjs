// What pages and packages say of the product, compared with what it is: its model, its qualities, its measured costs.
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const read = (...words) => readFileSync(inRepository(...words), 'utf8');
const descriptionOf = (...words) => JSON.parse(read(...words)).description;
const beforeItsHeadings = (text) => text.split(/^## /m)[0];

function tierKindsOfTheShippedModel() {
  const file = readFileSync(inRepository('Packages', 'com.haptoflow.runtime', 'Runtime', 'Models', 'default.haptoflow'));
  const header = JSON.parse(file.subarray(32, 32 + file.readUInt32LE(12)).toString('utf8'));
  return header.tiers.map((tier) => tier.kind);
}

const openings = {
  'package.json': descriptionOf('package.json'),
  'the Unity package': descriptionOf('Packages', 'com.haptoflow.runtime', 'package.json'),
  'README.md': beforeItsHeadings(read('README.md')),
  'the package\'s README.md': beforeItsHeadings(read('Packages', 'com.haptoflow.runtime', 'README.md')),
  'index.md': beforeItsHeadings(read('Documentation~', 'index.md')),
  'the demo\'s page': read('scripts', 'demo', 'page.html'),
};

test('what ships is called what its tiers are: a filter that a network corrects, and no network of flow matching', () => {
  assert.deepEqual([...new Set(tierKindsOfTheShippedModel())].sort(), ['refine', 'skeleton'], 'another model: say anew what ships');
  for (const [place, text] of Object.entries(openings)) {
    assert.match(text, /autoregressive\s+filter/, place);
    assert.doesNotMatch(text, /flow.matching\s+network/i, place);
  }
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

test('pages that list the qualities list those that there are', () => {
  for (const [page, opening] of [['glossary', '| quality |'], ['performance', '| Sketch, Draft, Standard |'], ['live-engine', '`sketch`, `draft` and `standard` are'], ['model-format', 'qualities are named `sketch`, `draft` and `standard`']]) {
    const line = read('Documentation~', `${page}.md`).split('\n').find((each) => each.includes(opening));
    assert.ok(line, `${page}.md: ${opening}`);
    assert.doesNotMatch(line, /\bfine\b/i, page);
  }
  assert.match(read('Documentation~', 'glossary.md').split('\n').find((line) => line.startsWith('| quality |')), /sketch, draft, standard or auto/);
});

/** The first number after the name of each row of a table of plain text under a heading of the benchmarks. */
function published(heading, column) {
  const [, block] = read('Documentation~', 'benchmarks.md').split(`\n${heading}`);
  const rows = block.split('\n\n')[0].split('\n').slice(2);
  return Object.fromEntries(rows.map((row) => {
    const [, name, rest] = row.match(/^ {2}(\D+?) {2,}(.*)$/);
    return [name, Number(rest.trim().split(/\s+/)[column])];
  }));
}

test('the costs of effects and outputs are those of the published benchmark', () => {
  const effects = published('effects, 256 frames at 48 kHz, us', 1);
  const outputs = published('outputs, one frame of 13.9 ms, us', 1);
  const names = { 'Haptic Output': 'audio', 'Controller Waveform Output': 'controller waveform', 'Controller Parametric Output': 'controller parametric', 'Motor Output': 'motor' };
  const rows = read('Documentation~', 'effects-and-outputs.md').split('\n').filter((line) => / us (of the worker's time )?a (block|frame)/.test(line) && line.startsWith('|'));
  assert.equal(rows.length, Object.keys(effects).length + Object.keys(outputs).length);
  for (const row of rows) {
    const name = row.match(/^\| \[?([\w ]+?)(?:\]| \|)/)[1];
    const measured = names[name] ? outputs[names[name]] : effects[name.toLowerCase()];
    const said = Number(row.match(/([\d.]+) us (?:of the worker's time )?a (?:block|frame)/)[1]);
    assert.ok(Math.abs(said / measured - 1) < 0.06, `${name}: ${said} us, the benchmark has ${measured}`);
  }
});
