// The pages: links, commands, pictures, and as HTML.
import assert from 'node:assert/strict';
import { existsSync, readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { repositoryFiles } from '../../scripts/lib/lint_checks.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { htmlPage, writeHtmlPages } from '../../scripts/pack/html_pages.mjs';
import { inFolder } from './support/folder.mjs';

const read = (...parts) => readFileSync(inRepository(...parts), 'utf8');
const files = await repositoryFiles();

// README.md and CONTRIBUTING.md: every link and every path that they name is there.

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
  return files.some((file) => expression.test(file));
}

for (const page of ['README.md', 'CONTRIBUTING.md']) {
  test(`every link of ${page} leads to a page and a heading that exist`, () => assert.deepEqual(brokenLinks(page), []));

  test(`every file and folder that ${page} names exists`, () => {
    assert.deepEqual(namedPaths(read(page)).filter((name) => !isThere(name)), []);
  });
}

test('the figures of the README are those of the published benchmark and of the evaluation', () => {
  const readme = read('README.md').replace(/\s+/g, ' ');
  const bench = read('Training/results/benchmarks.md');
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

// What the pages name exists: menus, components, members, commands.
const pageNames = readdirSync(inRepository('Documentation~')).filter((name) => name.endsWith('.md'));
const pages = pageNames.map((name) => ({ name, text: read('Documentation~', name) }));
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

const htmlPages = new Map(pages.map(({ name, text }) => [name.replace(/md$/, 'html'), htmlPage(text, name.slice(0, -3))]));

test('links between the HTML pages lead to a page and a heading that exist', () => {
  const broken = [];
  for (const [name, html] of htmlPages) {
    for (const [, address] of html.matchAll(/<a href="([^":]*)"/g)) {
      const [page, anchor] = address.split('#');
      if (/\.md$/.test(page) && !page.includes('/')) broken.push(`${name}: ${address} leads to the Markdown`);
      if (page !== '' && !page.endsWith('.html')) continue;
      const target = htmlPages.get(page === '' ? name : page);
      if (target === undefined || (anchor !== undefined && !target.includes(`id="${anchor}"`))) broken.push(`${name}: ${address}`);
    }
  }
  assert.deepEqual(broken, []);
});

test('every section that a help button of a component opens exists in HTML', () => {
  const helps = sources.flatMap(({ text }) => [...text.matchAll(/\[HelpPage\(HelpPages\.(\w+) \+ "([^"]+)"\)\]/g)]);
  const page = { Components: 'components.html', Outputs: 'effects-and-outputs.html' };
  assert.ok(helps.length >= 20, `only ${helps.length} help buttons were found`);
  assert.deepEqual(helps.filter(([, constant, anchor]) => !htmlPages.get(page[constant])?.includes(`id="${anchor}"`)).map(([all]) => all), []);
});

test('a page keeps its text: headings get anchors once each, tables and code stay, angle brackets do not become tags', () => {
  const html = htmlPage('# One & two\n\n## `Path` of a *thing*\n\n## Path of a thing\n\n| a | b |\n|---|---|\n| `x<y>` | [there](other.md#part) |\n\n[out](https://a.example/b.md)\n', 'name');
  assert.match(html, /<title>One &amp; two<\/title>/);
  assert.match(html, /id="path-of-a-thing"/);
  assert.match(html, /id="path-of-a-thing-1"/);
  assert.match(html, /<code>x&lt;y&gt;<\/code>/);
  assert.match(html, /href="other\.html#part"/);
  assert.match(html, /href="https:\/\/a\.example\/b\.md"/);
});

test('a folder gets one HTML page for each Markdown page, and pictures still resolve beside them', () => {
  inFolder((folder) => {
    writeFileSync(path.join(folder, 'index.md'), '# Home\n\n![p](images/p.png)\n');
    writeFileSync(path.join(folder, 'other.md'), '# Other\n');
    writeHtmlPages(folder);
    assert.deepEqual(readdirSync(folder).sort(), ['index.html', 'index.md', 'other.html', 'other.md']);
    assert.match(readFileSync(path.join(folder, 'index.html'), 'utf8'), /src="images\/p\.png"/);
    assert.match(readFileSync(path.join(folder, 'other.html'), 'utf8'), /href="index\.html"/);
  });
});
