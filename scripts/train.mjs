// train: trains the default model, all tiers, and writes its .haptoflow file (with arguments: haptoflow-training train)
import { callerFolder, inRepository, run, runMain, runOrFail } from './lib/process.mjs';
import { pythonOrFail, setUp, trainingEnvironment } from './lib/setup.mjs';
import { bringRecordings, clusterOptions, judgementOf, trainingWords } from './lib/training_words.mjs';
import { shippedModel } from './lib/measured_part.mjs';

// One run writes the default model and the reference values that the tests compare it with, so that they match.
const defaults = [
  'train-tiers',
  '--out', inRepository('out', 'train', 'default'),
  '--export', shippedModel,
  '--parity', inRepository('Tests', 'Golden', 'model', 'default.parity.json'),
];

const help = `usage: ./run train [ARGUMENTS]
       ./run train --cluster [--textures 0,38,49] [--into DIR] [ARGUMENTS]

Trains the default model, all tiers, and writes its .haptoflow file and the golden file that the tests compare it with.
Interrupted, it goes on where it was. With arguments, those of \`haptoflow-training train\` and none of the defaults; with
\`train-tiers\` as the first, those of \`haptoflow-training train-tiers\`, which trains a whole model.
After a training on recordings of your own (--recordings and --export), the model is compared with their held-out parts
and with what \`haptoflow learn\` makes of the others (about 10 s a label); the last line says whether it is worth using,
and the exit code is 3 if it is not. --no-judgement leaves that out.
--cluster downloads what training needs of the Cluster Haptic Texture Dataset (CC BY 4.0, about 50 MB a texture) into DIR, by
default out/cluster-haptic-texture, and trains what ships on it, as out/train/cluster/cluster.haptoflow; without --textures,
those that Training/configs/labels-cluster.toml names. Further arguments are those of \`train-tiers\`.
Paths are relative to the current folder.
With the Python packages in place, PYTHONPATH=Training /usr/bin/python3 -m haptoflow_training train --help lists them.`;

function commandOf(words) {
  if (words.length === 0) return defaults;
  return words[0] === 'train-tiers' ? words : ['train', ...words];
}

async function clusterCommand(words, training) {
  const options = clusterOptions(words);
  const { labels } = await bringRecordings(options, training);
  return trainingWords({ ...options, labels });
}

await runMain('train', async (words) => {
  await setUp(['python']);
  const judgement = judgementOf(words);
  const own = words.filter((word) => word !== '--no-judgement');
  const options = { cwd: callerFolder(), env: trainingEnvironment() };
  const python = async (...args) => (await run(pythonOrFail(), ['-m', ...args], options)).exitCode;
  const listed = (words) => runOrFail(pythonOrFail(), ['-m', 'haptoflow_training', ...words], { ...options, quiet: true });
  const exitCode = await python('haptoflow_training', ...(own.includes('--cluster') ? await clusterCommand(own, listed) : commandOf(own)));
  return exitCode === 0 && judgement ? python('haptoflow_benchmark', ...judgement) : exitCode;
}, { help });
