import { readdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { inRepository } from '../../../scripts/lib/process.mjs';

/** The full names of GoogleTest's tests in a source; of a parametrised one with each prefix and any parameter. */
export function testsIn(source) {
  const prefixes = [...source.matchAll(/INSTANTIATE_TEST_SUITE_P\(\s*(\w+),\s*(\w+)/g)];
  return [...source.matchAll(/\bTEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\)/g)].flatMap(([, suite, name]) => {
    const instances = prefixes.filter(([, , of]) => of === suite).map(([, prefix]) => `${prefix}/${suite}.${name}/0`);
    return [`${suite}.${name}`, ...instances];
  });
}

/** A GoogleTest filter's pattern as a regular expression. */
export const patternOf = (filter) => new RegExp(`^${filter.replace(/[.+^${}()|[\]\\]/g, '\\$&').replaceAll('*', '.*').replaceAll('?', '.')}$`);

/** The names of all native tests. */
export function nativeTests() {
  const sources = readdirSync(inRepository('Tests', 'Native'), { recursive: true }).filter((name) => name.endsWith('.cpp'));
  return sources.flatMap((name) => testsIn(readFileSync(path.join(inRepository('Tests', 'Native'), name), 'utf8')));
}
