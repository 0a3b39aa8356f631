// published: brings the authors' published weights and writes them as a .haptoflow file that the plugin plays
import { existsSync } from 'node:fs';
import path from 'node:path';
import { buildNative } from './lib/native_build.mjs';
import { CommandError, callerFolder, parsed, run, runMain } from './lib/process.mjs';
import { pythonOrFail, setUp, trainingEnvironment } from './lib/setup.mjs';
import { bringCheckpoint, bringEncodec, cacheRoot, defaultSpec, encodecAddress, localCheckpoint, originLines, parseSpec } from './published/checkpoint.mjs';
import { endpointOf } from './published/hub.mjs';
import { progressBar } from './published/progress.mjs';

const help = `usage: ./run published [hf://OWNER/REPO/FOLDER[@REVISION] | FOLDER] [-o OUT.haptoflow]
                       [--encodec FILE] [--peak-g G | --dataset-info FILE]

Downloads the weights that the authors of the paper publish (118 real materials) and EnCodec's, checks them, prints where
each part is from and under which licence, and writes the model file that the plugin plays (haptoflow-paper
import-published). What is downloaded stays in ${cacheRoot()} (XDG_CACHE_HOME names another
place): a complete file does not come twice, and a cut download goes on where it ended.

  hf://...             a folder with meta.json and one .safetensors; default ${defaultSpec}.
                       REVISION is a branch, a tag or a commit
  FOLDER               the same files on this disk, with EnCodec's .th beside them where it is there: nothing is downloaded
                       that is in it
  -o, --out FILE       the model file (default published.haptoflow)
  --encodec FILE       EnCodec's 24 kHz weights, in place of the download
  --peak-g G           the level: the peak of the recordings that 1 stands for, in g
  --dataset-info FILE  the level: the dataset_info.json of the recordings. Without either the level is assumed, and the file
                       says so

Environment: HF_ENDPOINT (a mirror of the hub), HF_TOKEN (for a repository that asks for one), HAPTOFLOW_ENCODEC_URL (another
place of EnCodec's file). Behind a proxy: HTTPS_PROXY with NODE_USE_ENV_PROXY=1 and Node 22.21 or newer.

examples:
  ./run published
  ./run published --peak-g 1.5 -o real.haptoflow
  ./run published ~/Downloads/haptoflow_accel --encodec ~/Downloads/encodec_24khz-d7cc33bc.th

Then: build/native/haptoflow inspect published.haptoflow; in Unity, drop the file into Assets.`;

const options = {
  out: { type: 'string', short: 'o', default: 'published.haptoflow' },
  encodec: { type: 'string' },
  'peak-g': { type: 'string' },
  'dataset-info': { type: 'string' },
};

/** @returns what the words ask for; paths are absolute */
function requestOf(words) {
  const { values, positionals } = parsed(words, options, { allowPositionals: true });
  if (positionals.length > 1) throw new CommandError(`"${positionals[1]}" is one folder too many: expected one, or none for ${defaultSpec}`, 2);
  const absolute = (name) => (name === undefined ? undefined : path.resolve(callerFolder(), name));
  const [spec = defaultSpec] = positionals;
  const hub = parseSpec(spec);
  const request = { hub, folder: hub ? null : absolute(spec), out: absolute(values.out), encodec: absolute(values.encodec), info: absolute(values['dataset-info']), peak: values['peak-g'] };
  if (request.peak !== undefined && request.info !== undefined) throw new CommandError('--peak-g and --dataset-info both state the level: give one', 2);
  for (const [name, file] of [['--encodec', request.encodec], ['--dataset-info', request.info], ['--out', path.dirname(request.out)]]) {
    if (file !== undefined && !existsSync(file)) throw new CommandError(`${name}: ${file} is not there`, 2);
  }
  return request;
}

/** The codec's file: the one that was named, the one beside the weights, or the published one. */
async function codecOf(named, beside) {
  if (named ?? beside) return { place: named ?? beside };
  const bar = progressBar(path.posix.basename(encodecAddress()), null);
  try {
    return await bringEncodec({ say: bar.say, advance: bar.advance });
  } finally {
    bar.end();
  }
}

await runMain('published', async (words) => {
  const request = requestOf(words);
  const local = request.hub ? null : localCheckpoint(request.folder);
  // Wrong settings are said before anything is installed.
  endpointOf();
  encodecAddress();
  await setUp(['build', 'python']);
  const checkpoint = local ?? (await bringCheckpoint(request.hub));
  const codec = await codecOf(request.encodec, local?.codec);
  originLines({ ...checkpoint, codec }).forEach((line) => console.log(line));
  await buildNative({ targets: ['audioplugin_haptoflow', 'haptoflow_cli'] });
  const args = ['-m', 'haptoflow_paper', 'import-published', checkpoint.folder, '--encodec', codec.place, '-o', request.out];
  if (request.peak !== undefined) args.push('--peak-g', request.peak);
  if (request.info !== undefined) args.push('--dataset-info', request.info);
  const { exitCode } = await run(pythonOrFail(), args, { cwd: callerFolder(), env: trainingEnvironment() });
  return exitCode;
}, { help });
