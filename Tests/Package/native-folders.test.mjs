// The folders of NativePlugin: what the plugin may include and link.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const filesBelow = (...folder) =>
  readdirSync(inRepository(...folder), { recursive: true, withFileTypes: true })
    .filter((entry) => entry.isFile())
    .map((entry) => path.join(entry.parentPath ?? entry.path, entry.name));

const read = (file) => readFileSync(file, 'utf8');

const plugin = [...filesBelow('NativePlugin', 'src'), ...filesBelow('NativePlugin', 'include')];

test('no source of the plugin includes the headless contact model, the benchmarks, the command line or GLM', () => {
  const sources = plugin.filter((file) => /\.(c|cpp|hpp|h)$/.test(file));
  assert.ok(sources.length > 100, `${sources.length} sources were found`);
  const foreign = sources.flatMap((file) =>
    [...read(file).matchAll(/#include ["<](headless|bench|cli|glm)\/[^">]*/g)].map(([line]) => `${path.relative(inRepository(), file)}: ${line}`),
  );
  assert.deepEqual(foreign, []);
});

test('no library of the plugin links the headless contact model, the benchmarks, the command line or GLM', () => {
  const lists = plugin.filter((file) => path.basename(file) === 'CMakeLists.txt');
  assert.ok(lists.length > 5, `${lists.length} CMakeLists.txt were found`);
  const foreign = lists.flatMap((file) => [...read(file).matchAll(/\b(haptoflow_(headless|bench|cli\w*)|glm::\w+)\b/g)].map(([name]) => `${path.relative(inRepository(), file)}: ${name}`));
  assert.deepEqual(foreign, []);
});
