import { spawn } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';

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
