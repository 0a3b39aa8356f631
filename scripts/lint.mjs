// lint: checks format, C++ rules, syntax, workflows and this repository's own rules (--all: every file, every warning)
import { parseArgs } from 'node:util';
import { buildNative } from './lib/native_build.mjs';
import { CommandError, runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';
import { changedFiles, checkCSharpFormat, checkContent, checkFormat, checkJson, checkNatives, checkPythonSyntax, checkScriptSyntax, checkThreadTags, checkTidy, checkWarnings, checkWorkflows, repositoryFiles } from './lint/checks.mjs';

const help = `usage: ./run lint [--all]

Checks format, C++ rules, syntax, workflows and this repository's own rules.

  --all   clang-tidy on every file, not only on changed ones, and every warning of Clang on the shipped sources`;

await runMain('lint', async (words) => {
  let all;
  try {
    ({ values: { all } } = parseArgs({ args: words, options: { all: { type: 'boolean', default: false } } }));
  } catch (error) {
    throw new CommandError(error.message, 2);
  }
  await setUp(['build', 'test', 'lint']);
  if (all) await setUp(['libcxx', 'realtime']);
  await buildNative({ preset: 'lint', tests: true, targets: ['help'] });

  const files = await repositoryFiles();
  const tidied = all ? files : await changedFiles(files);
  const checks = [
    ['format of C++', () => checkFormat(files)],
    ['clang-tidy', () => checkTidy(tidied)],
    ...(all ? [['warnings of Clang', checkWarnings]] : []),
    ['format of C#', () => checkCSharpFormat(files)],
    ['syntax of Python', () => checkPythonSyntax(files)],
    ['syntax of scripts', () => checkScriptSyntax(files)],
    ['workflows', () => checkWorkflows(files)],
    ['JSON', () => checkJson(files)],
    ['thread tags of the C ABI', () => checkThreadTags(files)],
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
