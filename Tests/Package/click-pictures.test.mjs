// The drawings of menus and clicks are on their pages, and show what is there.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const read = (...parts) => readFileSync(inRepository(...parts), 'utf8');
const names = readdirSync(inRepository('Documentation~', 'images')).flatMap((file) => file.match(/^((?:install|first-scene)-\d.*)\.svg$/)?.[1] ?? []);
const drawn = (name) => read('Documentation~', 'images', `${name}.svg`);

test('the pages of installation and first scene show every drawing, with a sentence for those who cannot see it', () => {
  assert.equal(names.length, 6);
  const pages = { install: read('Documentation~', 'installation.md'), first: read('Documentation~', 'getting-started.md') };
  for (const name of names) assert.match(pages[name.split('-')[0]], new RegExp(`!\\[Drawing: [^\\]]{20,}\\]\\(images/${name}\\.svg\\)`), name);
});

test('the drawn entries of GameObject > HaptoFlow are entries of the menu', () => {
  const source = read('Packages', 'com.haptoflow.runtime', 'Editor', 'Scene', 'CreateMenu.cs');
  const menus = [...source.matchAll(/"GameObject\/HaptoFlow\/([^"]+)"/g)].map(([, menu]) => menu);
  const shown = [...drawn('first-scene-1-menu').matchAll(/>([^<>]+)<\/text>/g)].map(([, words]) => words);
  assert.ok(menus.length >= 6);
  assert.deepEqual(menus.filter((menu) => shown.includes(menu)), ['First Scene', 'Tagged Cube', 'Mouse Pen', 'XR Pen (Right Hand)', 'XR Pen (Left Hand)']);
});

test('the picture of the two tarballs shows the names that pack gives them', () => {
  const { name, version, dependencies } = JSON.parse(read('Packages', 'com.haptoflow.runtime', 'package.json'));
  const picture = drawn('install-3-two-files');
  assert.ok(picture.includes(`>${name}-${version}.tgz<`));
  const tarball = 'com.github.asus4.onnxruntime';
  assert.ok(picture.includes(`>${tarball}-${dependencies[tarball]}.tgz<`));
  const others = Object.keys(dependencies).filter((dependency) => dependency !== tarball);
  assert.ok(others.every((dependency) => dependency.startsWith('com.unity.')), 'Unity installs only its own packages without a tarball');
});
