// The folders of NativePlugin: what the plugin may include, and the paths that CMake names.
import assert from 'node:assert/strict';
import { existsSync, readFileSync, readdirSync } from 'node:fs';
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

/** The paths inside the repository that a CMake file names, relative to the root. */
function namedPaths(file) {
  const text = read(file).replace(/^\s*#.*$/gm, '');
  const folder = path.dirname(path.relative(inRepository(), file));
  // Targets' sources are named relative to the list's folder.
  const relative = [
    ...text.matchAll(/add_subdirectory\(([\w/.-]+)\)/g),
    ...text.matchAll(/(?:^|[\s"])((?:\.\.\/)*[\w/-]+\.(?:cpp|c|cpp\.in|cmake\.in))(?=[\s")]|$)/gm),
  ].map(([, name]) => path.join(folder, name));
  const rooted = [...text.matchAll(/\$\{(PROJECT_SOURCE_DIR|CMAKE_CURRENT_SOURCE_DIR|CMAKE_CURRENT_LIST_DIR|sourceDir)\}\/([^"\s;)>]+)/g)].map(([, root, name]) =>
    path.join(/^(PROJECT_SOURCE_DIR|sourceDir)$/.test(root) ? '.' : folder, name),
  );
  // What a build or `npm ci` makes, and the names of loops' variables, are not in the repository.
  return [...relative, ...rooted].filter((name) => !/\$\{|node_modules|^build\//.test(name));
}

const generated = new Set(['NativePlugin/src/effects/built_in_profiles.cpp']);

test('every file and folder that CMake names is in the repository', () => {
  const lists = [
    inRepository('CMakeLists.txt'),
    inRepository('CMakePresets.json'),
    ...[...filesBelow('NativePlugin'), ...filesBelow('Tests', 'Native')].filter((file) => /CMakeLists\.txt$|\.cmake$/.test(file)),
  ];
  const named = lists.flatMap((file) => namedPaths(file).map((name) => ({ file: path.relative(inRepository(), file), name })));
  assert.ok(named.length > 250, `${named.length} paths were found`);
  assert.deepEqual(named.filter(({ name }) => !generated.has(name) && !existsSync(inRepository(name))), []);
});

test('every test program that a script names is a folder of Tests/Native', () => {
  const names = [
    ...[...read(inRepository('scripts', 'lib', 'test_runners.mjs')).matchAll(/program: '(\w+)'/g)].map(([, name]) => name),
    ...[...read(inRepository('scripts', 'test-soak.mjs')).matchAll(/program: '(\w+)'/g)].map(([, name]) => name),
    ...read(inRepository('scripts', 'lib', 'platform_tests.mjs')).match(/const programs = \[([^\]]*)\]/)[1].match(/\w+/g),
  ];
  assert.ok(names.length > 10, `${names.length} names were found`);
  assert.deepEqual(names.filter((name) => !existsSync(inRepository('Tests', 'Native', name, 'CMakeLists.txt'))), []);
});
