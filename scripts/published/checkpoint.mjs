import { existsSync, readFileSync, readdirSync, renameSync, statSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';
import { bringFile, download, endpointOf, listFiles, patientFetch, resolveRevision, waitSeconds } from './hub.mjs';
import { progressBar } from './progress.mjs';

// Where downloaded files lie: outside the repository, so that every clone uses them and none carries them.

/** The folder of HaptoFlow's downloads. */
export function cacheRoot(env = process.env, platform = process.platform) {
  if (env.XDG_CACHE_HOME) return path.resolve(env.XDG_CACHE_HOME, 'haptoflow');
  if (platform === 'win32') return path.resolve(env.LOCALAPPDATA ?? path.join(os.homedir(), 'AppData', 'Local'), 'haptoflow', 'cache');
  return path.resolve(env.HOME ?? os.homedir(), '.cache', 'haptoflow');
}

/**
 * The folder in which files of a repository have their paths. It is named by the revision that was asked for: where a branch
 * has moved on, files that did not change stay.
 */
export function repositoryFolder({ type, name }, revision, root = cacheRoot()) {
  return path.join(root, `${type}s`, ...name.split('/'), encodeURIComponent(revision));
}

// What the user names: a folder on the hub, or one on this disk.

export const defaultSpec = 'hf://tamago117/HaptoFlow/haptoflow_accel';

const form = 'expected hf://owner/repo/folder or hf://owner/repo/folder@revision, or a folder on this disk';
const namePattern = /^[\w][\w.-]*$/;

/**
 * @param {string} spec
 * @returns {{repo: import('./hub.mjs').Repository, folder: string, revision: string} | null} null for a folder on this disk;
 *   folder: '' for the repository's root
 * @throws CommandError where it begins as an address and is none
 */
export function parseSpec(spec) {
  if (!/^[a-z]+:\/\//i.test(spec)) return null;
  const wrong = (what) => new CommandError(`"${spec}": ${what}; ${form}`, 2);
  if (!spec.startsWith('hf://')) throw wrong(`only hf:// is read`);
  const [path, revision = 'main', ...more] = spec.slice('hf://'.length).split('@');
  if (more.length > 0) throw wrong('more than one @');
  const [owner, name, ...folders] = path.replace(/\/$/, '').split('/');
  if (!namePattern.test(owner ?? '') || !namePattern.test(name ?? '')) throw wrong('no owner and repository');
  if (folders.some((part) => part === '' || part === '.' || part === '..' || /[?#%\\]/.test(part))) throw wrong('no name of a folder');
  if (!/^[\w][\w./-]*$/.test(revision)) throw wrong(`"${revision}" is no revision`);
  return { repo: { type: 'model', name: `${owner}/${name}` }, folder: folders.join('/'), revision };
}

// EnCodec's 24 kHz weights, which the published network works in. The name of the file states what its SHA-256 begins with.

const published = 'https://dl.fbaipublicfiles.com/encodec/v0/encodec_24khz-d7cc33bc.th';

/** The address of the weights: HAPTOFLOW_ENCODEC_URL for a mirror, whose file has the same form of name. */
export function encodecAddress(env = process.env) {
  const address = env.HAPTOFLOW_ENCODEC_URL || published;
  if (!/^https?:\/\/[^?#]+-[0-9a-f]{8}\.th$/.test(address)) {
    throw new CommandError(`HAPTOFLOW_ENCODEC_URL=${address}: expected an address that ends in -<8 digits of the file's SHA-256>.th, as ${path.posix.basename(published)} does`, 2);
  }
  return address;
}

/**
 * Brings the weights into the cache.
 * @returns {Promise<{place: string, address: string, sha256: string, size: number, isNew: boolean}>}
 */
export async function bringEncodec({ address = encodecAddress(), root = cacheRoot(), say = console.error, wait = waitSeconds, advance } = {}) {
  const name = path.posix.basename(new URL(address).pathname);
  const digest = { kind: 'sha256-start', digits: name.slice(-11, -3), source: 'its name' };
  const fetchPatiently = patientFetch({ say, wait });
  const ask = async (from) => {
    const response = await fetchPatiently(address, { headers: { Range: `bytes=${from}-`, 'Accept-Encoding': 'identity' } });
    if (!response.ok && response.status !== 416) {
      throw new CommandError(`${address} answers ${response.status}: HAPTOFLOW_ENCODEC_URL names another place of the file, or --encodec the file itself`);
    }
    return response;
  };
  const place = path.join(root, 'encodec', name);
  return { place, address, ...(await bringFile({ ask, place, size: null, digest, say, wait, advance })) };
}

// A published checkpoint: which files of a folder it is, how they come, and where they are from.

const metaName = 'meta.json';
const originName = 'origin.json';

/**
 * @typedef {object} Origin what stands in origin.json beside downloaded files
 * @property {string} origin hf://owner/repo/folder@commit @property {string} page @property {string} repository
 * @property {string} folder @property {string} revision as it was asked for @property {string} commit
 * @property {string | null} licence as the page states it @property {Record<string, {size: number, sha256: string}>} files
 */

/**
 * The two files of a checkpoint among the names of a folder.
 * @throws CommandError that names what is there
 */
export function checkpointNames(names, where) {
  const weights = names.filter((name) => name.endsWith('.safetensors'));
  const there = names.length > 0 ? names.join(', ') : 'nothing';
  if (!names.includes(metaName)) throw new CommandError(`${where} has no ${metaName}: expected the folder of one checkpoint, ${metaName} and one .safetensors; it has ${there}`);
  if (weights.length !== 1) throw new CommandError(`${where} has ${weights.length === 0 ? 'no .safetensors' : weights.join(', ')}: expected ${metaName} and one .safetensors; it has ${there}`);
  return [metaName, weights[0]];
}

/** A folder on this disk. @returns {{folder: string, codec: string | null, origin: Origin | null}} codec: its only .th */
export function localCheckpoint(folder) {
  if (!existsSync(folder) || !statSync(folder).isDirectory()) {
    throw new CommandError(`${folder}: no such folder; expected one with ${metaName} and one .safetensors, or hf://owner/repo/folder`, 2);
  }
  const names = readdirSync(folder);
  checkpointNames(names.filter((name) => name !== originName), folder);
  const codecs = names.filter((name) => name.endsWith('.th'));
  return { folder, codec: codecs.length === 1 ? path.join(folder, codecs[0]) : null, origin: originOf(folder) };
}

function originOf(folder) {
  const file = path.join(folder, originName);
  if (!existsSync(file)) return null;
  try {
    return JSON.parse(readFileSync(file, 'utf8'));
  } catch (error) {
    throw new CommandError(`${file}: not valid JSON (${error.message}): delete it, or download the folder again`);
  }
}

/** Brings a folder of the hub into the cache and notes its origin beside it. @returns {Promise<{folder: string, origin: Origin}>} */
export async function bringCheckpoint({ repo, folder, revision }) {
  const hubUrl = endpointOf();
  const into = repositoryFolder(repo, revision);
  const place = path.join(into, folder);
  const { commit, licence } = await resolveRevision({ repo, revision, hubUrl }).catch((error) => {
    // Without a network, what came before does as well.
    if (existsSync(path.join(place, originName))) error.message += `\nWhat was downloaded before: ./run published ${place}`;
    throw error;
  });
  const where = `hf://${[repo.name, folder].filter(Boolean).join('/')}@${revision}`;
  const entries = await listFiles({ repo, folder, revision: commit, hubUrl });
  const nameOf = (entry) => path.posix.basename(entry.path) + (entry.type === 'directory' ? '/' : '');
  const names = checkpointNames(entries.map(nameOf), where);
  const wanted = names.map((name) => entries.find((entry) => nameOf(entry) === name));
  const bar = progressBar(repo.name, wanted.reduce((sum, { size }) => sum + size, 0));
  const files = {};
  try {
    for (const file of wanted) {
      const { size, sha256 } = await download({ repo, file, revision: commit, into, hubUrl, say: bar.say, advance: bar.advance });
      files[path.posix.basename(file.path)] = { size, sha256 };
    }
  } finally {
    bar.end();
  }
  const origin = { origin: `hf://${[repo.name, folder].filter(Boolean).join('/')}@${commit}`, page: `${hubUrl}/${repo.name}`, repository: repo.name, folder, revision, commit, licence, files };
  const note = path.join(place, originName);
  writeFileSync(`${note}.${process.pid}`, `${JSON.stringify(origin, null, 2)}\n`);
  renameSync(`${note}.${process.pid}`, note);
  return { folder: place, origin };
}

const authors = parseSpec(defaultSpec).repo.name;

/** A line for each part of what will be written: where it is from and under which licence, as far as that is known. */
export function originLines({ folder, origin, codec }) {
  const isAuthors = origin?.repository === authors;
  const licence = origin?.licence ? `licence ${origin.licence}, as ${origin.page} states` : `${origin?.page} states no licence${isAuthors ? '; the authors\' code is under Apache-2.0' : ''}`;
  const weights = origin ? `${origin.origin}, ${licence}` : `${folder}; where they are from is not known here`;
  const recordings = isAuthors || !origin
    ? `Cluster Haptic Texture Dataset, CC BY 4.0 (https://huggingface.co/datasets/tamago117/cluster-haptic-texture-dataset)${origin ? '' : ', where the weights are those of the paper\'s authors'}`
    : `see ${origin.page}`;
  return [
    `weights: ${weights}`,
    ...Object.entries(origin?.files ?? {}).map(([name, { size, sha256 }]) => `  ${name}: ${size} bytes, SHA-256 ${sha256}`),
    `recordings that they were trained on: ${recordings}`,
    `codec: ${codec.address ?? codec.place}${codec.sha256 ? `, SHA-256 ${codec.sha256}` : ''}; EnCodec's code is under the MIT licence, for its weights see https://github.com/facebookresearch/encodec`,
  ];
}
