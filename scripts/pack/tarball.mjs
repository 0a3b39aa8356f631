import { mkdirSync } from 'node:fs';
import { gunzipSync } from 'node:zlib';
import path from 'node:path';
import { runNpmOrFail } from '../lib/process.mjs';

/**
 * Makes the tarball of a staged package with npm, whose layout Unity's package manager reads.
 * @param {string} folder the staged package @param {string} destination folder for the tarball
 * @returns {Promise<{file: string, bytes: number, unpackedBytes: number}>}
 */
export async function makeTarball(folder, destination) {
  mkdirSync(destination, { recursive: true });
  const words = ['pack', folder, '--pack-destination', destination, '--json', '--ignore-scripts', '--loglevel=error'];
  const output = await runNpmOrFail(words);
  const [{ filename, size, unpackedSize }] = JSON.parse(output.slice(output.indexOf('[')));
  return { file: path.join(destination, filename), bytes: size, unpackedBytes: unpackedSize };
}

const blockBytes = 512;
const types = { file: '0', oldFile: '\0', folder: '5', longNames: 'x' };

/**
 * The files of a gzipped tar archive by name.
 * @param {Buffer} bytes @returns {Map<string, Buffer>}
 */
export function readTarball(bytes) {
  const archive = gunzipSync(bytes);
  const files = new Map();
  let longName = null;
  for (let offset = 0; offset + blockBytes <= archive.length && archive[offset] !== 0; ) {
    const header = archive.subarray(offset, offset + blockBytes);
    const size = Number.parseInt(textAt(header, 124, 12), 8);
    const content = archive.subarray(offset + blockBytes, offset + blockBytes + size);
    const type = String.fromCharCode(header[156]);
    if (type === types.longNames) {
      longName = content.toString('utf8').match(/^\d+ path=(.*)$/m)?.[1] ?? null;
    } else {
      const prefix = textAt(header, 345, 155);
      const name = longName ?? (prefix ? `${prefix}/` : '') + textAt(header, 0, 100);
      longName = null;
      if (type === types.file || type === types.oldFile) files.set(name, content);
      else if (type !== types.folder) throw new RangeError(`${name}: an archive entry of type "${type}"; expected files and folders`);
    }
    offset += blockBytes * (1 + Math.ceil(size / blockBytes));
  }
  return files;
}

function textAt(header, begin, length) {
  const field = header.subarray(begin, begin + length);
  const end = field.indexOf(0);
  return field.toString('utf8', 0, end < 0 ? length : end).trim();
}
