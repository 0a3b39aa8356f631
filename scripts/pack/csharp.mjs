/** What the package checker needs to know of C# sources: which lines the editor alone compiles. */

/** The source with comments and the insides of strings blanked, line by line as before. */
export function withoutCommentsAndStrings(source) {
  const blank = (text) => text.replace(/[^\n]/g, ' ');
  const pattern = /\/\/[^\n]*|\/\*[\s\S]*?\*\/|\$?@"(?:[^"]|"")*"|@\$"(?:[^"]|"")*"|\$?"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'/g;
  return source.replace(pattern, blank);
}

const onlyInEditor = (condition) => /(^|[^!\w])UNITY_EDITOR\b/.test(condition) && !condition.includes('||');

/**
 * The lines that a player compiles too, numbered from 1: those that stand in no branch of UNITY_EDITOR.
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

/** Lines that name a namespace or one below it, as "UnityEditor" or "UnityEditor.Build". */
export const linesNaming = (lines, namespace) => lines.filter(({ text }) => new RegExp(`(^|[^\\w.])${namespace}\\b`).test(text));
