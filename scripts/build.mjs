// build: builds the native plugin and the command line (build/native)
import { buildNative } from './lib/native_build.mjs';
import { runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';

await runMain('build', async () => {
  await setUp(['build']);
  await buildNative();
});
