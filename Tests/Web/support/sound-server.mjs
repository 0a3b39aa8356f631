import { execFileSync, spawn, spawnSync } from 'node:child_process';
import { mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';

const pause = (/** @type {number} */ milliseconds) => new Promise((resolve) => {
  setTimeout(resolve, milliseconds);
});

/** False skips what needs a sound server. */
export const hasSoundServer = spawnSync('pulseaudio', ['--version']).status === 0 && spawnSync('pactl', ['--version']).status === 0;

/** A sound server of its own with one silent output, which can be taken away. */
export async function startSoundServer() {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-sound-'));
  const environment = { XDG_RUNTIME_DIR: folder, PULSE_RUNTIME_PATH: path.join(folder, 'pulse'), PULSE_SERVER: `unix:${path.join(folder, 'pulse', 'native')}`, HOME: folder };
  const env = { ...process.env, ...environment };
  const server = spawn('pulseaudio', ['-n', '--daemonize=no', '--exit-idle-time=-1', '-L', 'module-native-protocol-unix'], { env, stdio: 'ignore' });
  const control = (/** @type {string[]} */ ...words) => execFileSync('pactl', words, { env, encoding: 'utf8', stdio: ['ignore', 'pipe', 'ignore'] }).trim();
  for (let attempt = 0; ; attempt += 1) {
    await pause(100);
    try {
      control('info');
      break;
    } catch (error) {
      if (attempt === 50) throw error;
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
    close: async () => {
      const ended = new Promise((resolve) => {
        server.once('exit', resolve);
      });
      server.kill();
      await ended;
      rmSync(folder, { recursive: true, force: true });
    },
  };
}
