import assert from 'node:assert/strict';
import test from 'node:test';
import { pageOptions } from '../../scripts/lib/platform_tests.mjs';
import { loadAlignment } from '../../scripts/pack/binaries.mjs';

/** A 64-bit ELF with nothing but program headers: [type, alignment] each. */
function elf(...segments) {
  const bytes = Buffer.alloc(64 + 56 * segments.length);
  bytes.writeBigUInt64LE(64n, 32);
  bytes.writeUInt16LE(56, 54);
  bytes.writeUInt16LE(segments.length, 56);
  segments.forEach(([type, alignment], index) => {
    bytes.writeUInt32LE(type, 64 + 56 * index);
    bytes.writeBigUInt64LE(BigInt(alignment), 64 + 56 * index + 48);
  });
  return bytes;
}

test('the alignment of a library is that of the segments it loads', () => {
  assert.equal(loadAlignment(elf([1, 16384], [2, 8], [1, 4096], [0x6474e551, 65536])), 16384);
  assert.equal(loadAlignment(elf([2, 8])), 0);
});

test('page options are read out of a link command', () => {
  assert.deepEqual(pageOptions('g++ -shared -Wl,--version-script=x -Wl,-z,max-page-size=16384 -o lib.so'), ['-Wl,-z,max-page-size=16384']);
  assert.deepEqual(pageOptions('g++ -shared -o lib.so'), []);
});
