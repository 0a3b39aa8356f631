import { createHash } from 'node:crypto';
import { createReadStream } from 'node:fs';
import { mkdir, open, rename, rm, stat } from 'node:fs/promises';
import path from 'node:path';
import { setTimeout as pause } from 'node:timers/promises';
import { CommandError } from '../lib/process.mjs';
import { repositoryFolder } from './checkpoint.mjs';

// Requests that wait where a server asks to, and errors of a network that say what to do.

/** How often a request is made, or a download goes on, before the user hears of it. */
export const tries = 5;
// The hub counts requests over five minutes: who has to wait longer is blocked for another reason.
const longestWaitSeconds = 300;

/** A server that cannot be reached, or that left in the middle. */
export class NetworkError extends CommandError {
  /** @param {string} message @param {string} [reason] the system's word for it */
  constructor(message, reason) {
    super(message);
    this.reason = reason;
  }
}

/** Waits some seconds. Tests hand in one that only notes them. */
export const waitSeconds = (seconds) => pause(1000 * seconds);

/** Seconds before the try after try number `attempt`. */
export const backOffSeconds = (attempt) => 2 ** (attempt - 1);

/**
 * The seconds that an answer asks to wait: Retry-After (seconds or a date), else the `t` of the hub's RateLimit header.
 * @returns {number | null}
 */
export function askedWaitSeconds(headers, now = Date.now()) {
  const after = headers.get('retry-after');
  if (after !== null) {
    const seconds = /^\s*\d+\s*$/.test(after) ? Number(after) : (Date.parse(after) - now) / 1000;
    if (Number.isFinite(seconds)) return Math.max(0, Math.ceil(seconds));
  }
  const reset = headers.get('ratelimit')?.match(/;\s*t=(\d+)/);
  return reset ? Number(reset[1]) : null;
}

/**
 * A `fetch` that waits and asks again where a server is asked too often (429) or has no time (502, 503, 504).
 * @param {{say: (line: string) => void, wait?: (seconds: number) => Promise<void>}} options
 * @throws NetworkError; CommandError after the last 429. Other answers are returned, whatever their status.
 */
export function patientFetch({ say, wait = waitSeconds }) {
  return async (address, options) => {
    for (let attempt = 1; ; attempt += 1) {
      const response = await fetchOrFail(address, options);
      if (![429, 502, 503, 504].includes(response.status)) return response;
      await response.body?.cancel();
      const seconds = askedWaitSeconds(response.headers) ?? backOffSeconds(attempt);
      const { host } = new URL(address);
      const complaint = response.status === 429 ? `${host} answers fewer requests (429)` : `${host} is not in service (${response.status})`;
      if (attempt === tries || seconds > longestWaitSeconds) {
        throw new CommandError(`${complaint}${attempt === tries ? `, ${tries} times in a row` : ` and asks to wait ${seconds} s`}: run again later; what is downloaded stays`);
      }
      say(`${complaint}: waiting ${seconds} s`);
      await wait(seconds);
    }
  };
}

async function fetchOrFail(address, options) {
  try {
    return await fetch(address, options);
  } catch (error) {
    throw networkError(address, error);
  }
}

/** Whether an error is that of a connection which ended while its answer was read (Node calls it "terminated"), or before. */
export const isCut = (error) => (error instanceof TypeError && error.message === 'terminated') || ['ECONNRESET', 'EPIPE', 'UND_ERR_SOCKET'].includes(error.reason);

/** What a connection's error says below the words "fetch failed". */
export function reasonOf(error) {
  const cause = error.cause?.errors?.[0] ?? error.cause ?? error;
  return error.reason ?? cause.code ?? cause.message;
}

/** The error of a connection, with a remedy. */
export function networkError(address, error, env = process.env, node = process.versions.node) {
  const { origin } = new URL(address);
  const proxies = ['HTTPS_PROXY', 'https_proxy', 'HTTP_PROXY', 'http_proxy'].filter((name) => env[name]);
  const state = proxies.length > 0 ? `${proxies.join(', ')} ${proxies.length > 1 ? 'are' : 'is'} set` : 'HTTPS_PROXY is not set';
  return new NetworkError(
    `${origin} cannot be reached (${reasonOf(error)}): check the network. Behind a proxy (${state}), Node 22.21 or newer uses it with ` +
      `NODE_USE_ENV_PROXY=1 (this is ${node}), and NODE_EXTRA_CA_CERTS names a certificate of its own; HF_ENDPOINT names a mirror of the hub. ` +
      'Files that a browser downloaded do as well: ./run published FOLDER',
    reasonOf(error),
  );
}

