// Files of a repository on the hub (Hugging Face): its own client lists and resolves, transfer.mjs brings the bytes.
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';
import { repositoryFolder } from './cache.mjs';
import { backOffSeconds, isCut, patientFetch, tries, waitSeconds } from './requests.mjs';
import { bringFile } from './transfer.mjs';

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

/**
 * The answer with the bytes of a file from an offset on. The client knows the address and the errors; its request is for one
 * byte, to learn of the file, and for a description of chunks in place of bytes. This one is for the bytes.
 */
async function bytesFrom(client, query, from) {
  let answer;
  const own = async (address, { headers }) => {
    const { Accept: _, ...others } = headers;
    // Compressed, the bytes from an offset on would be those of the compressed file.
    answer = await query.fetch(address, { headers: { ...others, Range: `bytes=${from}-`, 'Accept-Encoding': 'identity' } });
    // Of a file that is complete.
    if (answer.status === 416) throw new CompleteAnswer();
    return answer;
  };
  try {
    const info = await client.fileDownloadInfo({ ...query, fetch: own });
    if (info === null) throw new client.HubApiError(answer.url, 404);
  } catch (error) {
    // The client wants a range and an ETag; the bytes are good without.
    const isGood = error instanceof CompleteAnswer || (error instanceof client.InvalidApiResponseFormatError && answer?.ok);
    if (!isGood) throw error;
  }
  return answer;
}

class CompleteAnswer extends Error {}

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
