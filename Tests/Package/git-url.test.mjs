// Reads the package's folder alone, as Unity gets it from a git URL: ...git?path=/Packages/com.haptoflow.runtime
import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { repositoryFiles } from '../../scripts/lint/checks.mjs';
import { checkPackage } from '../../scripts/pack/check_package.mjs';
import { PackageFiles } from '../../scripts/pack/package_files.mjs';

const folder = 'Packages/com.haptoflow.runtime/';
const names = (await repositoryFiles()).filter((name) => name.startsWith(folder));
const files = new PackageFiles(new Map(names.map((name) => [name.slice(folder.length), readFileSync(inRepository(name))])));

test('Unity would refuse, leave out and lose nothing of the folder', () => {
  assert.ok(files.names.length > 900, `${files.names.length} files`);
  assert.deepEqual(checkPackage(files), []);
});

test('the folder has licence, notices, changelog and a README that says what a git URL does not bring', () => {
  for (const name of ['LICENSE.md', 'Third Party Notices.md', 'CHANGELOG.md']) assert.ok(files.has(name), name);
  assert.equal(files.text('LICENSE.md'), readFileSync(inRepository('LICENSE'), 'utf8'));
  assert.match(files.text('README.md').replace(/\s+/g, ' '), /Window > HaptoFlow > Sample Scenes.*A git URL brings no `Documentation~`/);
});

test('nothing is offered that the folder lacks: no samples to import, no folders that Unity would hide', () => {
  assert.ok(!('samples' in JSON.parse(files.text('package.json'))));
  assert.deepEqual(files.folders.filter((name) => name.endsWith('~')), []);
});

test('every asset that the code loads from the package by its path is in the folder', () => {
  const literals = files.endingIn('.cs').flatMap((name) => [...files.text(name).matchAll(/"Packages\/com\.haptoflow\.runtime\/([^"]+)"/g)].map(([, place]) => ({ name, place })));
  assert.ok(literals.length >= 2);
  for (const { name, place } of literals) assert.ok(files.names.some((file) => file.startsWith(place)), `${name}: ${place}`);
  for (const ending of ['wav.bytes', 'json', 'motion.csv']) assert.ok(files.has(`Runtime/SampleScenes/Workshop/Recordings/doormat.${ending}`), ending);
});

test('the menu makes a scene for each sample whose scripts are in the folder', () => {
  const builders = files.names.flatMap((name) => [...(name.match(/^Runtime\/SampleScenes\/\w+\/(\w+Scene)\.cs$/) ?? [])].slice(1));
  const made = [...files.text('Editor/Scene/SampleSceneMenu.cs').matchAll(/Make<(\w+Scene)>\("/g)].map(([, name]) => name);
  assert.deepEqual(made.sort(), builders.sort());
  assert.equal(made.length, 4);
});
