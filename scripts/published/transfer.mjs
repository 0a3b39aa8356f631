// One file over a connection that may be cut, onto a disk that may be full, beside another run that brings the same file.
import { createHash, randomBytes } from 'node:crypto';
import { createReadStream } from 'node:fs';
import { mkdir, open, readdir, rename, rm, stat } from 'node:fs/promises';
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';
import { NetworkError, backOffSeconds, isCut, reasonOf, tries, waitSeconds } from './requests.mjs';

// A try that brings this much counts as none, so that a large file may be cut often.
const progressBytes = 1 << 20;

/**
 * @typedef {object} Digest what a file's content has to be
 * @property {'sha256' | 'sha256-start' | 'git-blob'} kind sha256-start: its first digits; git-blob: Git's name of the content
 * @property {string} digits lower-case hexadecimal
 * @property {string} source who says so, for people
 */

/**
 * Brings one file to its place. A complete one is only read; a started one goes on where it ended. Parts lie beside the place
 * under names of their own for every run, so that two runs do not write into one file.
 * @param {object} job
 * @param {(from: number) => Promise<Response>} job.ask requests the bytes from an offset to the end: 206, or 200 with all of them
 * @param {string} job.place
 * @param {number | null} job.size bytes, null where nobody says
 * @param {Digest} job.digest
 * @param {(line: string) => void} job.say @param {(bytes: number, size: number | null, isHere?: boolean) => void} [job.advance] hears of the file's
 *   bytes; isHere: of an earlier run; less than 0 where a server begins anew
 * @returns {Promise<{sha256: string, size: number, isNew: boolean}>}
 * @throws CommandError with what to do; what is there of the file stays, unless its content is wrong
 */
export async function bringFile({ ask, place, size, digest, say, advance = () => {}, wait = waitSeconds }) {
  const whole = await checkedFile(place, size, digest);
  if (whole?.isRight) {
    advance(whole.size, whole.size, true);
    return { sha256: whole.sha256, size: whole.size, isNew: false };
  }
  if (whole) {
    say(`${place} is out of date or damaged: ${whole.complaint}; it is downloaded again`);
    await rm(place, { force: true });
  }
  await onDisk(place, size, () => mkdir(path.dirname(place), { recursive: true }));
  const part = await claimPart(place, digest);
  try {
    await fill({ ask, place, part, size, say, advance, wait });
  } catch (error) {
    await rename(part, freePart(place, digest)).catch(() => {});
    throw error;
  }
  const brought = await checkedFile(part, size, digest);
  if (!brought.isRight) {
    await rm(part, { force: true });
    throw new CommandError(`${path.basename(place)}: ${brought.complaint}: the file was damaged on its way and is deleted; run again`);
  }
  await rename(part, place);
  return { sha256: brought.sha256, size: brought.size, isNew: true };
}

// The digits keep parts of one version of a file from those of another.
const freePart = (place, { digits }) => `${place}.${digits.slice(0, 8)}.part`;

/** Renames what an ended run left to a name of this run; whoever renames first has it. A new name where nothing was left. */
async function claimPart(place, digest) {
  const own = `${place}.${digest.digits.slice(0, 8)}.${process.pid}-${randomBytes(4).toString('hex')}.part`;
  const start = path.basename(`${place}.${digest.digits.slice(0, 8)}.`);
  for (const name of await readdir(path.dirname(place))) {
    if (!name.startsWith(start) || !name.endsWith('.part')) continue;
    const owner = name.slice(start.length).match(/^(\d+)-/);
    if (owner && isRunning(Number(owner[1]))) continue;
    try {
      await rename(path.join(path.dirname(place), name), own);
      return own;
    } catch (error) {
      if (error.code !== 'ENOENT') throw error;
    }
  }
  return own;
}

function isRunning(pid) {
  try {
    process.kill(pid, 0);
    return true;
  } catch (error) {
    return error.code === 'EPERM';
  }
}

