/** Reads what 64-bit little-endian ELF libraries need in their own bytes, on every system; exports by binutils, on Linux. */
import { spawnSync } from 'node:child_process';

const loadSegment = 1;

/** The largest alignment of the segments that an ELF loads; 0 where there is none. */
export function loadAlignment(elf) {
  if (elf.length < 64) return 0;
  const [offset, size, count] = [Number(elf.readBigUInt64LE(32)), elf.readUInt16LE(54), elf.readUInt16LE(56)];
  const headers = Array.from({ length: count }, (_, index) => offset + index * size).filter((place) => place + 56 <= elf.length);
  return Math.max(0, ...headers.filter((place) => elf.readUInt32LE(place) === loadSegment).map((place) => Number(elf.readBigUInt64LE(place + 48))));
}

/** Whether an ELF names a library that it needs, such as "libc.so.6". */
export const needsLibrary = (elf, name) => elf.includes(`\0${name}\0`, 0, 'latin1');

/** Whether one version is newer than another; a version is [major, minor]. */
export const isNewerThan = ([major, minor], [otherMajor, otherMinor]) => major > otherMajor || (major === otherMajor && minor > otherMinor);

/** The oldest glibc with every function that an ELF wants, such as [2, 30]; null for a library of another C library. */
export function neededGlibc(elf) {
  const versions = [...elf.toString('latin1').matchAll(/\0GLIBC_(\d+)\.(\d+)/g)].map(([, major, minor]) => [Number(major), Number(minor)]);
  return versions.sort(([a, b], [c, d]) => a - c || b - d).at(-1) ?? null;
}

/** The names that a library exports, an ELF for any processor or a DLL for x64, in order. */
export function exportedNames(file) {
  const [command, words, pattern] = file.endsWith('.dll')
    ? ['objdump', ['--private-headers'], /^\t\[ *\d+\] ([A-Za-z_]\w*)$/gm]
    : ['nm', ['--dynamic', '--defined-only', '--format=posix'], /^(\w+)/gm];
  const { stdout } = spawnSync(command, [...words, file], { encoding: 'utf8', maxBuffer: 2 ** 28 });
  return [...(stdout ?? '').matchAll(pattern)].map(([, name]) => name).sort();
}
