// evaluate: accuracy over time, every row measured through the engine (arguments: those of haptoflow-paper evaluate)
import { buildNative } from './lib/native_build.mjs';
import { callerFolder, run, runMain } from './lib/process.mjs';
import { pythonOrFail, setUp, trainingEnvironment } from './lib/setup.mjs';

const help = `usage: ./run evaluate [ARGUMENTS]

Measures accuracy over time, every row through the engine. Arguments are those of \`haptoflow-paper evaluate\`; with
--recordings, --model or --labels, which compare one model with recordings of your own, those of \`haptoflow-benchmark evaluate\`.
Paths are relative to the current folder. With the Python packages in place, PYTHONPATH=Training /usr/bin/python3 -m haptoflow_paper evaluate --help lists them.`;

await runMain('evaluate', async (words) => {
  await setUp(['build', 'python']);
  await buildNative({ targets: ['audioplugin_haptoflow', 'haptoflow_cli'] });
  const comparesOneModel = words.some((word) => /^--(recordings|model|labels)(=|$)/.test(word));
  const args = ['-m', comparesOneModel ? 'haptoflow_benchmark' : 'haptoflow_paper', 'evaluate', ...words];
  const { exitCode } = await run(pythonOrFail(), args, { cwd: callerFolder(), env: trainingEnvironment() });
  return exitCode;
}, { help });
