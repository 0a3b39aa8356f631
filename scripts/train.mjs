// train: trains the default model, all tiers, and writes its .haptoflow file (with arguments: haptoflow-training train)
import { run, runMain } from './lib/process.mjs';
import { inRepository, callerFolder } from './lib/repository.mjs';
import { pythonOrFail, setUp } from './lib/setup.mjs';

// One run writes the default model and the reference values that the tests compare it with, so that they match.
const defaults = [
  'train-tiers',
  '--out', inRepository('out', 'train', 'default'),
  '--export', inRepository('Packages', 'com.haptoflow.runtime', 'Runtime', 'Models', 'default.haptoflow'),
  '--parity', inRepository('Tests', 'Golden', 'model', 'default.parity.json'),
];

const help = `usage: ./run train [ARGUMENTS]

Trains the default model, all tiers, and writes its .haptoflow file and the golden file that the tests compare it with.
Interrupted, it goes on where it was. With arguments, those of \`haptoflow-training train\` and none of the defaults.
Paths are relative to the current folder.
With the Python packages in place, PYTHONPATH=Training /usr/bin/python3 -m haptoflow_training train --help lists them.`;

await runMain('train', async (words) => {
  await setUp(['python']);
  const args = ['-m', 'haptoflow_training', ...(words.length > 0 ? ['train', ...words] : defaults)];
  const { exitCode } = await run(pythonOrFail(), args, { cwd: callerFolder(), env: { PYTHONPATH: inRepository('Training'), OPENBLAS_NUM_THREADS: '1' } });
  return exitCode;
}, { help });
