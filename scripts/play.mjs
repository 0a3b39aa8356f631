// play: serves the live page on this machine and opens it: draw over objects, hear their materials
import { spawn } from 'node:child_process';
import path from 'node:path';
import { CommandError, parsed, runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';
import { buildEngine, hasBuiltEngine, pageFolder, stagePage } from './lib/web_build.mjs';
import { serveFolder } from './lib/static_server.mjs';

const help = `usage: ./run play [--port NUMBER] [--no-open] [--rebuild]

Builds the engine for browsers where it is missing (as \`npm run build:web\` does), puts the page together in Web/dist/page,
serves it on the loopback address with the headers for shared memory, prints the address and opens it. Ctrl+C ends it.

  --port NUMBER  a fixed port; a free one is taken unless given
  --no-open      prints the address only
  --rebuild      builds the engine anew`;

/** @param {string[]} words */
export function optionsOf(words) {
  const { values } = parsed(words, { port: { type: 'string', default: '0' }, 'no-open': { type: 'boolean', default: false }, rebuild: { type: 'boolean', default: false } });
  const port = Number(values.port);
  if (!/^\d+$/.test(values.port) || port > 65535) throw new CommandError(`--port ${values.port}: expected 1 to 65535`, 2);
  return { port, opens: !values['no-open'], rebuilds: values.rebuild };
}

function openBrowser(/** @type {string} */ address) {
  const [command, ...first] = { darwin: ['open'], win32: ['cmd', '/c', 'start', ''] }[/** @type {'darwin'} */ (process.platform)] ?? ['xdg-open'];
  // Without a browser the printed address is enough.
  spawn(command, [...first, address], { stdio: 'ignore', detached: true }).on('error', () => {}).unref();
}

if (process.argv[1] && path.basename(process.argv[1]) === 'play.mjs') {
  await runMain('play', async (words) => {
    const { port, opens, rebuilds } = optionsOf(words);
    if (rebuilds || !hasBuiltEngine()) {
      await setUp(['build', 'web']);
      await buildEngine();
    }
    stagePage();
    const { address } = await serveFolder({ folder: pageFolder(), port });
    console.log(`play: ${address}\nplay: draw over the objects with mouse, pen, finger or keys. Ctrl+C ends it.`);
    if (opens) openBrowser(address);
  }, { help });
}
