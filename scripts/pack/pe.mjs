/** Reads what a 64-bit DLL exports, in its own bytes: no binutils, on every system. */

const stringAt = (bytes, place) => bytes.toString('latin1', place, bytes.indexOf(0, place));

/** The names that a DLL for x64 exports; none for bytes that break off. */
export function namesExportedByPe(bytes) {
  const header = bytes.length >= 64 ? bytes.readUInt32LE(60) : bytes.length;
  if (header + 24 + 112 + 8 > bytes.length) return [];
  const [sectionCount, optionalBytes] = [bytes.readUInt16LE(header + 6), bytes.readUInt16LE(header + 20)];
  const sections = Array.from({ length: sectionCount }, (_, index) => header + 24 + optionalBytes + 40 * index)
    .filter((place) => place + 40 <= bytes.length)
    .map((place) => ({ address: bytes.readUInt32LE(place + 12), bytes: bytes.readUInt32LE(place + 16), offset: bytes.readUInt32LE(place + 20) }));
  const placeOf = (address) => {
    const section = sections.find((each) => each.address <= address && address < each.address + each.bytes);
    return section ? section.offset + address - section.address : bytes.length;
  };
  // The first data directory is that of exports; in it, the number of names and where their addresses lie.
  const directory = placeOf(bytes.readUInt32LE(header + 24 + 112));
  if (directory + 40 > bytes.length) return [];
  const [count, addresses] = [bytes.readUInt32LE(directory + 24), placeOf(bytes.readUInt32LE(directory + 32))];
  return Array.from({ length: count }, (_, index) => addresses + 4 * index)
    .filter((place) => place + 4 <= bytes.length)
    .map((place) => stringAt(bytes, placeOf(bytes.readUInt32LE(place))));
}
