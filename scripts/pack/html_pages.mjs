import { readdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { Marked } from 'marked';

/** What a heading's anchor is on GitHub, which the links of the pages use. */
export const anchorOf = (heading) =>
  heading.trim().toLowerCase().replaceAll(/[^\p{Letter}\p{Number} _-]/gu, '').replaceAll(' ', '-');

const style = `body { max-width: 46rem; margin: 2rem auto; padding: 0 1rem; font: 1rem/1.5 system-ui, sans-serif; color: #1c1c1c; background: #fff; }
table { border-collapse: collapse; display: block; overflow-x: auto; } th, td { border: 1px solid #c8c8c8; padding: .3rem .6rem; text-align: left; vertical-align: top; }
pre { overflow-x: auto; padding: .8rem; background: #f2f2f2; } code { font-size: .9em; } img { max-width: 100%; background: #fff; }
@media (prefers-color-scheme: dark) { body { color: #ddd; background: #1b1b1b; } a { color: #8ab4f8; } pre { background: #2a2a2a; } th, td { border-color: #555; } }`;

const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;');

/** A link from page to page, with or without an anchor, leads to the HTML beside. */
const toHtml = (address) => (/^[a-z]+:/i.test(address) ? address : address.replace(/^([\w-]+)\.md(?=#|$)/, '$1.html'));

/**
 * A page of Documentation~ as HTML that needs nothing from elsewhere.
 * @param {string} markdown @param {string} name of the page, without its ending
 */
export function htmlPage(markdown, name) {
  const seen = new Map();
  const renderer = {
    heading({ tokens, depth, text }) {
      const anchor = anchorOf(text.replaceAll(/[`*]/g, ''));
      const before = seen.get(anchor) ?? 0;
      seen.set(anchor, before + 1);
      return `<h${depth} id="${before === 0 ? anchor : `${anchor}-${before}`}">${this.parser.parseInline(tokens)}</h${depth}>\n`;
    },
  };
  const walkTokens = (token) => {
    if (token.type === 'link') token.href = toHtml(token.href);
  };
  const body = new Marked({ gfm: true, renderer, walkTokens }).parse(markdown);
  const title = /^# (.*)$/m.exec(markdown)?.[1] ?? name;
  const home = name === 'index' ? '' : '<p><a href="index.html">HaptoFlow: all pages</a></p>\n';
  return `<!doctype html>\n<html lang="en">\n<meta charset="utf-8">\n<meta name="viewport" content="width=device-width">\n` +
    `<title>${escaped(title)}</title>\n<style>${style}</style>\n${home}${body}</html>\n`;
}

/** Writes an HTML file beside every Markdown page of a folder: what the help buttons of the Inspectors open. */
export function writeHtmlPages(folder) {
  for (const file of readdirSync(folder).filter((name) => name.endsWith('.md'))) {
    const name = path.basename(file, '.md');
    writeFileSync(path.join(folder, `${name}.html`), htmlPage(readFileSync(path.join(folder, file), 'utf8'), name));
  }
}
