import { spawn, spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { parseArgs } from 'node:util';

/** Absolute path of the repository's root folder. */
export const repositoryRoot = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..', '..');

/** Absolute path of something in the repository. */
export const inRepository = (...parts) => path.join(repositoryRoot, ...parts);

/** Absolute path of the command line program of a release build. */
export const commandLinePath = () => inRepository('build', 'native', process.platform === 'win32' ? 'haptoflow.exe' : 'haptoflow');

/** The folder in which npm or ./run was typed. Paths in arguments are relative to it, though npm runs scripts in the root. */
export const callerFolder = () => path.resolve(process.env.INIT_CWD || process.cwd());

/** An error that is shown by its message alone, without a stack. */
export class CommandError extends Error {
  /** @param {string} message what went wrong and what to do  @param {number} exitCode 1 failed, 2 cannot start */
  constructor(message, exitCode = 1) {
    super(message);
    this.exitCode = exitCode;
  }
}

/**
 * Runs a child to its end with this process's output and no input.
 * @param {string} command @param {string[]} args
 * @param {{env?: Record<string, string>, cwd?: string, quiet?: boolean, shell?: boolean, limitSeconds?: number}} options
 *   cwd: working folder, by default the repository's root; quiet: collect the output instead of showing it;
 *   limitSeconds: a child that takes longer is killed and counts as failed
 * @returns {Promise<{exitCode: number, output: string}>} output is empty unless quiet
 */
export function run(command, args, options = {}) {
  const unknown = Object.keys(options).filter((name) => !['env', 'cwd', 'quiet', 'shell', 'limitSeconds'].includes(name));
  if (unknown.length > 0) throw new TypeError(`run: unknown options ${unknown.join(', ')}`);
  return new Promise((resolve, reject) => {
    // Taken before the child starts, since its limit counts from the start. The comparison below allows a timer that is early.
    const begin = performance.now();
    const child = spawn(command, args, {
      cwd: options.cwd ?? repositoryRoot,
      env: { ...process.env, ...options.env },
      stdio: ['ignore', options.quiet ? 'pipe' : 'inherit', options.quiet ? 'pipe' : 'inherit'],
      shell: options.shell ?? false,
      timeout: options.limitSeconds === undefined ? undefined : 1000 * options.limitSeconds,
      killSignal: 'SIGKILL',
    });
    const chunks = [];
    child.stdout?.on('data', (chunk) => chunks.push(chunk));
    child.stderr?.on('data', (chunk) => chunks.push(chunk));
    child.on('error', (error) =>
      reject(new CommandError(`cannot start \`${command}\`: ${error.code === 'ENOENT' ? 'it is not installed' : error.message}`, 2)),
    );
    child.on('close', (code, signal) => {
      const overdue = signal === 'SIGKILL' && performance.now() - begin > 990 * (options.limitSeconds ?? Infinity);
      const ending = overdue ? `ended after ${options.limitSeconds} s: it hangs, or the machine is very slow` : `ended by ${signal}`;
      if (signal && !options.quiet) console.error(`${command}: ${ending}`);
      const output = Buffer.concat(chunks).toString('utf8');
      resolve({ exitCode: code ?? 1, output: signal ? `${output}\n${ending}` : output });
    });
  });
}

/** Like `run`, but a non-zero exit is a CommandError that shows the command and, when quiet, its output. */
export async function runOrFail(command, args, options = {}) {
  const { exitCode, output } = await run(command, args, options);
  if (exitCode !== 0) {
    const shown = [command, ...args].map((word) => (/^[\w./=:@%+~,-]+$/.test(word) ? word : `'${word}'`)).join(' ');
    throw new CommandError(`${output.trimEnd()}${output ? '\n' : ''}\`${shown}\` ended with ${exitCode}`);
  }
  return output;
}

/**
 * Runs npm: the one that runs this script, else the one on PATH. Its output is collected. A failure shows the reason and a
 * remedy, even below an npm that runs with --silent.
 */
export async function runNpmOrFail(words) {
  const underNpm = process.env.npm_execpath;
  const [command, args] = underNpm ? [process.execPath, [underNpm, ...words]] : ['npm', words];
  // A newcomer's npm would add a notice of newer versions to what a caller parses.
  const env = { npm_config_loglevel: 'error', npm_config_fetch_retries: '1', npm_config_update_notifier: 'false' };
  const { exitCode, output } = await run(command, args, { quiet: true, env, shell: !underNpm && process.platform === 'win32' });
  if (exitCode !== 0) throw new CommandError(npmComplaint(words, exitCode, output));
  return output;
}

/** The message for a failed npm: its own output, and a remedy. */
export function npmComplaint(words, exitCode, output) {
  const cannotReach = /\b(ENOTFOUND|EAI_AGAIN|ECONNREFUSED|ECONNRESET|ETIMEDOUT|ENETUNREACH|EHOSTUNREACH|ERR_SOCKET_TIMEOUT|CERT|certificate)/i.test(output);
  const remedy = cannotReach
    ? 'npm\'s registry cannot be reached: check the network, and behind a proxy `npm config set proxy` and NODE_EXTRA_CA_CERTS; `npm config get registry` says which registry is used'
    : `\`npm ${words.join(' ')} --loglevel=verbose\` says more`;
  return [output.trimEnd() || 'npm printed nothing', `\`npm ${words[0]}\` ended with ${exitCode}: ${remedy}`].join('\n');
}

/** True when `command args` starts and ends with 0. */
export function succeeds(command, args) {
  const result = spawnSync(command, args, { stdio: 'ignore' });
  return result.error === undefined && result.status === 0;
}

/**
 * Runs a script's main function; a CommandError ends the process with its message alone. `--help` shows the script's help
 * and does nothing else.
 * @param {string} name @param {(words: string[]) => Promise<number | void>} main
 * @param {{help?: string, takesWords?: boolean}} options help: below the usage line, in place of the script's first line;
 *   takesWords: false refuses words that the script does not know
 */
export async function runMain(name, main, { help, takesWords = true } = {}) {
  const words = process.argv.slice(2);
  try {
    if (words.includes('--help') || words.includes('-h')) {
      console.log(help ?? `usage: ./run ${name}${takesWords ? ' [ARGUMENTS]' : ''}\n\n${firstLineOf(process.argv[1])}`);
      return;
    }
    if (!takesWords && words.length > 0) throw new CommandError(`"${words[0]}" is not an argument: \`./run ${name}\` takes no arguments`, 2);
    process.exitCode = (await main(words)) ?? 0;
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    console.error(`${name}: ${error.message}`);
    process.exitCode = error.exitCode;
  }
}

/**
 * The options among a script's words, and what else they are. A CommandError names what is no option.
 * @param {string[]} words @param {import('node:util').ParseArgsConfig['options']} options
 */
export function parsed(words, options, { allowPositionals = false } = {}) {
  try {
    return parseArgs({ args: words, options, allowPositionals });
  } catch (error) {
    throw new CommandError(error.message, 2);
  }
}

/** The description in a script's first line. */
function firstLineOf(file) {
  return readFileSync(file, 'utf8').split('\n', 1)[0].replace(/^\/\/ [\w:]+: /, '');
}
