/**
 * Comments and docstrings of C++, C#, JavaScript and Python sources, as whole blocks. Line comments on consecutive lines,
 * each alone on its line, are one block.
 * @typedef {{line: number, text: string}} Block line: the first line of the block, counted from 1
 */

const cFamily = /\.(c|h|cpp|hpp|cs|js|mjs)$/;
export const hasComments = (name) => cFamily.test(name) || name.endsWith('.py');

/** @returns {Block[]} the blocks of a source file, in order; `name` decides the language */
export function commentBlocks(name, text) {
  const comments = name.endsWith('.py') ? pythonComments(text) : cComments(text, name);
  return joinLineComments(text, comments);
}

/** 'a' in 'x = a' for an expression, so that a following / divides; '' where a value is expected and / begins a pattern. */
const endsValue = (before) => /[\w$)\]}]$/.test(before) && !/\b(return|typeof|case|of|in|yield|await)$/.test(before);

/** Comments of C, C++, C# or JavaScript: {start, end, isLine}. Strings, and JavaScript's patterns and templates, are skipped. */
function cComments(text, name) {
  const isScript = /\.m?js$/.test(name);
  const comments = [];
  // Brace depths at which a template literal continues.
  const templates = [];
  let depth = 0;
  let at = 0;
  const skip = (pattern) => {
    pattern.lastIndex = at;
    const match = pattern.exec(text);
    at = match === null ? at + 1 : at + match[0].length;
  };
  const skipTemplate = () => {
    skip(/(?:\\[^]|[^`\\$]|\$(?!\{))*/y);
    if (text.startsWith('${', at)) {
      templates.push(depth);
      depth += 1;
      at += 2;
    } else {
      at += 1;
    }
  };
  while (at < text.length) {
    const two = text.slice(at, at + 2);
    const one = text[at];
    if (two === '//' || two === '/*') {
      const start = at;
      const close = two === '//' ? text.indexOf('\n', at) : text.indexOf('*/', at + 2) + 2;
      at = close <= 1 && two === '/*' ? text.length : close === -1 ? text.length : close;
      comments.push({ start, end: at, isLine: two === '//' });
    } else if (name.endsWith('.cs') && /^(\$@|@\$|@)"/.test(text.slice(at, at + 3))) {
      skip(/[$@]+"(?:""|[^"])*"/y);
    } else if (/\.(cpp|hpp|h)$/.test(name) && two === 'R"') {
      skip(/R"([^(\s]*)\([^]*?\)\1"/y);
    } else if (one === '"') {
      skip(/"(?:\\[^]|[^"\\\n])*"/y);
    } else if (one === '\'' && (isScript || !/[0-9a-fA-F]/.test(text[at - 1] ?? ''))) {
      skip(/'(?:\\[^]|[^'\\\n])*'/y);
    } else if (isScript && one === '`') {
      at += 1;
      skipTemplate();
    } else if (isScript && one === '/' && !endsValue(text.slice(Math.max(0, at - 200), at).trimEnd())) {
      skip(/\/(?:\\.|\[(?:\\.|[^\]\\\n])*\]|[^/\\[\n])+\//y);
    } else if (isScript && one === '{') {
      depth += 1;
      at += 1;
    } else if (isScript && one === '}') {
      depth -= 1;
      at += 1;
      if (templates.at(-1) === depth) {
        templates.pop();
        skipTemplate();
      }
    } else {
      at += 1;
    }
  }
  return comments;
}

/** Comments and docstrings of Python. A docstring is a string that begins a logical line. */
function pythonComments(text) {
  const comments = [];
  const token = /#[^\n]*|[rRbBuUfF]{0,2}("""|''')(?:\\[^]|(?!\1)[^\\])*\1|[rRbBuUfF]{0,2}(?:"(?:\\[^]|[^"\\\n])*"|'(?:\\[^]|[^'\\\n])*')|[([{]|[)\]}]/g;
  let depth = 0;
  for (const match of text.matchAll(token)) {
    const [word] = match;
    const lead = text.slice(text.lastIndexOf('\n', match.index) + 1, match.index);
    if (word.startsWith('#')) {
      comments.push({ start: match.index, end: match.index + word.length, isLine: true });
    } else if ('([{'.includes(word)) {
      depth += 1;
    } else if (')]}'.includes(word)) {
      depth -= 1;
    } else if (depth === 0 && lead.trim() === '' && /^[rRuU]?["']/.test(word) && !text.slice(0, match.index).trimEnd().endsWith('\\')) {
      comments.push({ start: match.index, end: match.index + word.length, isLine: false });
    }
  }
  return comments;
}

function joinLineComments(text, comments) {
  const blocks = [];
  let previous = null;
  let line = 1;
  let counted = 0;
  for (const comment of comments) {
    line += text.slice(counted, comment.start).split('\n').length - 1;
    counted = comment.start;
    const indent = text.slice(text.lastIndexOf('\n', comment.start) + 1, comment.start);
    const isAlone = indent.trim() === '';
    const words = text.slice(comment.start, comment.end).trimEnd();
    if (previous?.isAlone && comment.isLine && isAlone && previous.lastLine + 1 === line) {
      previous.block.text += `\n${words}`;
      previous.lastLine = line;
      continue;
    }
    const shown = words.split('\n').map((part) => (part.startsWith(indent) && isAlone ? part.slice(indent.length) : part)).join('\n');
    const block = { line, text: shown };
    blocks.push(block);
    previous = { block, isAlone: isAlone && comment.isLine, lastLine: line };
  }
  return blocks.filter(({ text: shown }) => !/^\/\/ namespace( [\w:]+)?$/.test(shown));
}

/** A generator of uniform numbers below 1 (mulberry32): the same seed draws the same blocks on every machine. */
function uniform(seed) {
  let state = seed >>> 0;
  return () => {
    state = (state + 0x6d2b79f5) >>> 0;
    let word = Math.imul(state ^ (state >>> 15), state | 1);
    word ^= word + Math.imul(word ^ (word >>> 7), word | 61);
    return ((word ^ (word >>> 14)) >>> 0) / 2 ** 32;
  };
}

/** `count` members of `items`, drawn without replacement; all of them where there are fewer. */
export function draw(items, count, seed) {
  const left = [...items];
  const next = uniform(seed);
  const drawn = [];
  while (drawn.length < count && left.length > 0) {
    const index = Math.floor(next() * left.length);
    drawn.push(left[index]);
    left[index] = left.at(-1);
    left.pop();
  }
  return drawn;
}
