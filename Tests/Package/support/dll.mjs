/** A DLL for x64 with one section, in which a table exports names. */
export function dllOf(names) {
  const [header, optionalBytes, address, offset] = [128, 240, 0x1000, 512];
  const strings = Buffer.from(names.map((name) => `${name}\0`).join(''), 'latin1');
  const stringsPlace = 40 + 4 * names.length;
  const bytes = Buffer.alloc(offset + stringsPlace + strings.length);
  bytes.write('MZ', 0, 'latin1');
  bytes.writeUInt32LE(header, 60);
  bytes.write('PE\0\0', header, 'latin1');
  bytes.writeUInt16LE(0x8664, header + 4);
  bytes.writeUInt16LE(1, header + 6);
  bytes.writeUInt16LE(optionalBytes, header + 20);
  bytes.writeUInt32LE(address, header + 24 + 112);
  const section = header + 24 + optionalBytes;
  bytes.writeUInt32LE(address, section + 12);
  bytes.writeUInt32LE(bytes.length - offset, section + 16);
  bytes.writeUInt32LE(offset, section + 20);
  bytes.writeUInt32LE(names.length, offset + 24);
  bytes.writeUInt32LE(address + 40, offset + 32);
  names.forEach((name, index) => bytes.writeUInt32LE(address + stringsPlace + strings.indexOf(`${name}\0`), offset + 40 + 4 * index));
  strings.copy(bytes, offset + stringsPlace);
  return bytes;
}
