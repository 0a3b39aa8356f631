import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const page = readFileSync(inRepository('Documentation~', 'stability.md'), 'utf8');

const native = inRepository('Tests', 'Native');
const sources = readdirSync(native)
  .flatMap((folder) => (folder.includes('.') ? [] : readdirSync(path.join(native, folder)).map((name) => path.join(native, folder, name))))
  .filter((file) => file.endsWith('_test.cpp'));

test('every test that the stability page names exists', () => {
  const text = sources.map((file) => readFileSync(file, 'utf8')).join('\n');
  // "…" stands for the rest of a name; what a program makes of a number is left off.
  const names = [...page.matchAll(/`(?:OnModel\/)?(…?)([A-Z][A-Za-z0-9]{4,})(…?)\/?`/g)];
  assert.ok(names.length > 80, `${names.length} names were found on the page`);
  const missing = names
    .filter(([, before, name, after]) => {
      const pattern = before === '…' ? `"${name.replace(/(?<=UpdateRate)\d+$/, '')}"` : `\\b${name}${after === '…' ? '' : '\\b'}`;
      return !new RegExp(pattern).test(text);
    })
    .map(([whole]) => whole);
  assert.deepEqual(missing, []);
});

test('every file that the stability page names exists', () => {
  const files = [...page.matchAll(/Tests\/Native\/[\w/.]*\.cpp/g)].map(([file]) => file);
  assert.ok(files.length > 5);
  assert.deepEqual(files.filter((file) => !existsSync(inRepository(file))), []);
});

test('a test that the stability page places in a file is in that file', () => {
  const misplaced = [];
  for (const section of page.split('\n## ')) {
    const folder = section.match(/\| test, (Tests\/Native\/\w+\/) \|/)?.[1] ?? '';
    for (const [, list, given] of section.matchAll(/((?:`…?\w+…?`(?:, )?)+) \(([\w/]+\.cpp)\)/g)) {
      const file = given.startsWith('Tests/') ? given : folder + given;
      const text = existsSync(inRepository(file)) ? readFileSync(inRepository(file), 'utf8') : '';
      for (const [, name] of list.matchAll(/`…?(\w+)…?`/g)) if (!text.includes(name)) misplaced.push(`${name} in ${file}`);
    }
  }
  assert.deepEqual(misplaced, []);
});
