// What `npm run project` says of a folder that Unity is to open.
import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test, { after } from 'node:test';
import { readHeader } from '../../scripts/lib/c_interface.mjs';
import { resolvePackages } from '../../scripts/project/packages.mjs';

const folders = [];
after(() => folders.forEach((folder) => rmSync(folder, { recursive: true, force: true })));

const good = {
  'Packages/manifest.json': { dependencies: { 'org.runtime': 'file:../node_modules/org.runtime', 'com.unity.inputsystem': '1.7.0' } },
  'Packages/com.felt/package.json': { name: 'com.felt', version: '1.0.0', dependencies: { 'org.runtime': '0.4.9', 'com.unity.nuget.newtonsoft-json': '3.2.1' } },
  'node_modules/org.runtime/package.json': { name: 'org.runtime', version: '0.4.9' },
};

function project(changes = {}) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-project-'));
  folders.push(folder);
  for (const [name, content] of Object.entries({ ...good, ...changes }).filter(([, each]) => each !== null)) {
    mkdirSync(path.dirname(path.join(folder, name)), { recursive: true });
    writeFileSync(path.join(folder, name), typeof content === 'string' ? content : JSON.stringify(content));
  }
  return folder;
}

const complains = (changes, pattern) => assert.throws(() => resolvePackages(project(changes)), pattern);

test('packages are found in the project, by file: and at Unity', () => {
  const found = resolvePackages(project());
  assert.deepEqual(found.map(({ name, version, place }) => [name, version, place]), [
    ['com.felt', '1.0.0', 'project'], ['org.runtime', '0.4.9', 'node_modules'], ['com.unity.inputsystem', '1.7.0', 'Unity'],
  ]);
});

test('without npm ci the message names it', () => complains({ 'node_modules/org.runtime/package.json': null }, /org\.runtime.*is missing: run `npm ci`/));

test('a version of before the last npm ci is named', () => {
  complains({ 'node_modules/org.runtime/package.json': { name: 'org.runtime', version: '0.4.8' } }, /needs org\.runtime 0\.4\.9; .* holds 0\.4\.8: run `npm ci`/);
});

test('a dependency that nothing provides, and a folder that holds another package, are named', () => {
  complains({ 'Packages/manifest.json': { dependencies: {} } }, /manifest\.json: lacks "org\.runtime", which com\.felt needs/);
  complains({ 'node_modules/org.runtime/package.json': { name: 'org.other', version: '0.4.9' } }, /"org\.runtime": .* holds org\.other/);
});

test('a manifest that is no JSON is named', () => complains({ 'Packages/manifest.json': '{ "dependencies": ' }, /manifest\.json: /));

test('the header\'s structs and functions are read with arrays, nested structs and handles', () => {
  const { structs, functions } = readHeader(`
#define N 4
typedef uint64_t haptoflow_voice;
typedef struct haptoflow_inner { uint32_t struct_size; } haptoflow_inner;
typedef struct haptoflow_outer {
    /* A comment; with a semicolon. */
    haptoflow_inner inner;
    float weights[N];
    const char* name;
} haptoflow_outer;
HAPTOFLOW_API haptoflow_status haptoflow_voice_create(const haptoflow_outer* options,
                                                      haptoflow_voice* voice);
HAPTOFLOW_API const char* haptoflow_version(void);
`);
  assert.deepEqual(structs.at(-1).fields, [
    { type: 'haptoflow_inner', name: 'inner', length: null }, { type: 'float', name: 'weights', length: 4 }, { type: 'const char*', name: 'name', length: null },
  ]);
  assert.deepEqual(functions, [
    { name: 'haptoflow_voice_create', returned: 'haptoflow_status', parameters: ['const haptoflow_outer*', 'haptoflow_voice*'] },
    { name: 'haptoflow_version', returned: 'const char*', parameters: [] },
  ]);
});
