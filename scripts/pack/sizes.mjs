import { existsSync, readFileSync, readdirSync, statSync } from 'node:fs';
import path from 'node:path';
import { inRepository } from '../lib/process.mjs';
import { shippedModel } from '../lib/measured_part.mjs';
import { dependencyName, runtimePlaces } from './dependency.mjs';
import { isNewerThan, neededGlibc } from './elf.mjs';
import { oldestGlibc } from './natives.mjs';

/** The files of a ZIP archive with their sizes when unpacked, from its central directory. */
export function filesOfZip(bytes) {
  const end = bytes.lastIndexOf(Buffer.from('PK\x05\x06', 'latin1'));
  if (end < 0 || end + 22 > bytes.length) throw new RangeError('no ZIP archive');
  const files = [];
  let place = bytes.readUInt32LE(end + 16);
  for (let left = bytes.readUInt16LE(end + 10); left > 0; left -= 1) {
    const [nameBytes, extraBytes, commentBytes] = [28, 30, 32].map((offset) => bytes.readUInt16LE(place + offset));
    files.push({ name: bytes.toString('utf8', place + 46, place + 46 + nameBytes), bytes: bytes.readUInt32LE(place + 24) });
    place += 46 + nameBytes + extraBytes + commentBytes;
  }
  return files;
}

/** Bytes of ONNX Runtime's libraries on a platform's device; 0 where its package has none. */
export function runtimeBytes(id, root = inRepository('node_modules', dependencyName)) {
  const { archive, folder } = runtimePlaces[id] ?? {};
  if (folder === undefined) return 0;
  const files = archive
    ? filesOfZip(readFileSync(path.join(root, archive))).filter(({ name }) => name.startsWith(`${folder}/`))
    : (existsSync(path.join(root, folder)) ? readdirSync(path.join(root, folder)) : []).map((name) => ({ name, bytes: statSync(path.join(root, folder, name)).size }));
  return files.filter(({ name }) => /\.(so|dll|dylib)$/.test(name)).reduce((sum, { bytes }) => sum + bytes, 0);
}

const mebibytes = (bytes) => (bytes / 2 ** 20).toFixed(1);

/** What a person has to know of a platform's library beyond its size. */
function noteOf(platform, glibc, isFromGit) {
  const notes = isFromGit ? ['as in git'] : [];
  if (glibc !== null) {
    const remedy = isNewerThan(glibc, oldestGlibc) ? `: built on Debian 12 it would need ${oldestGlibc.join('.')} at most` : '';
    notes.push(`needs glibc ${glibc.join('.')}${remedy}`);
  }
  if (runtimeBytes(platform.id) === 0) notes.push('bring ONNX Runtime for it yourself: its package has none');
  return notes.join('; ');
}

/**
 * The table of what a tarball holds: a line for each platform with the sizes in MiB that it takes on a device, then the
 * missing platforms with the command that adds each.
 * @param {{found: {platform: object, file: string, isFromGit?: boolean}[], absent: {platform: object, why: string}[]}} natives
 */
export function tableOfContents({ found, absent }) {
  const model = statSync(shippedModel).size;
  const rows = found.map((entry) => {
    const [own, runtime] = [statSync(entry.file).size, runtimeBytes(entry.platform.id)];
    const cells = [own, model, runtime, own + model + runtime].map(mebibytes);
    if (runtime === 0) cells[2] = '-';
    return [entry.platform.name, ...cells, noteOf(entry.platform, neededGlibc(readFileSync(entry.file)), entry.isFromGit)];
  });
  const head = ['on the device, MiB', 'library', 'model', 'ONNX Runtime', 'together', ''];
  const lines = [head, ...rows].map(([name, own, of, runtime, sum, note]) =>
    `  ${name.padEnd(20)}${own.padStart(8)}${of.padStart(8)}${runtime.padStart(14)}${sum.padStart(10)}  ${note}`.trimEnd());
  return [...lines, ...absent.map(({ platform, why }) => `  ${platform.name.padEnd(20)}missing: ${why}`)];
}
