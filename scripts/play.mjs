// play: serves the live page on this machine and opens it: draw over objects, hear their materials
import { spawn } from 'node:child_process';
import path from 'node:path';
import { CommandError, runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';
import { buildEngine, hasBuiltEngine, pageFolder, stagePage } from './web/build.mjs';
import { serveFolder } from './web/static_server.mjs';

const help = `usage: ./run play [--port NUMBER] [--no-open] [--rebuild]

Builds the engine for browsers where it is missing (as \`npm run build:web\` does), puts the page together in Web/dist/page,
serves it on the loopback address with the headers for shared memory, prints the address and opens it. Ctrl+C ends it.

  --port NUMBER  a fixed port; a free one is taken unless given
  --no-open      prints the address only
  --rebuild      builds the engine anew`;

/** @param {string[]} words */
export function optionsOf(words) {
  const options = { port: 0, opens: true, rebuilds: false };
  for (let at = 0; at < words.length; at += 1) {
    if (words[at] === '--no-open') options.opens = false;
    else if (words[at] === '--rebuild') options.rebuilds = true;
    else if (words[at] === '--port') {
      at += 1;
      options.port = Number(words[at]);
      if (!/^\d+$/.test(words[at] ?? '') || options.port < 1 || options.port > 65535) throw new CommandError('--port takes a number from 1 to 65535', 2);
    } else throw new CommandError(`"${words[at]}" is not an argument: \`./run play --help\` lists them`, 2);
  }
  return options;
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
