/**
 * A 64-bit ELF with a dynamic section: for tests that read what a library needs.
 * @param {{machine: number, libraries?: string[], versions?: string[], alignment?: number}} library machine: 62 is x86-64,
 *   183 arm64; versions: of the functions that it wants from its first library
 */
export function elfOf({ machine, libraries = ['libc.so.6'], versions = [], alignment = 4096 }) {
  const names = [...libraries, ...versions];
  const strings = Buffer.from(`\0${names.map((name) => `${name}\0`).join('')}`, 'latin1');
  const offsetOf = (name) => strings.indexOf(`\0${name}\0`) + 1;
  const base = 0x10000;
  const [dynamicPlace, dynamicBytes] = [64 + 2 * 56, 16 * (libraries.length + 4)];
  const versionsPlace = dynamicPlace + dynamicBytes;
  const stringsPlace = versionsPlace + 16 * (1 + versions.length);
  const bytes = Buffer.alloc(stringsPlace + strings.length);
  bytes.writeUInt32BE(0x7f454c46, 0);
  bytes.writeUInt16LE(machine, 18);
  bytes.writeBigUInt64LE(64n, 32);
  bytes.writeUInt16LE(56, 54);
  bytes.writeUInt16LE(2, 56);
  const segment = (index, type, place, size, align) => {
    const header = 64 + 56 * index;
    bytes.writeUInt32LE(type, header);
    bytes.writeBigUInt64LE(BigInt(place), header + 8);
    bytes.writeBigUInt64LE(BigInt(base + place), header + 16);
    bytes.writeBigUInt64LE(BigInt(size), header + 32);
    bytes.writeBigUInt64LE(BigInt(align), header + 48);
  };
  segment(0, 1, 0, bytes.length, alignment);
  segment(1, 2, dynamicPlace, dynamicBytes, 8);
  const entries = [...libraries.map((name) => [1, offsetOf(name)]), [5, base + stringsPlace], [0x6ffffffe, base + versionsPlace], [0x6fffffff, versions.length > 0 ? 1 : 0]];
  entries.forEach(([tag, value], index) => {
    bytes.writeBigUInt64LE(BigInt(tag), dynamicPlace + 16 * index);
    bytes.writeBigUInt64LE(BigInt(value), dynamicPlace + 16 * index + 8);
  });
  bytes.writeUInt16LE(versions.length, versionsPlace + 2);
  bytes.writeUInt32LE(offsetOf(libraries[0]), versionsPlace + 4);
  bytes.writeUInt32LE(16, versionsPlace + 8);
  versions.forEach((name, index) => {
    bytes.writeUInt32LE(offsetOf(name), versionsPlace + 16 * (index + 1) + 8);
    bytes.writeUInt32LE(index + 1 < versions.length ? 16 : 0, versionsPlace + 16 * (index + 1) + 12);
  });
  strings.copy(bytes, stringsPlace);
  return bytes;
}

/** A 64-bit ELF with a table of dynamic symbols. @param {{name: string, section: number, isLocal?: boolean}[]} symbols section: 0 for one of another library */
export function elfWithSymbols(symbols) {
  const strings = Buffer.from(`\0${symbols.map(({ name }) => `${name}\0`).join('')}`, 'latin1');
  const [symbolsPlace, symbolsBytes, headersBytes] = [64, 24 * symbols.length, 3 * 64];
  const stringsPlace = symbolsPlace + symbolsBytes;
  const headers = stringsPlace + strings.length;
  const bytes = Buffer.alloc(headers + headersBytes);
  bytes.writeUInt32BE(0x7f454c46, 0);
  bytes.writeUInt16LE(62, 18);
  bytes.writeBigUInt64LE(BigInt(headers), 40);
  bytes.writeUInt16LE(64, 58);
  bytes.writeUInt16LE(3, 60);
  symbols.forEach(({ name, section, isLocal = false }, index) => {
    bytes.writeUInt32LE(strings.indexOf(`\0${name}\0`) + 1, symbolsPlace + 24 * index);
    bytes.writeUInt8(isLocal ? 0x03 : 0x12, symbolsPlace + 24 * index + 4);
    bytes.writeUInt16LE(section, symbolsPlace + 24 * index + 6);
  });
  strings.copy(bytes, stringsPlace);
  const sections = [[11, symbolsPlace, symbolsBytes, 2], [3, stringsPlace, strings.length, 0]];
  sections.forEach(([type, offset, size, link], index) => {
    const header = headers + 64 * (index + 1);
    bytes.writeUInt32LE(type, header + 4);
    bytes.writeBigUInt64LE(BigInt(offset), header + 24);
    bytes.writeBigUInt64LE(BigInt(size), header + 32);
    bytes.writeUInt32LE(link, header + 40);
  });
  return bytes;
}
