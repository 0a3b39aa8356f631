/**
 * The beginning of a 64-bit ELF: for tests that read what a library needs.
 * @param {{machine: number, libraries?: string[], versions?: string[], alignment?: number}} library machine: 62 is x86-64,
 *   183 arm64; versions: of the functions that it wants; alignment: of its one segment
 */
export function elfOf({ machine, libraries = ['libc.so.6'], versions = [], alignment = 4096 }) {
  const bytes = Buffer.alloc(64 + 56);
  bytes.writeUInt32BE(0x7f454c46, 0);
  bytes.writeUInt16LE(machine, 18);
  bytes.writeBigUInt64LE(64n, 32);
  bytes.writeUInt16LE(56, 54);
  bytes.writeUInt16LE(1, 56);
  bytes.writeUInt32LE(1, 64);
  bytes.writeBigUInt64LE(BigInt(alignment), 64 + 48);
  return Buffer.concat([bytes, Buffer.from(`\0${[...libraries, ...versions].map((name) => `${name}\0`).join('')}`, 'latin1')]);
}
