/** Reads what a 64-bit little-endian ELF library needs, in its own bytes: no binutils, on every system. */

const segmentTypes = { load: 1, dynamic: 2 };
const tags = { needed: 1n, strings: 5n, versions: 0x6ffffffen, versionCount: 0x6fffffffn };

/** The program headers of an ELF. */
function segmentsOf(elf) {
  if (elf.length < 64) return [];
  const [offset, size, count] = [Number(elf.readBigUInt64LE(32)), elf.readUInt16LE(54), elf.readUInt16LE(56)];
  return Array.from({ length: count }, (_, index) => offset + index * size)
    .filter((place) => place + 56 <= elf.length)
    .map((place) => ({
      type: elf.readUInt32LE(place),
      offset: Number(elf.readBigUInt64LE(place + 8)),
      address: Number(elf.readBigUInt64LE(place + 16)),
      bytes: Number(elf.readBigUInt64LE(place + 32)),
      alignment: Number(elf.readBigUInt64LE(place + 48)),
    }));
}

/** The largest alignment of the segments that an ELF loads; 0 where there is none. */
export const loadAlignment = (elf) => Math.max(0, ...segmentsOf(elf).filter(({ type }) => type === segmentTypes.load).map(({ alignment }) => alignment));

/**
 * The libraries that an ELF names, and the versions of their functions that it wants.
 * @param {Buffer} elf @returns {{libraries: string[], versions: string[]}} versions: such as "GLIBC_2.17"
 */
export function needsOf(elf) {
  const segments = segmentsOf(elf);
  const dynamic = segments.find(({ type }) => type === segmentTypes.dynamic);
  if (!dynamic) return { libraries: [], versions: [] };
  const entries = [];
  for (let place = dynamic.offset; place + 16 <= Math.min(dynamic.offset + dynamic.bytes, elf.length); place += 16) {
    entries.push([elf.readBigUInt64LE(place), Number(elf.readBigUInt64LE(place + 8))]);
  }
  const valueOf = (wanted) => entries.find(([tag]) => tag === wanted)?.[1];
  const placeOf = (address) => {
    const segment = segments.find(({ type, address: begin, bytes }) => type === segmentTypes.load && begin <= address && address < begin + bytes);
    return segment ? segment.offset + address - segment.address : elf.length;
  };
  const strings = placeOf(valueOf(tags.strings) ?? -1);
  const stringAt = (offset) => elf.toString('latin1', strings + offset, elf.indexOf(0, strings + offset));
  const versions = [];
  let file = placeOf(valueOf(tags.versions) ?? -1);
  for (let left = valueOf(tags.versionCount) ?? 0; left > 0 && file + 16 <= elf.length; left -= 1) {
    let place = file + elf.readUInt32LE(file + 8);
    for (let count = elf.readUInt16LE(file + 2); count > 0 && place + 16 <= elf.length; count -= 1) {
      versions.push(stringAt(elf.readUInt32LE(place + 8)));
      place += elf.readUInt32LE(place + 12);
    }
    file += elf.readUInt32LE(file + 12);
  }
  return { libraries: entries.filter(([tag]) => tag === tags.needed).map(([, offset]) => stringAt(offset)), versions };
}

/** The oldest glibc with every function that an ELF wants, such as [2, 30]; null for a library of another C library. */
export function neededGlibc(elf) {
  const versions = needsOf(elf).versions.flatMap((name) => {
    const [, major, minor] = name.match(/^GLIBC_(\d+)\.(\d+)/) ?? [];
    return major === undefined ? [] : [[Number(major), Number(minor)]];
  });
  return versions.sort(([a, b], [c, d]) => a - c || b - d).at(-1) ?? null;
}

/** Whether a version such as [2, 34] is newer than another. */
export const isNewerThan = ([major, minor], [otherMajor, otherMinor]) => major > otherMajor || (major === otherMajor && minor > otherMinor);

const sectionTypes = { symbols: 11 };

/** The names that an ELF exports: its dynamic symbols that have a place and are not local; none for a file without section headers. */
export function namesExportedByElf(elf) {
  if (elf.length < 64) return [];
  const [table, size, count] = [Number(elf.readBigUInt64LE(40)), elf.readUInt16LE(58), elf.readUInt16LE(60)];
  const sections = Array.from({ length: table === 0 ? 0 : count }, (_, index) => table + index * size)
    .filter((place) => place + 64 <= elf.length)
    .map((place) => ({ type: elf.readUInt32LE(place + 4), offset: Number(elf.readBigUInt64LE(place + 24)), bytes: Number(elf.readBigUInt64LE(place + 32)), link: elf.readUInt32LE(place + 40) }));
  const symbols = sections.find(({ type }) => type === sectionTypes.symbols);
  const strings = symbols && sections[symbols.link];
  if (!strings) return [];
  const names = [];
  for (let place = symbols.offset; place + 24 <= Math.min(symbols.offset + symbols.bytes, elf.length); place += 24) {
    const name = strings.offset + elf.readUInt32LE(place);
    const [isLocal, isElsewhere] = [elf[place + 4] >> 4 === 0, elf.readUInt16LE(place + 6) === 0];
    if (!isLocal && !isElsewhere) names.push(elf.toString('latin1', name, elf.indexOf(0, name)));
  }
  return names;
}

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
