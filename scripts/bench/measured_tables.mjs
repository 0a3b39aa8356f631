import { modelLine, withMeasuredPart } from '../lib/measured_part.mjs';

/** `document` with the text between its two markers replaced by the model's SHA-256 and the printed tables. */
export function withMeasuredTables(document, tables, modelSha256) {
  return withMeasuredPart(document, 'npm run bench -- --publish', `${modelLine(modelSha256)}\n\n\`\`\`\n${tables.trim()}\n\`\`\``);
}

/** The report with the SHA-256 of the measured model added to its description of the model. */
export const withModelSha256 = (report, sha256) => ({ ...report, model: { ...report.model, sha256 } });

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
