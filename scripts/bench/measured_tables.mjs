import { CommandError } from '../lib/process.mjs';

const begin = '<!-- measured: begin (npm run bench -- --publish) -->';
const end = '<!-- measured: end -->';

/** `document` with the text between its two markers replaced by the tables, as they were printed. */
export function withMeasuredTables(document, tables) {
  const [from, to] = [document.indexOf(begin), document.indexOf(end)];
  if (from < 0 || to < from) throw new CommandError(`the document has no "${begin}" before a "${end}"`);
  return `${document.slice(0, from + begin.length)}\n\n\`\`\`\n${tables.trim()}\n\`\`\`\n\n${document.slice(to)}`;
}

/**
 * Words of the command line for one run.
 * @param {{quick?: boolean, only?: string, events?: string, model?: string}} options
 * @param {string} report where the JSON goes  @param {string | null} paperModel null for none
 */
export function benchArguments(options, report, paperModel) {
  return [
    'bench', '--output', report,
    ...(paperModel ? ['--paper-model', paperModel] : []),
    ...(options.quick ? ['--quick'] : []),
    ...['only', 'events', 'model'].flatMap((name) => (options[name] === undefined ? [] : [`--${name}`, options[name]])),
  ];
}
