// pack:web: makes the npm package haptoflow-web in out/ (--help)
import { runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';
import { buildEngine, packEngine } from './lib/web_build.mjs';

const help = `usage: npm run pack:web

Builds the engine for browsers and packs it with ONNX Runtime for the web and the shipped model: out/haptoflow-web-VERSION.tgz,
for \`npm install\`.`;

await runMain('pack:web', async () => {
  await setUp(['build', 'web']);
  await buildEngine();
  const { file, bytes } = await packEngine();
  console.log(`pack: ${file} (${(bytes / 2 ** 20).toFixed(1)} MiB)`);
  return 0;
}, { help, takesWords: false });
