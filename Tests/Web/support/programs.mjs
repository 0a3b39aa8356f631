import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { pause } from '../../../Web/engine/js/pause.mjs';
import { chromiumPath } from '../../../scripts/lib/chromium.mjs';
import { stagedPage } from './browser.mjs';
import { serve } from './server.mjs';

/**
 * Starts a program with a home of its own. It and all that it starts end with `end`, and with this process.
 * @param {(home: string) => string[]} words
 * @param {{environment?: Record<string, string>, stdio?: import('node:child_process').StdioOptions}} [options]
 */
export function startProgram(words, { environment = {}, stdio = 'ignore' } = {}) {
  const home = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-home-'));
  const [command, ...rest] = words(home);
  const child = spawn(command, rest, { stdio, detached: true, env: { ...process.env, HOME: home, ...environment } });
  const ended = new Promise((resolve) => {
    child.once('exit', resolve);
    child.once('error', resolve);
  });
  const kill = () => {
    try {
      process.kill(-(/** @type {number} */ (child.pid)), 'SIGKILL');
    } catch {
      // It has ended by itself.
    }
  };
  process.once('exit', kill);
  child.unref();
  return {
    child,
    home,
    end: async () => {
      child.ref();
      kill();
      await ended;
      process.removeListener('exit', kill);
      // Its own children may still be writing.
      rmSync(home, { recursive: true, force: true, maxRetries: 20, retryDelay: 100 });
    },
  };
}

/** False skips what needs a sound server. */
export const hasSoundServer = spawnSync('pulseaudio', ['--version']).status === 0 && spawnSync('pactl', ['--version']).status === 0;

/** Starts a PulseAudio server with one silent output, which a test unplugs and plugs in again. `environment` leads programs to it. */
export async function startSoundServer() {
  const program = startProgram((home) => ['env', `XDG_RUNTIME_DIR=${home}`, 'pulseaudio', '-n', '--daemonize=no', '--exit-idle-time=-1', '-L', `module-native-protocol-unix socket=${home}/native`]);
  const environment = { PULSE_SERVER: `unix:${program.home}/native` };
  const env = { ...process.env, ...environment, HOME: program.home };
  const control = (/** @type {string[]} */ ...words) => execFileSync('pactl', words, { env, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'], timeout: 5000 }).trim();
  for (let attempt = 0; ; attempt += 1) {
    await pause(100);
    try {
      control('info');
      break;
    } catch (error) {
      if (attempt < 50) continue;
      await program.end();
      throw error;
    }
  }
  const plug = () => control('load-module', 'module-null-sink', 'rate=48000');
  let output = plug();
  return {
    environment,
    unplug: () => control('unload-module', output),
    plug: () => {
      output = plug();
    },
    /** Streams that play now. */
    streams: () => control('list', 'short', 'sink-inputs').split('\n').filter((line) => line !== '').length,
    close: () => program.end(),
  };
}

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
  const server = await serve({ folders: { somewhere: stagedPage() } });
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
