import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { CommandError, inRepository } from './process.mjs';
import { countsOfJunit } from './test_results.mjs';

/** `document` with the text between its markers, `<!-- measured: begin (command) -->` and `... end -->`, replaced. */
export function withMeasuredPart(document, command, text) {
  const begin = `<!-- measured: begin (${command}) -->`;
  const [from, to] = [document.indexOf(begin), document.indexOf('<!-- measured: end -->')];
  if (from < 0 || to < from) throw new CommandError(`the document has no "${begin}" before a "<!-- measured: end -->"`);
  return `${document.slice(0, from + begin.length)}\n\n${text.trim()}\n\n${document.slice(to)}`;
}

// Names the model that pages and results were made with, by its SHA-256.

export const shippedModel = inRepository('Packages', 'com.haptoflow.runtime', 'Runtime', 'Models', 'default.haptoflow');

export const sha256OfBytes = (bytes) => createHash('sha256').update(bytes).digest('hex');

export const sha256Of = (file) => sha256OfBytes(readFileSync(file));

/** The line of a page that names the model. */
export const modelLine = (sha256) => `Model: SHA-256 \`${sha256}\`.`;

const property = (xml, name) => [...xml.matchAll(new RegExp(`\\bname="${name}" value="(-?[\\d.]+)"`, 'g'))].map(([, value]) => Number(value));

function median(values) {
  const ordered = [...values].sort((a, b) => a - b);
  const middle = ordered.length >> 1;
  return ordered.length % 2 === 1 ? ordered[middle] : (ordered[middle - 1] + ordered[middle]) / 2;
}

/** The figures in a proof's result file besides its counts; empty where there are none. */
function found(xml) {
  const changes = property(xml, 'level_change_db').map(Math.abs);
  if (changes.length === 0) return '';
  const fits = property(xml, 'spectrum_gfc');
  return `; last minute against first on ${changes.length} labels: level changed by at most ${Math.max(...changes).toFixed(2)} dB (median ` +
    `${median(changes).toFixed(2)}), goodness of fit of the spectra at least ${Math.min(...fits).toFixed(4)} (median ${median(fits).toFixed(4)})`;
}

/**
 * The soak's measured part of the stability page.
 * @param {{about: string, xml: string}[]} proofs each with the JUnit file that Google Test wrote
 * @param {{date: string, machine: string, modelSha256: string}} run
 */
export function soakTable(proofs, { date, machine, modelSha256 }) {
  const rows = proofs.map(({ about, xml }) => {
    const { passed, failed } = countsOfJunit(xml);
    const seconds = Number(xml.match(/<testsuites[^>]*\btime="([\d.]+)"/)?.[1] ?? NaN);
    return `| ${about} | ${passed} of ${passed + failed} | ${seconds.toFixed(0)} | ${found(xml).replace(/^; /, '')} |`;
  });
  return [modelLine(modelSha256), '', `Run on ${date}: ${machine}.`, '', '| proof | tests passed | seconds | found |', '|---|---|---|---|', ...rows].join('\n');
}
