// What the pages name exists: menus, components, members, commands.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { repositoryFiles } from '../../scripts/lint/checks.mjs';

const read = (...parts) => readFileSync(inRepository(...parts), 'utf8');
const pageNames = readdirSync(inRepository('Documentation~')).filter((name) => name.endsWith('.md'));
const pages = pageNames.map((name) => ({ name, text: read('Documentation~', name) }));
const files = await repositoryFiles();
const readmes = files.filter((name) => /Samples~\/.*README\.md$/.test(name) && !name.includes('HeadlessScenes')).map((name) => ({ name, text: read(name) }));
const unityPages = [...pages, ...readmes];
const sources = files
  .filter((name) => name.startsWith('Packages/') && name.endsWith('.cs'))
  .map((name) => ({ name, text: read(name) }));
const runtime = sources.filter(({ name }) => !name.includes('/Editor/'));

test('every menu that a page names is a menu of the package', () => {
  const menus = sources.flatMap(({ text }) => [...text.matchAll(/"((?:Window|GameObject)\/HaptoFlow\/[^"]+)"/g)].map(([, menu]) => menu.replace(/ _?[%#&].*$/, '')));
  const assets = sources.flatMap(({ text }) => [...text.matchAll(/menuName = "([^"]+)"/g)].map(([, menu]) => `Assets/Create/${menu}`));
  const known = [...menus, ...assets];
  for (const { name, text } of unityPages) {
    const words = text.replace(/\s+/g, ' ');
    for (const [, named] of words.matchAll(/((?:Window|GameObject|Assets > Create) > HaptoFlow > [^*.,|)]+?)(?=\*\*|[.,|)]| makes| proposes)/g)) {
      const menu = named.trim().replaceAll(' > ', '/');
      const wanted = menu.includes('(') ? `${menu})` : menu;
      assert.ok(known.some((one) => one === wanted || one.startsWith(`${wanted}/`)), `${name}: ${named}`);
    }
  }
});

test('every component that a page adds is in the component menu', () => {
  const menus = sources.flatMap(({ text }) => [...text.matchAll(/AddComponentMenu\("HaptoFlow\/([^"]+)"\)/g)].map(([, menu]) => menu));
  assert.ok(menus.length >= 5);
  for (const { name, text } of unityPages) {
    for (const [, named] of text.replace(/\s+/g, ' ').matchAll(/\*\*(?:Add Component > )?HaptoFlow > ([^*]+)\*\*/g)) assert.ok(menus.includes(named), `${name}: ${named}`);
  }
});

test('every type and member of HaptoFlow that a page names exists and is public', () => {
  const all = runtime.map(({ text }) => text).join('\n');
  const types = new Set([...all.matchAll(/public (?:(?:sealed|abstract|static|readonly|unsafe) )*(?:class|struct|enum|delegate \w+) (\w+)/g)].map(([, type]) => type));
  for (const { name, text } of unityPages) {
    const code = [...text.matchAll(/`([^`\n]+)`/g), ...text.matchAll(/```csharp\n([\s\S]*?)```/g)].map(([, words]) => words).join('\n');
    for (const [, type, member] of code.matchAll(/\b(Haptics|Haptic[A-Z]\w*|HaptoFlow[A-Z]\w*|(?:Voice|Engine)Statistics|(?:Pressure|InputAction|MetaAction)TipForce|TipForceSource|OutputRoute|ContactState)(?:\.(\w+))?/g)) {
      if (['HaptoFlowChannel', 'HaptoFlowStrength', 'HaptoFlowVoice'].includes(type)) continue;
      assert.ok(types.has(type), `${name}: ${type}`);
      if (member !== undefined && !['cs', 'asset'].includes(member)) assert.match(all, new RegExp(`(public|protected)[^;={(]*\\b${member}\\b|^ +${member}( = \\d+)?,$`, 'm'), `${name}: ${type}.${member}`);
    }
  }
});

test('every npm script that a page names exists', () => {
  const { scripts } = JSON.parse(read('package.json'));
  for (const { name, text } of unityPages) {
    for (const [, script] of text.matchAll(/(?:npm run|\.\/run) ([a-z][a-z:]*)/g)) assert.ok(scripts[script], `${name}: npm run ${script}`);
  }
});
