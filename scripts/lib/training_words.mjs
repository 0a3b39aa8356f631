import { mkdirSync } from 'node:fs';
import path from 'node:path';
import { download, listFiles, resolveRevision } from '../published/hub.mjs';
import { progressBar } from '../published/progress.mjs';
import { CommandError, callerFolder, inRepository } from './process.mjs';

// The comparison that ends a training on recordings of one's own.

/** Arguments of the `haptoflow-benchmark evaluate` that judges a training with the arguments `words`; null if there is
 * nothing to judge, because the training has no --recordings, writes no model file (--export), or has --no-judgement. */
export function judgementOf(words) {
  const recordings = valuesOf(words, '--recordings');
  const [model] = valuesOf(words, '--export');
  if (recordings.length === 0 || !model || words.includes('--no-judgement')) {
    return null;
  }
  const [labels] = valuesOf(words, '--labels');
  return [
    'evaluate', '--model', model, '--recordings', ...recordings, ...(labels ? ['--labels', labels] : []), '--beside-learn',
  ];
}

function valuesOf(words, option) {
  const whole = words.find((word) => word.startsWith(`${option}=`));
  if (whole) {
    return [whole.slice(option.length + 1)];
  }
  const place = words.indexOf(option);
  if (place < 0) {
    return [];
  }
  const after = words.slice(place + 1);
  const end = after.findIndex((word) => word.startsWith('-'));
  return end < 0 ? after : after.slice(0, end);
}

// ./run train --cluster: brings the recordings of chosen textures of the published data set from the hub and names the
// training on them.

const repo = { type: 'dataset', name: 'tamago117/cluster-haptic-texture-dataset' };
const list = 'texture_list.xlsx';
const kinds = ['accel', 'force', 'position'];
// A recording is three small files; most of a file's time is the way to the hub.
const atOnce = 8;

/**
 * The words after `--cluster`, in parts.
 * @param {string[]} words
 * @returns {{textures: string | null, into: string, further: string[]}} further: the arguments that are passed on to `train-tiers`
 */
export function clusterOptions(words) {
  const options = { textures: null, into: inRepository('out', 'cluster-haptic-texture'), further: [] };
  for (let at = 0; at < words.length; at += 1) {
    const [name, whole] = words[at].split(/=(.*)/s);
    if (name === '--cluster') continue;
    if (name === '--recordings' || name === 'train-tiers') throw new CommandError(`--cluster brings its recordings and its command: leave ${name} out`, 2);
    if (name !== '--textures' && name !== '--into') {
      options.further.push(words[at]);
      continue;
    }
    const value = whole ?? words[(at += 1)];
    if (!value || value.startsWith('--')) throw new CommandError(`${name} needs ${name === '--into' ? 'a folder' : 'ids with commas between them, as 0,38,49'}`, 2);
    if (name === '--textures' && !/^\d+(,\d+)*$/.test(value)) throw new CommandError(`--textures ${value}: expected ids with commas between them, as 0,38,49`, 2);
    options[name.slice(2)] = name === '--into' ? path.resolve(callerFolder(), value) : value;
  }
  return options;
}

/** The arguments of haptoflow_training that train on what `bringRecordings` brought. */
export function trainingWords({ into, labels, further }) {
  const given = (name) => further.some((word) => word === name || word.startsWith(`${name}=`));
  const out = inRepository('out', 'train', 'cluster');
  return [
    'train-tiers', '--recordings', into,
    ...(given('--configs') ? [] : ['--configs', inRepository('Training', 'configs', 'cluster')]),
    ...(given('--labels') ? [] : ['--labels', labels]),
    ...(given('--out') ? [] : ['--out', out]),
    ...(given('--export') ? [] : ['--export', path.join(out, 'cluster.haptoflow')]),
    ...further,
  ];
}

/**
 * Downloads acceleration, force and position of the textures into a folder in the hub release's layout, with a labels file.
 * What is there already is checked and kept, what was begun goes on.
 * @param {{textures: string | null, into: string}} options textures: ids with commas; null for those of labels-cluster.toml
 * @param {(words: string[]) => Promise<string>} training runs `haptoflow_training` with words; its output
 * @param {{say?: (line: string) => void, hubUrl?: string, wait?: (seconds: number) => Promise<void>}} connection
 * @returns {Promise<{labels: string, files: number, bytes: number, newFiles: number}>} labels: the file's path
 */
export async function bringRecordings({ textures, into }, training, { say = console.log, ...connection } = {}) {
  mkdirSync(into, { recursive: true });
  const { commit, licence } = await resolveRevision({ repo, ...connection });
  say(`train: Cluster Haptic Texture Dataset, ${repo.name} at ${commit.slice(0, 8)}, licence ${licence ?? 'CC BY 4.0'}, into ${into}`);
  const query = { repo, revision: commit, ...connection };
  const found = (await listFiles(query)).find(({ path: name }) => name === list);
  if (!found) throw new CommandError(`${repo.name} has no ${list} at ${commit.slice(0, 8)}; expected it beside sensor_data`);
  await download({ ...query, file: found, into });
  const labels = path.join(into, 'labels.toml');
  const chosen = parseLabels(await training(['labels', into, '--out', labels, ...(textures === null ? [] : ['--textures', textures])]));
  say(`train: ${chosen.length} textures: ${chosen.map(({ id, label }) => `${label} (${id})`).join(', ')}; their labels are in ${labels}`);
  const files = await recordingFiles(query, chosen.map(({ id }) => id));
  const bytes = files.reduce((sum, { size }) => sum + size, 0);
  say(`train: ${files.length} files, ${(bytes / 1e6).toFixed(1)} MB`);
  const newFiles = await bringAll(files, { ...query, into }, bytes);
  return { labels, files: files.length, bytes, newFiles };
}

/** Lines "id, tab, label" of `haptoflow-training labels`. */
const parseLabels = (text) => text.split('\n').filter((line) => line.includes('\t')).map((line) => {
  const [id, label] = line.split('\t');
  return { id, label };
});

async function recordingFiles(query, ids) {
  const files = [];
  for (const id of ids) {
    for (const kind of kinds) {
      const entries = await listFiles({ ...query, folder: `sensor_data/${kind}/${id}` });
      files.push(...entries.filter(({ type, path: name }) => type === 'file' && name.endsWith('.parquet')));
    }
  }
  return files;
}

/** Downloads several files at a time; the first error ends it when those that have begun are done. How many were new. */
async function bringAll(files, query, bytes) {
  const bar = progressBar('recordings', bytes);
  const left = [...files];
  let newFiles = 0;
  let failure = null;
  const lane = async () => {
    while (left.length > 0 && failure === null) {
      try {
        const { isNew } = await download({ say: bar.say, ...query, file: left.shift(), advance: bar.advance });
        newFiles += isNew ? 1 : 0;
      } catch (error) {
        failure ??= error;
      }
    }
  };
  await Promise.all(Array.from({ length: atOnce }, lane));
  bar.end();
  if (failure) throw failure;
  return newFiles;
}
