// demo: builds, renders eight labels and a scene, and makes out/demo/index.html
import os from 'node:os';
import { buildNative } from './lib/native_build.mjs';
import { inRepository, runMain, runOrFail } from './lib/process.mjs';
import { drawingModules, pythonOrFail, setUp } from './lib/setup.mjs';

const help = `usage: ./run demo

Installs what is missing (Debian, with root or sudo), builds the command line, renders a stroke over a scene and one stroke
over eight labels, and makes out/demo/index.html: waveforms, spectrograms and players. Minutes the first time, then
seconds. out/demo/report.json has the figures, out/demo/*.wav the sound.`;

await runMain('demo', async () => {
  const begin = performance.now();
  await setUp(['build', 'drawings']);
  await buildNative({ targets: ['haptoflow_cli'] });
  const machine = `${os.cpus()[0]?.model.trim() ?? 'unknown processor'}, ${os.cpus().length} cores`;
  const env = { PYTHONPATH: inRepository('scripts', 'pack'), PYTHONDONTWRITEBYTECODE: '1', OPENBLAS_NUM_THREADS: '1' };
  await runOrFail(pythonOrFail(drawingModules), [inRepository('scripts', 'demo', 'demo.py'), machine], { env });
  console.log('demo: `./run play` opens the live page, to draw yourself');
  console.log(`demo: open ${inRepository('out', 'demo', 'index.html')} (${((performance.now() - begin) / 1000).toFixed(1)} s)`);
}, { help, takesWords: false });