/** Appends to the part until it is whole. */
async function fill({ ask, place, part, size, say, advance, wait }) {
  const name = path.basename(place);
  const had = await sizeOf(part);
  if (had > 0) advance(had, size, true);
  let whole = size;
  for (let attempt = 0; ; ) {
    const from = await sizeOf(part);
    if (size !== null && from >= size) return;
    try {
      const response = await ask(from);
      whole = size ?? totalOf(response, from);
      if (response.status === 416) {
        await response.body?.cancel();
        if (whole === from) return;
        await rm(part, { force: true });
        throw new CommandError(`${name}: ${from} bytes were here, and it has ${whole ?? 'fewer'}: the part is deleted; run again`);
      }
      // All of it, though a part was asked for.
      if (response.status === 200 && from > 0) advance(-from, whole);
      await append({ response, part, place, whole, advance });
      if (whole === null || (await sizeOf(part)) >= whole) return;
      throw new TypeError('terminated');
    } catch (error) {
      const here = await sizeOf(part);
      // While a download is on its way, a network that is away may come back.
      if (!isCut(error) && !(error instanceof NetworkError && here > had)) throw error;
      attempt = here - from >= progressBytes ? 1 : attempt + 1;
      const state = `${megabytes(here)}${whole === null ? '' : ` of ${megabytes(whole)}`} MB are here`;
      if (attempt === tries) throw new CommandError(`${name}: the connection was cut ${tries} times in a row (${reasonOf(error)}); ${state} and stay: run again when the network is better`);
      const seconds = backOffSeconds(attempt);
      say(`${name}: the connection was cut; ${state}, going on in ${seconds} s`);
      await wait(seconds);
    }
  }
}

/** The whole file's size as an answer states it. */
function totalOf(response, from) {
  const range = response.headers.get('content-range')?.match(/\/(\d+)$/);
  if (range) return Number(range[1]);
  const length = response.headers.get('content-length');
  // A compressed answer's length is not its content's.
  if (length === null || response.headers.get('content-encoding')) return null;
  return Number(length) + (response.status === 206 ? from : 0);
}

async function append({ response, part, place, whole, advance }) {
  const file = await onDisk(place, whole, () => open(part, response.status === 206 ? 'a' : 'w'));
  try {
    for await (const chunk of response.body) {
      await onDisk(place, whole, () => file.appendFile(chunk), part);
      advance(chunk.length, whole);
    }
  } finally {
    await file.close();
  }
}

/** Runs something that writes; a full disk becomes a sentence. */
async function onDisk(place, size, work, part = null) {
  try {
    return await work();
  } catch (error) {
    const folder = path.dirname(place);
    if (error.code === 'ENOSPC' || error.code === 'EDQUOT') {
      const here = part === null ? 0 : await sizeOf(part);
      const need = size === null ? '' : ` ${megabytes(size - here)} MB more are needed:`;
      throw new CommandError(`${folder}: the disk is full (${error.code}). ${megabytes(here)} MB of ${path.basename(place)} are here and stay;${need} make room, or set XDG_CACHE_HOME to a folder on another disk, then run again`);
    }
    if (['EACCES', 'EEXIST', 'ENOTDIR', 'EPERM', 'EROFS'].includes(error.code)) {
      throw new CommandError(`${folder} cannot be written (${error.code}): set XDG_CACHE_HOME to a folder that can`);
    }
    throw error;
  }
}

const megabytes = (bytes) => (bytes / 1e6).toFixed(1);

async function sizeOf(file) {
  try {
    return (await stat(file)).size;
  } catch (error) {
    if (error.code === 'ENOENT') return 0;
    throw error;
  }
}

/** Reads a file and compares it. Null where it is not there. */
async function checkedFile(file, size, digest) {
  let bytes;
  try {
    bytes = (await stat(file)).size;
  } catch (error) {
    // ENOTDIR: a file has the name of a folder above; making the folder says so.
    if (error.code === 'ENOENT' || error.code === 'ENOTDIR') return null;
    throw error;
  }
  if (size !== null && bytes !== size) return { isRight: false, complaint: `it has ${bytes} bytes, and ${digest.source} says ${size}` };
  const sha256 = createHash('sha256');
  // Git names a content by the SHA-1 of a header and its bytes.
  const blob = createHash('sha1').update(`blob ${bytes}\0`);
  for await (const chunk of createReadStream(file)) {
    sha256.update(chunk);
    if (digest.kind === 'git-blob') blob.update(chunk);
  }
  const sha256Digits = sha256.digest('hex');
  const found = digest.kind === 'git-blob' ? blob.digest('hex') : sha256Digits;
  const isRight = digest.kind === 'sha256-start' ? found.startsWith(digest.digits) : found === digest.digits;
  const name = { sha256: 'SHA-256', 'sha256-start': 'SHA-256', 'git-blob': 'Git name' }[digest.kind];
  return { isRight, sha256: sha256Digits, size: bytes, complaint: `its ${name} is ${found}, and ${digest.source} says ${digest.digits}` };
}
