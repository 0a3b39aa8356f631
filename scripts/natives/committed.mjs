import { existsSync, readFileSync, writeFileSync } from 'node:fs';
import { differencesOfExports } from '../lib/exported_names.mjs';
import { sha256OfBytes } from '../lib/model_stamp.mjs';
import { inRepository } from '../lib/repository.mjs';
import { packageName } from '../pack/layout.mjs';
import { complaintOfGlibc, kindOfLibrary, platforms, pluginsFolder } from '../pack/natives.mjs';
import { hashOfInterface, hashOfSources } from './fingerprints.mjs';

/** The command that builds the libraries in git anew. */
export const renewal = '`npm run natives`';

/** The platforms whose library is in git: those of editors, and Linux arm64. */
export const committedPlatforms = platforms.filter(({ isInGit }) => isInGit);

/** The most bytes that a library in git may have: every clone carries each version of it. */
export const largestBytes = 3.5e6;

/** Where a platform's library lies in the package. */
export const fileInPackage = ({ place }) => inRepository('Packages', packageName, pluginsFolder, place);

const recordFile = inRepository('NativePlugin', 'natives.json');

/**
 * What the libraries in git were built from, and what they are.
 * @returns {{interface: string, sources: string, files: Record<string, {bytes: number, sha256: string}>}} files: by the
 *   platforms' ids
 */
export const readRecord = (file = recordFile) => JSON.parse(readFileSync(file, 'utf8'));

/** Records the libraries that lie in the package as built from the sources of now. */
export function writeRecord() {
  const files = Object.fromEntries(committedPlatforms.map((platform) => {
    const bytes = readFileSync(fileInPackage(platform));
    return [platform.id, { bytes: bytes.length, sha256: sha256OfBytes(bytes) }];
  }));
  writeFileSync(recordFile, `${JSON.stringify({ interface: hashOfInterface(), sources: hashOfSources(), files }, null, 2)}\n`);
}

/** Whether the libraries in git were built from the sources of now. */
export const areOfTheseSources = (record = readRecord()) => record.sources === hashOfSources();

/** What is wrong with the bytes of a platform's library: a line for each complaint. */
export function complaintsOf(platform, bytes) {
  const kind = kindOfLibrary(bytes);
  if (kind !== platform.kind) return [`${platform.id}: is ${kind ?? 'no library'}; expected ${platform.kind}`];
  const glibc = complaintOfGlibc(platform, bytes);
  const { missing, unwanted } = differencesOfExports(bytes);
  return [
    ...(bytes.length > largestBytes ? [`has ${bytes.length} bytes; expected ${largestBytes} at most`] : []),
    ...(glibc === null ? [] : [glibc]),
    ...(missing.length > 0 ? [`does not export ${missing.join(', ')} of haptoflow.h`] : []),
    ...(unwanted.length > 0 ? [`exports ${unwanted.join(', ')}, which haptoflow.h does not declare`] : []),
  ].map((complaint) => `${platform.id}: ${complaint}`);
}

/** What is wrong with the libraries in git beside their record: a line for each complaint. */
export function complaintsOfRecord(record = readRecord()) {
  return committedPlatforms.flatMap((platform) => {
    const bytes = existsSync(fileInPackage(platform)) ? readFileSync(fileInPackage(platform)) : Buffer.alloc(0);
    const isRecorded = record.files[platform.id]?.bytes === bytes.length && record.files[platform.id]?.sha256 === sha256OfBytes(bytes);
    return [...complaintsOf(platform, bytes), ...(isRecorded ? [] : [`${platform.id}: is not the file that NativePlugin/natives.json records: ${renewal} builds it anew`])];
  });
}

/** The platforms' libraries in git, for `findNatives`: null for a platform without one, and where the sources are newer. */
export function committedNatives() {
  const isCurrent = existsSync(recordFile) && areOfTheseSources();
  return (platform) => (isCurrent && platform.isInGit && existsSync(fileInPackage(platform)) ? fileInPackage(platform) : null);
}
