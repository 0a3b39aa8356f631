import { run, succeeds } from '../lib/process.mjs';
import { endingIn } from './files.mjs';

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
