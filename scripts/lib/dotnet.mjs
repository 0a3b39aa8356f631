import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync } from 'node:fs';
import path from 'node:path';
import { offeredPackages } from './packages.mjs';
import { CommandError, run } from './process.mjs';
import { inRepository } from './repository.mjs';

const aptPackage = 'dotnet-sdk-10.0';
const script = 'https://dot.net/v1/dotnet-install.sh';

/** The folder into which set-up installs the SDK where no Debian package has it. */
export const dotnetFolder = () => inRepository('build', 'dotnet');

/**
 * The `dotnet` with SDK 10 that runs the C# tests: the one that set-up installed, else the one on PATH; null where neither
 * exists.
 * @param {{folder?: string, env?: NodeJS.ProcessEnv}} place
 */
export function findDotnet({ folder = dotnetFolder(), env = process.env } = {}) {
  const candidates = [path.join(folder, process.platform === 'win32' ? 'dotnet.exe' : 'dotnet'), 'dotnet'];
  return candidates.find((command) => {
    const listed = spawnSync(command, ['--list-sdks'], { encoding: 'utf8', env });
    return listed.status === 0 && /^10\./m.test(listed.stdout);
  }) ?? null;
}

/** `findDotnet`'s command; throws a CommandError with exit code 2 where there is none. */
export function dotnetOrFail() {
  const command = findDotnet();
  if (command === null) throw new CommandError('the C# tests need the .NET SDK 10, on PATH or in build/dotnet', 2);
  return command;
}

/** The environment for `dotnet`: programs started by it find an SDK outside the system's folders by DOTNET_ROOT only. */
export function dotnetEnvironment(dotnet) {
  const own = path.isAbsolute(dotnet) ? { DOTNET_ROOT: path.dirname(dotnet) } : {};
  return { ...own, DOTNET_CLI_TELEMETRY_OPTOUT: '1', DOTNET_NOLOGO: '1' };
}

/**
 * Installs the .NET SDK 10 where it is missing: with apt where apt offers it and this process may install, else with
 * Microsoft's install script into `folder`, without root.
 * @param {{folder?: string, env?: NodeJS.ProcessEnv, asRoot: string[] | null}} place asRoot: the words before apt-get,
 *   null where this process may not install
 * @returns {Promise<string>} the command
 * @throws CommandError with exit code 2 and one command to run where neither source can be reached
 */
export async function bringDotnet({ folder = dotnetFolder(), env = process.env, asRoot }) {
  const present = findDotnet({ folder, env });
  if (present) return present;
  const reasons = [await installFromApt(env, asRoot), await installFromScript(folder, env)];
  const brought = findDotnet({ folder, env });
  if (brought) return brought;
  throw new CommandError(
    `the .NET SDK 10 could not be installed (${reasons.filter(Boolean).join('; ')}); where the network allows it, run this, ` +
      `then again what you ran: curl -fsSL ${script} | bash -s -- --channel 10.0 --install-dir ${folder}`,
    2,
  );
}

/** Null on success, else the reason for the failure. */
async function installFromApt(env, asRoot) {
  const policy = spawnSync('apt-cache', ['policy', aptPackage], { encoding: 'utf8', env: { ...env, LC_ALL: 'C' } });
  if (offeredPackages([aptPackage], policy.stdout ?? '').length === 0) return `apt has no ${aptPackage}`;
  if (asRoot === null) return `installing ${aptPackage} needs root`;
  console.log(`setup: installing ${aptPackage}`);
  const [command, ...args] = [...asRoot, 'apt-get', 'install', '-y', '-qq', '--no-install-recommends', aptPackage];
  const { exitCode, output } = await run(command, args, { env, quiet: true });
  return exitCode === 0 ? null : `apt-get ended with ${exitCode}: ${lastLine(output)}`;
}

async function installFromScript(folder, env) {
  if (findDotnet({ folder, env })) return null;
  if (process.platform === 'win32') return 'the install script is for POSIX systems';
  mkdirSync(folder, { recursive: true });
  const file = path.join(folder, 'dotnet-install.sh');
  try {
    const fetched = await run('curl', ['-fsSL', '--retry', '2', '--connect-timeout', '20', '-o', file, script], { env, quiet: true });
    if (fetched.exitCode !== 0 || !existsSync(file)) return `Microsoft's install script cannot be fetched: ${lastLine(fetched.output)}`;
    console.log(`setup: bringing the .NET SDK 10 into ${folder} by Microsoft's install script`);
    const installed = await run('bash', [file, '--channel', '10.0', '--install-dir', folder, '--no-path'], { env, quiet: true });
    return installed.exitCode === 0 ? null : `Microsoft's install script ended with ${installed.exitCode}: ${lastLine(installed.output)}`;
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    return error.message;
  }
}

const lastLine = (output) => output.trim().split('\n').at(-1) ?? '';
