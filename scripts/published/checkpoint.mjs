// A published checkpoint: which files of a folder it is, how they come, and where they are from.
import { existsSync, readFileSync, readdirSync, renameSync, statSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';
import { repositoryFolder } from './cache.mjs';
import { download, endpointOf, listFiles, resolveRevision } from './hub.mjs';
import { progressBar } from './progress.mjs';
import { defaultSpec, parseSpec } from './spec.mjs';

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
