// build:web: builds the engine for browsers and the live page into Web/dist (--help)
import { runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';
import { buildEngine, stagePage } from './lib/web_build.mjs';

const help = `usage: npm run build:web

Compiles the engine to WebAssembly with the Emscripten on PATH (installed from Debian's packages where it is missing) and puts
it with its scripts, ONNX Runtime for the web and the shipped model into Web/dist/engine. The live page goes with it into
Web/dist/page: static files, for any path.`;

await runMain('build:web', async () => {
  await setUp(['build', 'web']);
  await buildEngine();
  stagePage();
  return 0;
}, { help, takesWords: false });
