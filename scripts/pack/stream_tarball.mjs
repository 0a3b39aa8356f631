import { createReadStream, createWriteStream, lstatSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { Readable } from 'node:stream';
import { pipeline } from 'node:stream/promises';
import { createGzip } from 'node:zlib';
import { CommandError } from '../lib/process.mjs';

const blockBytes = 512;
// The time that npm writes: the same package gives the same tarball on every machine.
const timeSeconds = Date.UTC(1985, 9, 26, 8, 15) / 1000;

/** The files below a folder, with slashes, in order. */
function filesBelow(folder, place = '') {
  return readdirSync(path.join(folder, place), { withFileTypes: true })
    .sort((one, other) => (one.name < other.name ? -1 : 1))
    .flatMap((entry) => {
      const name = place === '' ? entry.name : `${place}/${entry.name}`;
      if (entry.isDirectory()) return filesBelow(folder, name);
      if (!entry.isFile()) throw new CommandError(`${path.join(folder, name)}: is no plain file; a package holds only those`);
      return [name];
    });
}

/** A name in the two fields of a ustar header: at most 155 bytes, a slash, at most 100 bytes. */
function splitName(name) {
  if (Buffer.byteLength(name) <= 100) return { prefix: '', rest: name };
  for (let slash = name.indexOf('/'); slash >= 0; slash = name.indexOf('/', slash + 1)) {
    const [prefix, rest] = [name.slice(0, slash), name.slice(slash + 1)];
    if (Buffer.byteLength(prefix) <= 155 && Buffer.byteLength(rest) <= 100) return { prefix, rest };
  }
  throw new CommandError(`${name}: is too long for a tarball's header`);
}

/** A file's header (POSIX ustar). */
function headerOf(name, bytes) {
  const { prefix, rest } = splitName(name);
  const header = Buffer.alloc(blockBytes);
  const octal = (value, place, length) => header.write(`${value.toString(8).padStart(length - 1, '0')}\0`, place, 'latin1');
  header.write(rest, 0, 'utf8');
  octal(0o644, 100, 8);
  octal(0, 108, 8);
  octal(0, 116, 8);
  octal(bytes, 124, 12);
  octal(timeSeconds, 136, 12);
  header.write('        0', 148, 'latin1');
  header.write('ustar\x0000', 257, 'latin1');
  header.write(prefix, 345, 'utf8');
  const sum = header.reduce((total, byte) => total + byte, 0);
  header.write(`${sum.toString(8).padStart(6, '0')}\0 `, 148, 'latin1');
  return header;
}

async function* entries(folder, top) {
  for (const name of filesBelow(folder)) {
    const file = path.join(folder, name);
    const { size } = lstatSync(file);
    yield headerOf(`${top}/${name}`, size);
    yield* createReadStream(file);
    yield Buffer.alloc((blockBytes - (size % blockBytes)) % blockBytes);
  }
  yield Buffer.alloc(2 * blockBytes);
}

/**
 * Packs a folder as npm does, but as a stream: npm keeps the whole tarball in memory.
 * @param {string} top name of the folder that the archive unpacks to
 */
export const streamTarball = (folder, file, top = 'package') => pipeline(Readable.from(entries(folder, top)), createGzip(), createWriteStream(file));
