// lint: checks format, C++ rules, syntax, workflows and this repository's own rules (--all: C++ rules on every file)
import { buildNative } from './lib/native_build.mjs';
import { parsed, runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';
import { changedFiles, checkCSharpFormat, checkContent, checkFormat, checkJson, checkNatives, checkPythonSyntax, checkScriptSyntax, checkTidy, checkWorkflows, repositoryFiles } from './lib/lint_checks.mjs';

const help = `usage: ./run lint [--all]

Checks format, C++ rules, syntax, workflows and this repository's own rules.

  --all   clang-tidy on every file, not only on changed ones`;

await runMain('lint', async (words) => {
  const { all } = parsed(words, { all: { type: 'boolean', default: false } }).values;
  await setUp(['build', 'test', 'lint']);
  await buildNative({ preset: 'lint', tests: true, targets: ['help'] });

  const files = await repositoryFiles();
  const tidied = all ? files : await changedFiles(files);
  const checks = [
    ['format of C++', () => checkFormat(files)],
    ['clang-tidy', () => checkTidy(tidied)],
    ['format of C#', () => checkCSharpFormat(files)],
    ['syntax of Python', () => checkPythonSyntax(files)],
    ['syntax of scripts', () => checkScriptSyntax(files)],
    ['workflows', () => checkWorkflows(files)],
    ['JSON', () => checkJson(files)],
    ['content', () => checkContent(files)],
    ['native libraries in git', checkNatives],
  ];
  let found = 0;
  for (const [name, check] of checks) {
    const { checked, complaints, warnings = [] } = await check();
    warnings.forEach((warning) => console.log(`lint: warning: ${warning}`));
    complaints.forEach((complaint) => console.log(complaint));
    console.log(`lint: ${name}: ${checked} files, ${complaints.length === 0 ? 'good' : `${complaints.length} complaints`}`);
    found += complaints.length;
  }
  return found > 0 ? 1 : 0;
}, { help });
