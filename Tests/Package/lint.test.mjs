// Rules of the linter, and what the workflows run.
import assert from 'node:assert/strict';
import test from 'node:test';
import { findingsOfTidy, machineTraces } from '../../scripts/lib/lint_checks.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';

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