// One file over a connection that may be cut, onto a disk that may be full.

// A try that brings this much counts as none, so that a large file may be cut often.
const progressBytes = 1 << 20;

/**
 * @typedef {object} Digest what a file's content has to be
 * @property {'sha256' | 'sha256-start' | 'git-blob'} kind sha256-start: its first digits; git-blob: Git's name of the content
 * @property {string} digits lower-case hexadecimal
 * @property {string} source who says so, for people
 */

/**
 * Brings one file to its place. A complete one is only read; a started one goes on where it ended: its part lies beside the place.
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
  // The digits keep the part of one version of a file from that of another.
  const part = `${place}.${digest.digits.slice(0, 8)}.part`;
  await fill({ ask, place, part, size, say, advance, wait });
  const brought = await checkedFile(part, size, digest);
  if (!brought.isRight) {
    await rm(part, { force: true });
    throw new CommandError(`${path.basename(place)}: ${brought.complaint}: the file was damaged on its way and is deleted; run again`);
  }
  await rename(part, place);
  return { sha256: brought.sha256, size: brought.size, isNew: true };
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

// Files of a repository on the hub (Hugging Face): its own client lists and resolves, transfer.mjs brings the bytes.

/**
 * @typedef {object} Repository
 * @property {'model' | 'dataset'} type @property {string} name owner/repo
 *
 * @typedef {object} Connection how to reach the hub; each function of this file has these options besides its own
 * @property {string} [hubUrl] by default HF_ENDPOINT, else the hub itself
 * @property {(line: string) => void} [say] hears of waits and repetitions, by default on standard error
 * @property {(seconds: number) => Promise<void>} [wait]
 *
 * @typedef {object} Entry
 * @property {'file' | 'directory'} type @property {string} path inside the repository @property {number} size bytes
 * @property {string} oid Git's name of the content @property {string | null} sha256 of a large file
 */

/** The hub's address: HF_ENDPOINT as the hub's own tools read it. */
export function endpointOf(env = process.env) {
  const address = (env.HF_ENDPOINT || 'https://huggingface.co').replace(/\/+$/, '');
  if (!/^https?:\/\/[^/]/.test(address)) throw new CommandError(`HF_ENDPOINT=${env.HF_ENDPOINT}: expected an address such as https://huggingface.co`, 2);
  return address;
}

/**
 * The commit of a revision, and the licence that the repository's page states.
 * @param {{repo: Repository, revision?: string} & Connection} query
 * @returns {Promise<{commit: string, licence: string | null}>}
 */
export async function resolveRevision({ repo, revision = 'main', ...connection }) {
  return ask({ repo, revision, ...connection }, async (client, common) => {
    const info = repo.type === 'dataset' ? client.datasetInfo : client.modelInfo;
    const { sha, cardData } = await info({ ...common, name: repo.name, revision, additionalFields: ['sha', 'cardData'] });
    if (!/^[0-9a-f]{40}$/.test(sha ?? '')) throw new CommandError(`${common.hubUrl} states no commit of ${repo.name} at ${revision}; expected the hub's answer`);
    const licence = cardData?.license;
    return { commit: sha, licence: (Array.isArray(licence) ? licence.join(', ') : licence) ?? null };
  });
}

/**
 * What a folder holds, files and folders, all pages of it; not what is in the folders inside.
 * @param {{repo: Repository, folder?: string, revision?: string} & Connection} query folder: '' for the root
 * @returns {Promise<Entry[]>}
 */
export async function listFiles({ repo, folder = '', revision = 'main', ...connection }) {
  return ask({ repo, folder, revision, ...connection }, async (client, common) => {
    const entries = [];
    for await (const { type, path: name, size, oid, lfs } of client.listFiles({ ...common, repo, path: folder, revision })) {
      entries.push({ type, path: name, size: lfs?.size ?? size, oid, sha256: lfs?.oid ?? null });
    }
    return entries;
  });
}

/**
 * Brings one file of a listing to `into`/<its path in the repository>, checked by the listing's size and content.
 * @param {{repo: Repository, file: Entry, revision?: string, into?: string, advance?: (bytes: number, size: number) => void} & Connection} job
 *   into: by default the cache's folder of this repository and revision; advance: hears of bytes that are here now
 * @returns {Promise<{place: string, sha256: string, size: number, isNew: boolean}>} isNew: false where it was here already
 */
