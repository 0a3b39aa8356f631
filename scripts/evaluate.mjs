// evaluate: accuracy over time, every row measured through the engine (arguments: those of haptoflow-training evaluate)
import { buildNative } from './lib/native_build.mjs';
import { run, runMain } from './lib/process.mjs';
import { inRepository } from './lib/repository.mjs';
import { pythonOrFail, setUp } from './lib/setup.mjs';

await runMain('evaluate', async (words) => {
  await setUp(['build', 'python']);
  await buildNative({ targets: ['audioplugin_haptoflow', 'haptoflow_cli'] });
  const args = ['-m', 'haptoflow_training', 'evaluate', ...words];
  const { exitCode } = await run(pythonOrFail(), args, { env: { PYTHONPATH: inRepository('Training'), OPENBLAS_NUM_THREADS: '1' } });
  return exitCode;
});
