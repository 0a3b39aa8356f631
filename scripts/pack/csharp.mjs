/** Reads C# sources for the package checker: which lines only the editor compiles. */

/** The source with comments and the content of strings replaced by spaces; line numbers stay. */
export function withoutCommentsAndStrings(source) {
  const blank = (text) => text.replace(/[^\n]/g, ' ');
  const pattern = /\/\/[^\n]*|\/\*[\s\S]*?\*\/|\$?@"(?:[^"]|"")*"|@\$"(?:[^"]|"")*"|\$?"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'/g;
  return source.replace(pattern, blank);
}

const onlyInEditor = (condition) => /(^|[^!\w])UNITY_EDITOR\b/.test(condition) && !condition.includes('||');

/**
 * The lines that a player compiles, numbered from 1: those outside the branches for UNITY_EDITOR.
 * @returns {{number: number, text: string}[]}
 */
export function playerLines(source) {
  const open = [];
  const lines = [];
  withoutCommentsAndStrings(source).split('\n').forEach((text, index) => {
    const directive = text.match(/^\s*#\s*(if|elif|else|endif)\b(.*)$/);
    if (!directive) {
      if (!open.some((branch) => branch.isEditor)) lines.push({ number: index + 1, text });
      return;
    }
    const [, word, condition] = directive;
    if (word === 'if') open.push({ isEditor: onlyInEditor(condition), condition });
    else if (word === 'endif') open.pop();
    else if (open.length > 0) {
      const before = open.pop().condition;
      const isElseOfPlayer = word === 'else' && /!\s*UNITY_EDITOR\b/.test(before) && !before.includes('&&');
      open.push({ isEditor: word === 'elif' ? onlyInEditor(condition) : isElseOfPlayer, condition });
    }
  });
  return lines;
}

/** Lines that name a namespace or one nested in it, such as "UnityEditor" or "UnityEditor.Build". */
export const linesNaming = (lines, namespace) => lines.filter(({ text }) => new RegExp(`(^|[^\\w.])${namespace}\\b`).test(text));
