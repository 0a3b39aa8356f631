import assert from 'node:assert/strict';
import { mkdtempSync, readdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { repositoryFiles } from '../../scripts/lint/checks.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { htmlPage, writeHtmlPages } from '../../scripts/pack/html_pages.mjs';

const pagesFolder = inRepository('Documentation~');
const names = readdirSync(pagesFolder).filter((name) => name.endsWith('.md')).map((name) => name.slice(0, -3));
const pages = new Map(names.map((name) => [`${name}.html`, htmlPage(readFileSync(path.join(pagesFolder, `${name}.md`), 'utf8'), name)]));

test('links between the HTML pages lead to a page and a heading that exist', () => {
  const broken = [];
  for (const [name, html] of pages) {
    for (const [, address] of html.matchAll(/<a href="([^":]*)"/g)) {
      const [page, anchor] = address.split('#');
      if (/\.md$/.test(page) && !page.includes('/')) broken.push(`${name}: ${address} leads to the Markdown`);
      if (page !== '' && !page.endsWith('.html')) continue;
      const target = pages.get(page === '' ? name : page);
      if (target === undefined || (anchor !== undefined && !target.includes(`id="${anchor}"`))) broken.push(`${name}: ${address}`);
    }
  }
  assert.deepEqual(broken, []);
});

test('every section that a help button of a component opens exists in HTML', async () => {
  const sources = (await repositoryFiles()).filter((name) => name.startsWith('Packages/') && name.endsWith('.cs'));
  const helps = sources.flatMap((name) => [...readFileSync(inRepository(name), 'utf8').matchAll(/\[HelpPage\(HelpPages\.(\w+) \+ "([^"]+)"\)\]/g)]);
  const page = { Components: 'components.html', Outputs: 'effects-and-outputs.html' };
  assert.ok(helps.length >= 20, `only ${helps.length} help buttons were found`);
  assert.deepEqual(helps.filter(([, constant, anchor]) => !pages.get(page[constant])?.includes(`id="${anchor}"`)).map(([all]) => all), []);
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
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-pages-'));
  try {
    writeFileSync(path.join(folder, 'index.md'), '# Home\n\n![p](images/p.png)\n');
    writeFileSync(path.join(folder, 'other.md'), '# Other\n');
    writeHtmlPages(folder);
    assert.deepEqual(readdirSync(folder).sort(), ['index.html', 'index.md', 'other.html', 'other.md']);
    assert.match(readFileSync(path.join(folder, 'index.html'), 'utf8'), /src="images\/p\.png"/);
    assert.match(readFileSync(path.join(folder, 'other.html'), 'utf8'), /href="index\.html"/);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
});
