import { pause } from '../../../Web/engine/js/pause.mjs';
import { pageFolder, stagePage } from '../../../scripts/web/build.mjs';
import { chromiumPath } from '../../../scripts/web/chromium.mjs';
import { startProgram } from './programs.mjs';
import { serve } from './server.mjs';

// Chromium without Playwright, which keeps every page visible and focused: here a tab behind another one is hidden, as a user's is.

/** Talks to a browser by its pipe: one JSON text after the other, each ended by a zero. */
function talkBy(/** @type {import('node:child_process').ChildProcess} */ child) {
  const [, , , into, from] = /** @type {any[]} */ (child.stdio);
  /** @type {Map<number, {resolve: (result: any) => void, reject: (error: Error) => void}>} */
  const waiting = new Map();
  let rest = '';
  from.on('data', (/** @type {Buffer} */ bytes) => {
    const texts = (rest + bytes).split('\0');
    rest = texts.pop() ?? '';
    for (const { id, result, error } of texts.map((text) => JSON.parse(text))) {
      if (error) waiting.get(id)?.reject(new Error(error.message));
      else waiting.get(id)?.resolve(result);
      waiting.delete(id);
    }
  });
  return (/** @type {string} */ method, /** @type {object} */ params = {}, /** @type {string | undefined} */ sessionId = undefined) => new Promise((resolve, reject) => {
    const id = waiting.size === 0 ? 1 : Math.max(...waiting.keys()) + 1;
    waiting.set(id, { resolve, reject });
    into.write(`${JSON.stringify({ id, method, params, sessionId })}\0`);
  });
}

/**
 * The live page in a tab of its own. @param {Record<string, string>} [environment] of the browser
 * @returns what tests do with it; `inPage` takes an expression, which may be a promise
 */
export async function openBarePage(environment = {}) {
  stagePage();
  const server = await serve({ folders: { somewhere: pageFolder() } });
  const words = ['--headless=new', '--no-sandbox', '--disable-gpu', '--no-first-run', '--autoplay-policy=no-user-gesture-required', '--remote-debugging-pipe'];
  const program = startProgram(
    (home) => [/** @type {string} */ (chromiumPath), ...words, `--user-data-dir=${home}`, 'about:blank'],
    { environment, stdio: ['ignore', 'ignore', 'ignore', 'pipe', 'pipe'] },
  );
  const close = async () => {
    await server.close();
    await program.end();
  };
  const ask = talkBy(program.child);
  const { targetId } = await ask('Target.createTarget', { url: `${server.address}/somewhere/index.html` });
  const { sessionId } = await ask('Target.attachToTarget', { targetId, flatten: true });
  const inPage = async (/** @type {string} */ expression) => {
    const { result, exceptionDetails } = await ask('Runtime.evaluate', { expression, awaitPromise: true, returnByValue: true }, sessionId);
    if (exceptionDetails) throw new Error(exceptionDetails.exception.description);
    return result.value;
  };
  /** Waits until an expression holds. */
  const until = async (/** @type {string} */ expression, seconds = 15) => {
    for (const end = Date.now() + 1000 * seconds; Date.now() < end; await pause(50)) {
      // While a page loads there is nobody to ask.
      if (await inPage(`Boolean(${expression})`).catch(() => false)) return;
    }
    throw new Error(`${expression}: not within ${seconds} s`);
  };
  try {
    await until("'haptoflowPage' in globalThis", 30);
  } catch (error) {
    await close();
    throw error;
  }
  return {
    inPage,
    until,
    hide: () => ask('Target.createTarget', { url: 'about:blank' }),
    show: () => ask('Target.activateTarget', { targetId }),
    close,
  };
}
