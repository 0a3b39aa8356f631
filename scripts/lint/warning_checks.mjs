import { existsSync, readFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { presetFolder } from '../lib/native_build.mjs';
import { inRepository, repositoryRoot, run, succeeds } from '../lib/process.mjs';

/**
 * Warnings of Clang that the shipped sources are not held to, and why. All others are on: among them are the classes that
 * Visual Studio (/W4) and Xcode report.
 */
export const exceptions = {
  'c++98-compat': 'the language is C++20',
  'c++98-compat-pedantic': 'the language is C++20',
  'c++20-compat': 'it reports words that are new in C++20, which is the language',
  padded: 'the layout of a struct is the compiler\'s, except where a test fixes it',
  'unsafe-buffer-usage': 'the C interface and ONNX Runtime\'s take pointers and sizes; the address sanitizer watches them',
  'double-promotion': 'float to double is exact, and intended where sums need it',
  'float-equal': 'values that were assigned are compared exactly, for example with zero',
  'ctad-maybe-unsupported': 'std::lock_guard and the like are meant to deduce their arguments; GCC\'s library does not mark them',
  'weak-vtables': 'interfaces without a source of their own cost a few bytes in each user',
  'exit-time-destructors': 'tables that live as long as the library end with it',
  'global-constructors': 'constant tables of strings are made when the library is loaded',
};

/** Clang 16 with the library of Android and Apple, and the newest Clang that set-up installs. */
const compilers = [
  { command: 'clang++-16', args: ['-stdlib=libc++'] },
  { command: 'clang++-22', args: [] },
];

/** Those that are installed. */
export const installedCompilers = () => compilers.filter(({ command }) => succeeds(command, ['--version']));

const warningFlags = ['-fsyntax-only', '-ferror-limit=0', '-Weverything', ...Object.keys(exceptions).map((name) => `-Wno-${name}`)];

/** The words of a compile command that another compiler needs, too: language, macros and include folders. */
export function sharedWords(command) {
  const words = command.split(' ').map((word) => word.replaceAll('\\"', '"'));
  return words.flatMap((word, index) => {
    if (word === '-isystem') return [word, words[index + 1]];
    return /^-([ID]|std=)/.test(word) ? [word] : [];
  });
}

/** Complaints in a compiler's output about files of this repository, each once. */
export const warningsIn = (output) =>
  [...new Set(output.split('\n').filter((line) => /: (warning|error|fatal error): /.test(line) && line.startsWith(`${repositoryRoot}${path.sep}`)))];

/** The warnings of one compiler about a source, without the exceptions. */
export async function warningsOf({ command, args }, words, file) {
  const { exitCode, output } = await run(command, [...args, ...warningFlags, ...words, file], { quiet: true });
  const found = warningsIn(output);
  return exitCode !== 0 && found.length === 0 ? [`${file}: ${command} ended with ${exitCode}: ${output.trim().split('\n')[0]}`] : found;
}

/** The shipped sources compile without warnings under -Weverything, less the exceptions. */
export async function checkWarnings() {
  const commands = JSON.parse(readFileSync(inRepository(presetFolder('lint'), 'compile_commands.json'), 'utf8'));
  const shipped = commands.filter(({ file }) => file.startsWith(inRepository('NativePlugin', 'src')) && existsSync(file));
  const queue = installedCompilers().flatMap((compiler) => shipped.map(({ file, command }) => ({ compiler, file, words: sharedWords(command) })));
  const checked = queue.length;
  const complaints = [];
  const worker = async () => {
    for (let next = queue.shift(); next !== undefined; next = queue.shift()) complaints.push(...(await warningsOf(next.compiler, next.words, next.file)));
  };
  await Promise.all(os.cpus().map(worker));
  return { checked, complaints: [...new Set(complaints)] };
}
