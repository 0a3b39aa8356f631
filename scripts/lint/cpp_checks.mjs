import { readFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { inRepository, repositoryRoot, run } from '../lib/process.mjs';
import { presetFolder } from '../lib/native_build.mjs';
import { endingIn } from './files.mjs';

const lines = (output) => output.split('\n').filter((line) => line.trim() !== '');

/** Checks that clang-format would change nothing. */
export async function checkFormat(files) {
  const sources = endingIn(files, '.cpp', '.hpp', '.h');
  const { exitCode, output } = await run('clang-format', ['--dry-run', '-Werror', ...sources], { quiet: true });
  const complaints = lines(output).filter((line) => line.includes(': error: '));
  return { checked: sources.length, complaints: exitCode !== 0 && complaints.length === 0 ? lines(output) : complaints };
}

/**
 * The findings of clang-tidy in files of this repository. Errors in headers of the standard library are left out: an older
 * clang cannot read a newer library, and the compilers of the builds can.
 */
export function findingsOfTidy(output) {
  return lines(output).filter((line) => /: (error|warning): /.test(line) && line.startsWith(`${repositoryRoot}${path.sep}`));
}

/** Checks that clang-tidy finds nothing in the files that a build compiles. */
export async function checkTidy(files) {
  const folder = presetFolder('lint');
  const commands = JSON.parse(readFileSync(inRepository(folder, 'compile_commands.json'), 'utf8'));
  const compiled = new Set(commands.map(({ file }) => path.relative(repositoryRoot, file)));
  const queue = endingIn(files, '.cpp').filter((name) => compiled.has(name));
  const checked = queue.length;
  const complaints = [];
  const worker = async () => {
    for (let name = queue.shift(); name !== undefined; name = queue.shift()) {
      const { exitCode, output } = await run('clang-tidy', ['-p', folder, '--quiet', name], { quiet: true });
      if (exitCode === 0) continue;
      const hasRun = /: (error|warning): /.test(output);
      complaints.push(...(hasRun ? findingsOfTidy(output) : [`${name}: clang-tidy ended with ${exitCode}`]));
    }
  };
  await Promise.all(os.cpus().map(worker));
  return { checked, complaints };
}
