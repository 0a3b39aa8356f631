import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/repository.mjs';
import { commentBlocks, draw } from '../../scripts/lint/comment_blocks.mjs';

const found = (name, lines) => commentBlocks(name, lines.join('\n')).map(({ line, text }) => `${line}: ${text}`);

test('line comments on consecutive lines are one block, and one after code is a block of its own', () => {
  const lines = ['// One', '// block.', 'int a;  // Metres.', '  // Another', '  // block.'];
  assert.deepEqual(found('a.cpp', lines), ['1: // One\n// block.', '3: // Metres.', '4: // Another\n// block.']);
});

test('a block comment is one block without its indentation', () => {
  assert.deepEqual(found('a.hpp', ['', '  /* First', '   * second. */', '  int a;']), ['2: /* First\n * second. */']);
});

test('strings that look like comments are not found', () => {
  assert.deepEqual(found('a.cpp', ['auto a = "// no"; auto b = R"x(// no " /* )x"; auto c = \'"\'; auto d = 1\'000; // Yes.']), ['1: // Yes.']);
  assert.deepEqual(found('a.cs', ['var a = @"c:\\"; var b = $"// no {c}"; /// <summary>Yes.</summary>']), ['1: /// <summary>Yes.</summary>']);
  assert.deepEqual(found('a.mjs', ['const a = `// no ${b(`/* no */`)}`.replace(/[/]\\/*"/, c / 2); // Yes.']), ['1: // Yes.']);
});

test('the comment that closes a namespace is not drawn', () => {
  assert.deepEqual(found('a.cpp', ['// Why.', 'int a;', '}  // namespace', '}  // namespace haptoflow::cli']), ['1: // Why.']);
});

test('docstrings of Python are found, and other strings are not', () => {
  const lines = ['"""Module.', 'Second line."""', 'a = """# no"""  # Yes.', 'call(', '    "no",', ')', 'def f():', "    '''Function.'''"];
  assert.deepEqual(found('a.py', lines), ['1: """Module.\nSecond line."""', '3: # Yes.', "8: '''Function.'''"]);
});

test('the same seed draws the same blocks, another seed draws others, and none is drawn twice', () => {
  const items = Array.from({ length: 1000 }, (_, index) => index);
  assert.deepEqual(draw(items, 20, 7), draw(items, 20, 7));
  assert.notDeepEqual(draw(items, 20, 7), draw(items, 20, 8));
  assert.equal(new Set(draw(items, 1000, 7)).size, 1000);
  assert.equal(draw([1, 2], 5, 7).length, 2);
});

const sample = (...words) => spawnSync(process.execPath, [inRepository('scripts', 'lint', 'sample_comments.mjs'), ...words], { encoding: 'utf8', cwd: inRepository() });

test('the command prints as many comments as requested, from the named folder, with file and line', () => {
  const { status, stdout } = sample('--count', '7', '--seed', '3', 'scripts/lint');
  assert.equal(status, 0);
  assert.equal(stdout.match(/^scripts\/lint\/\w+\.mjs:\d+$/gm).length, 7);
  assert.match(stdout, /^7 of \d+ comments in \d+ files, --seed 3$/m);
  assert.equal(sample('--count', '7', '--seed', '3', 'scripts/lint').stdout, stdout);
});

test('a wrong option or path ends with 2 and names it', () => {
  assert.match(sample('--count', 'many').stderr, /--count many: expected a whole number from 1/);
  assert.match(sample('--seed', '-1').stderr, /--seed/);
  const { status, stderr } = sample('no/such/folder');
  assert.equal(status, 2);
  assert.match(stderr, /no\/such\/folder: no C\+\+, C#, Python or JavaScript file/);
});

test('the help names both options and changes nothing', () => {
  const { status, stdout } = sample('--help');
  assert.equal(status, 0);
  assert.match(stdout, /--count COUNT[^]*--seed N/);
});
