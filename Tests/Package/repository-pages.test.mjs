// README.md and CONTRIBUTING.md: every link and every path that they name is there, and CONTRIBUTING names every room.
import assert from 'node:assert/strict';
import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { repositoryFiles } from '../../scripts/lint/checks.mjs';

const pages = ['README.md', 'CONTRIBUTING.md'];
const read = (page) => readFileSync(inRepository(page), 'utf8');
const tracked = await repositoryFiles();

/** Anchors of a page's headings, as sites that render Markdown name them. */
const anchorsOf = (text) =>
  [...text.matchAll(/^#+ (.*)$/gm)].map(([, heading]) => heading.trim().toLowerCase().replace(/[^a-z0-9 -]/g, '').replaceAll(' ', '-'));

/** Relative links of a page, with what is wrong with them. */
function brokenLinks(page) {
  return [...read(page).matchAll(/\]\((?!https?:)([^)#\s]*)(?:#([^)\s]+))?\)/g)].flatMap(([, target, anchor]) => {
    const file = target === '' ? page : path.posix.join(path.posix.dirname(page), target);
    if (!existsSync(inRepository(...file.split('/')))) return [`${page} links to ${file}`];
    return anchor !== undefined && !anchorsOf(read(file)).includes(anchor) ? [`${page} links to ${file}#${anchor}`] : [];
  });
}

/**
 * Files and folders in backticks, from the root: a heading "(below `FOLDER`)" gives the folder that its section's paths are
 * relative to. A word without a slash counts where it has an extension of source code or begins a row of a table. `NAME` in
 * a path stands for a name that the reader chooses.
 */
function namedPaths(text) {
  const found = [];
  let base = '';
  for (const line of text.replace(/```[\s\S]*?```/g, '').split('\n')) {
    if (line.startsWith('#')) base = line.match(/\(below `([^`]+)`\)/)?.[1] ?? '';
    for (const [before, word] of line.replace(/\(below `[^`]+`\)/, '').matchAll(/(?:^\| )?`([\w.~/*-]+)`/g)) {
      const isPath = before.startsWith('|') || word.includes('/') || /\.(?:cpp|hpp|h|cs|py|mjs|toml|json|md|txt|asmdef)$/.test(word);
      if (isPath && !/^(?:build|out)\/|NAME/.test(word)) found.push(`${base}${base !== '' && !base.endsWith('/') ? '/' : ''}${word}`);
    }
  }
  return found;
}

/** Whether a path, which may hold "*" for one name or a part of it, leads to a file or folder that git knows. */
function isThere(name) {
  const pattern = name.replace(/\/$/, '').split('*').map((piece) => piece.replace(/[.~]/g, '\\$&')).join('[^/]*');
  const expression = new RegExp(`^${pattern}(?:/|$)`);
  return tracked.some((file) => expression.test(file));
}

for (const page of pages) {
  test(`every link of ${page} leads to a page and a heading that exist`, () => assert.deepEqual(brokenLinks(page), []));

  test(`every file and folder that ${page} names exists`, () => {
    assert.deepEqual(namedPaths(read(page)).filter((name) => !isThere(name)), []);
  });
}

test('the way from stylus to sound names files of C# and C++, each of which exists', () => {
  const way = read('CONTRIBUTING.md').split(/^## /m).find((section) => section.startsWith('From stylus to sound'));
  const files = namedPaths(`## ${way}`);
  assert.ok(files.filter((file) => file.endsWith('.cs')).length >= 6 && files.filter((file) => file.endsWith('pp')).length >= 10, files.join(' '));
});

test('CONTRIBUTING gives every folder of the first two levels a line, and every folder of the editor', () => {
  const named = new Set(namedPaths(read('CONTRIBUTING.md')).map((name) => name.replace(/\/$/, '')));
  const folders = (depth, below = '') => [...new Set(tracked
    .filter((file) => file.startsWith(below) && file.split('/').length > depth)
    .map((file) => file.split('/').slice(0, depth).join('/')))];
  const small = (folder) => ['.ci', '.github'].includes(folder.split('/')[0]);
  const editor = 'Packages/com.haptoflow.runtime/Editor/';
  const wanted = [...folders(2).filter((folder) => !small(folder)), ...folders(4, editor), ...folders(5, editor)];
  assert.deepEqual(wanted.filter((folder) => !named.has(folder)), []);
});

test('paths are read from backticks, below the folder of their heading', () => {
  const text = '## Parts (below `A/B`)\n\n`c.cpp` and `d/e`, not `word` or `out/x`\n| `h` | `i` |\n\n## Others\n`f/g.py`, `f/NAME.py`\n';
  assert.deepEqual(namedPaths(text), ['A/B/c.cpp', 'A/B/d/e', 'A/B/h', 'f/g.py']);
});


test('the figures of the README are those of the published benchmark and of the evaluation', () => {
  const readme = read('README.md').replace(/\s+/g, ' ');
  const bench = read('Documentation~/benchmarks.md');
  const [, paced, pacedP99] = bench.match(/^ {2}standard +refine +1 +[\d.]+ +[\d.]+ +[\d.]+ +[\d.]+ +([\d.]+) +([\d.]+)/m);
  const [, ratio] = bench.match(/speed-up over the paper's architecture, standard: [\d.]+ hot, ([\d.]+) paced/);
  const [, onset, onsetP99] = bench.split('onset, ms')[1].match(/^ {2}256 +\d+ +([\d.]+) +([\d.]+)/m);
  const [, contact, contactP99] = bench.split('contact to sound, ms')[1].match(/^ {2}256 +\d+ +([\d.]+) +([\d.]+)/m);
  const row = JSON.parse(read('Training/haptoflow_paper/results/accuracy-time.json')).rows.find(({ name }) => name === 'standard');
  const [low, high] = row.told_apart_percent_interval;
  const sentences = [
    `${Number(paced).toFixed(2)} ms at the pace of use (median; 99th percentile ${Number(pacedP99).toFixed(2)} ms), ${ratio} times faster`,
    `${Number(onset).toFixed(1)} ms (median; 99th percentile ${Number(onsetP99).toFixed(1)} ms) with audio blocks of 256 frames`,
    `${Number(contact).toFixed(1)} ms (median; 99th percentile ${Number(contactP99).toFixed(1)} ms), under the same conditions`,
    `${row.told_apart_percent.median.toFixed(0)} % (median over labels, 95 % interval ${low.toFixed(0)} to ${high.toFixed(0)} %)`,
  ];
  assert.deepEqual(sentences.filter((sentence) => !readme.includes(sentence)), []);
});
