import { CommandError } from './process.mjs';

/** `document` with the text between its markers, `<!-- measured: begin (command) -->` and `... end -->`, replaced. */
export function withMeasuredPart(document, command, text) {
  const begin = `<!-- measured: begin (${command}) -->`;
  const [from, to] = [document.indexOf(begin), document.indexOf('<!-- measured: end -->')];
  if (from < 0 || to < from) throw new CommandError(`the document has no "${begin}" before a "<!-- measured: end -->"`);
  return `${document.slice(0, from + begin.length)}\n\n${text.trim()}\n\n${document.slice(to)}`;
}
