import { execFileSync, spawnSync } from 'node:child_process';
import { pause } from '../../../Web/engine/js/pause.mjs';
import { startProgram } from './programs.mjs';

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
