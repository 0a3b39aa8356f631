import assert from 'node:assert/strict';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/repository.mjs';
import { findingsOfTidy } from '../../scripts/lint/cpp_checks.mjs';
import { functionsWithoutThreadTag, machineTraces } from '../../scripts/lint/house_checks.mjs';

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

test('of clang-tidy\'s lines, errors and warnings in this repository are findings, and what it cannot read of a standard library is not', () => {
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