export async function download({ repo, file, revision = 'main', into = repositoryFolder(repo, revision), advance, ...connection }) {
  const place = path.resolve(into, file.path);
  // The path comes from elsewhere.
  if (!place.startsWith(path.resolve(into) + path.sep)) throw new CommandError(`${repo.name}: the listing has a file "${file.path}", which is outside its folder; nothing is written`);
  const digest = file.sha256 === null ? { kind: 'git-blob', digits: file.oid } : { kind: 'sha256', digits: file.sha256 };
  const request = (from) => ask({ repo, folder: file.path, revision, ...connection, once: true }, (client, common) => bytesFrom(client, { ...common, repo, path: file.path, revision }, from));
  const { say = console.error, wait } = connection;
  const brought = await bringFile({ ask: request, place, size: file.size, digest: { ...digest, source: 'the hub\'s listing' }, say, wait, advance });
  return { place, ...brought };
}

/** The answer with the bytes of a file from an offset on, which the client does not ask for. */
async function bytesFrom(client, { hubUrl, fetch: fetchPatiently, accessToken, repo, path: file, revision }, from) {
  const place = `${repo.type === 'dataset' ? 'datasets/' : ''}${repo.name}/resolve/${encodeURIComponent(revision)}/${file.split('/').map(encodeURIComponent).join('/')}`;
  // Compressed, the bytes from an offset on would be those of the compressed file.
  const headers = { Range: `bytes=${from}-`, 'Accept-Encoding': 'identity', ...(accessToken ? { Authorization: `Bearer ${accessToken}` } : {}) };
  const answer = await fetchPatiently(`${hubUrl}/${place}`, { headers });
  // 416, range not satisfiable, answers for a file of which all bytes are here already.
  if (!answer.ok && answer.status !== 416) throw new client.HubApiError(answer.url, answer.status);
  return answer;
}

/**
 * Runs something with the client; its errors become sentences. A cut connection is tried again, unless `once`.
 * @template T @param {object} query @param {(client: object, common: object) => Promise<T>} work @returns {Promise<T>}
 */
async function ask({ repo, folder, revision, hubUrl = endpointOf(), say = console.error, wait = waitSeconds, once = false }, work) {
  // Imported here, since set-up may just have installed it.
  const client = await import('@huggingface/hub');
  const common = { hubUrl, fetch: patientFetch({ say, wait }), accessToken: tokenOf(process.env) };
  for (let attempt = 1; ; attempt += 1) {
    try {
      return await work(client, common);
    } catch (error) {
      if (error instanceof client.HubApiError) throw refusal(error, { repo, folder, revision, hubUrl });
      if (error instanceof SyntaxError || error instanceof client.InvalidApiResponseFormatError) {
        throw new CommandError(`${hubUrl}: not the hub's answer (${error.message}): check HF_ENDPOINT, and whether a proxy answers in its place`);
      }
      if (once || !isCut(error)) throw error;
      if (attempt === tries) throw new CommandError(`${hubUrl}: the connection was cut ${tries} times in a row: run again when the network is better`);
      await wait(backOffSeconds(attempt));
    }
  }
}

function tokenOf(env) {
  const token = env.HF_TOKEN?.trim();
  if (!token) return undefined;
  if (!token.startsWith('hf_')) throw new CommandError('HF_TOKEN is set and is no token of the hub, which begin with hf_: correct or unset it', 2);
  return token;
}

/** The sentence for an answer of the hub that is no success. */
function refusal({ statusCode, message }, { repo, folder, revision, hubUrl }) {
  const page = `${hubUrl}/${repo.type === 'dataset' ? 'datasets/' : ''}${repo.name}`;
  const what = `${repo.type} repository ${repo.name}`;
  if (statusCode === 404) {
    const where = folder ? `no "${folder}" in the ${what} at revision ${revision}` : `no ${what} with the revision ${revision}`;
    return new CommandError(`${hubUrl} has ${where} (404): ${page} shows what there is`);
  }
  if (statusCode === 401 || statusCode === 403) {
    return new CommandError(
      `${hubUrl} does not show the ${what} (${statusCode}): it does not exist, or it is private or gated. See ${page}; where its terms are to be accepted, ` +
        'do so there and set HF_TOKEN to a token of your account. A token that has ended is refused as well: unset HF_TOKEN',
    );
  }
  return new CommandError(`${hubUrl}: ${what}, ${folder ? `"${folder}", ` : ''}revision ${revision}: ${statusCode} (${message})`);
}
