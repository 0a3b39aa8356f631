import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository, repositoryRoot } from '../../scripts/lib/process.mjs';
import { findingsOfTidy } from '../../scripts/lint/cpp_checks.mjs';
import { exceptions, installedCompilers, sharedWords, warningsIn, warningsOf } from '../../scripts/lint/warning_checks.mjs';
import { functionsWithoutThreadTag, machineTraces } from '../../scripts/lint/house_checks.mjs';

const [clang] = installedCompilers();

test('a function without a thread tag in its own comment is found', () => {
  const header = [
    '/* Opens.\n * [loader-thread] Blocks. */',
    'HAPTOFLOW_API haptoflow_status haptoflow_open(int a,\n                                              int b);',
    '',
    'HAPTOFLOW_API void haptoflow_close(void);',
    '/* Says its name. */\nHAPTOFLOW_API const char* haptoflow_name(void);',
  ].join('\n');
  assert.deepEqual(functionsWithoutThreadTag(header), ['haptoflow_close', 'haptoflow_name']);
});

test('a tag of the previous function does not count for the next', () => {
  const header = '/* [any-thread] */\nHAPTOFLOW_API int haptoflow_a(void);\nHAPTOFLOW_API int haptoflow_b(void);\n';
  assert.deepEqual(functionsWithoutThreadTag(header), ['haptoflow_b']);
});

test('clang-tidy\'s errors and warnings in this repository are findings, and errors in headers of the standard library are not', () => {
  const own = `${inRepository('NativePlugin', 'src', 'a.hpp')}:3:1: error: use auto [modernize-use-auto]`;
  const foreign = '/usr/include/c++/12/bits/iterator_concepts.h:982:13: error: no matching function [clang-diagnostic-error]';
  assert.deepEqual(findingsOfTidy(`${foreign}\n${own}\n    auto a = 1;\n1 error generated.\n`), [own]);
});

test('paths of one machine and package hosts are found with their line', () => {
  const home = ['', 'home', 'someone', 'model'].join('/');
  const host = ['https://registry.npm', 'js.org/x'].join('');
  const traces = machineTraces(`fine\npath = "${home}"\n${host}\n`);
  assert.equal(traces.length, 2);
  assert.match(traces[0], /^2: a path of one machine/);
  assert.match(traces[1], /^3: a package host/);
});

test('system paths, relative paths and web addresses are fine', () => {
  assert.deepEqual(machineTraces('/usr/bin/python3 src/work/x.cpp https://example.com/home/x "/etc/os-release"'), []);
});

test('language, macros and include folders of a compile command are kept, and options of one compiler are not', () => {
  const command = '/usr/bin/c++ -DVERSION=\\"1.0\\" -Iinclude -isystem /usr/include/x -O3 -Wall -fPIC -std=c++20 -o a.o -c a.cpp';
  assert.deepEqual(sharedWords(command), ['-DVERSION="1.0"', '-Iinclude', '-isystem', '/usr/include/x', '-std=c++20']);
});

test('warnings in files of this repository are complaints, each once, and those in other headers are not', () => {
  const own = `${repositoryRoot}/NativePlugin/src/a.cpp:1:2: warning: unused macro [-Wunused-macros]`;
  assert.deepEqual(warningsIn(`${own}\n/usr/include/b.h:1:1: warning: c [-Wd]\n${own}\n1 warning generated.`), [own]);
});

test('a planted warning is found, and every exception states a reason', { skip: clang === undefined ? 'Clang is not installed' : false }, async () => {
  mkdirSync(inRepository('build'), { recursive: true });
  const folder = mkdtempSync(inRepository('build', 'planted-'));
  try {
    const file = path.join(folder, 'planted.cpp');
    writeFileSync(file, 'int planted(long value);\nint planted(long value) { return static_cast<int>(value) + (value > 0 ? 1u : 0u); }\n');
    assert.match((await warningsOf({ ...clang, args: [] }, ['-std=c++20'], file)).join('\n'), /planted\.cpp:2:.*-Wsign-(conversion|compare)/);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
  for (const [name, reason] of Object.entries(exceptions)) assert.ok(reason.length > 15, name);
});
