// demo: builds, renders eight labels and a scene, and makes out/demo/index.html
import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { buildNative } from './lib/native_build.mjs';
import { CommandError, runMain } from './lib/process.mjs';
import { inRepository } from './lib/repository.mjs';
import { setUp } from './lib/setup.mjs';

const help = `usage: ./run demo

Installs what is missing (Debian, with root or sudo), builds the command line, renders a stroke over a scene and one stroke
over eight labels, and makes out/demo/index.html: waveforms, spectrograms and players. Minutes the first time, then
seconds. out/demo/report.json has the figures, out/demo/*.wav the sound.`;

await runMain('demo', async () => {
  const begin = performance.now();
  const elapsed = () => `${((performance.now() - begin) / 1000).toFixed(1)} s`;
  await setUp(['build']);
  await buildNative({ targets: ['haptoflow_cli'] });

  // Imported here, since these modules need npm packages that set-up may just have installed.
  const { plannedRenders, render } = await import('./demo/renders.mjs');
  const { assembleReport } = await import('./demo/report.mjs');
  const { readFloatWav } = await import('./demo/wav.mjs');
  const { demoPage } = await import('./demo/page.mjs');

  const folder = inRepository('out', 'demo');
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  try {
    const renders = [];
    for (const planned of plannedRenders()) {
      const rendered = await render(planned, folder);
      const { seconds, segments, inference_ms: inference } = rendered.report;
      console.log(`demo: ${rendered.name}: ${seconds.toFixed(1)} s, ${segments} segments, ${inference.p50.toFixed(2)} ms each (${elapsed()})`);
      renders.push({ ...rendered, ...readFloatWav(readFileSync(rendered.wavPath), rendered.wavPath) });
    }
    const report = assembleReport(renders);
    writeFileSync(path.join(folder, 'report.json'), `${JSON.stringify(report, null, 2)}\n`);
    writeFileSync(path.join(folder, 'index.html'), demoPage(report, renders));
  } catch (error) {
    if (error instanceof RangeError) throw new CommandError(error.message);
    throw error;
  }
  console.log(`demo: open ${path.join(folder, 'index.html')} (${elapsed()})`);
}, { help, takesWords: false });
