import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { missingFromLock, missingPackages, selectPackages } from './packages.mjs';
import { CommandError, runNpmOrFail, runOrFail, succeeds } from './process.mjs';
import { inRepository } from './repository.mjs';

/**
 * Brings what a command needs and is not there, and says so: system packages (Debian), then npm packages.
 * @param {("build"|"test"|"platforms"|"python"|"lint")[]} purposes
 * @throws CommandError with exit code 2 and one command to type where this process may not install.
 */
export async function setUp(purposes) {
  await installSystemPackages(purposes);
  await installNodePackages();
}

async function installSystemPackages(purposes) {
  if (!existsSync('/etc/debian_version') || !succeeds('dpkg-query', ['--version'])) {
    checkForeignSystem(purposes);
    return;
  }
  const wanted = selectPackages(purposes);
  const query = spawnSync('dpkg-query', ['-W', '-f', '${Package} ${db:Status-Status}\\n', ...wanted], { encoding: 'utf8' });
  const missing = missingPackages(wanted, query.stdout ?? '');
  if (missing.length === 0) return;

  const asRoot = process.getuid() === 0 ? [] : ['sudo', '-n'];
  const install = ['apt-get', 'install', '-y', '-qq', '--no-install-recommends', ...missing];
  if (asRoot.length > 0 && !succeeds('sudo', ['-n', 'true'])) {
    throw new CommandError(
      `${missing.length} system packages are missing and installing them needs root. Run this once, then again what you ran:\n` +
        `  sudo apt-get update && sudo ${install.join(' ')}`,
      2,
    );
  }
  console.log(`setup: installing ${missing.length} system packages for ${purposes.join(' and ')}: ${missing.join(' ')}`);
  const [update, ...updateArgs] = [...asRoot, 'apt-get', 'update', '-qq'];
  await runOrFail(update, updateArgs, { quiet: true });
  const [command, ...args] = [...asRoot, 'env', 'DEBIAN_FRONTEND=noninteractive', ...install];
  await runOrFail(command, args, { quiet: true });
}

/** Elsewhere nothing is installed for you: say what is missing and which file lists it. */
function checkForeignSystem(purposes) {
  const wants = [];
  if (purposes.includes('build')) {
    for (const tool of ['cmake', 'ninja']) {
      if (!succeeds(tool, ['--version'])) {
        wants.push(`${tool} on PATH; the libraries are listed in vcpkg.json (set CMAKE_TOOLCHAIN_FILE to vcpkg's)`);
      }
    }
  }
  if (purposes.includes('lint') && !succeeds('clang-format', ['--version'])) wants.push('clang-format and clang-tidy on PATH');
  if (purposes.includes('python') && findPython() === null) {
    wants.push('Python 3.11 with the packages of Training/pyproject.toml (HAPTOFLOW_PYTHON names the interpreter)');
  }
  if (wants.length > 0) throw new CommandError(`this system is not Debian; please install:\n  ${wants.join('\n  ')}`, 2);
}

async function installNodePackages() {
  const lock = JSON.parse(readFileSync(inRepository('package-lock.json'), 'utf8'));
  const missing = missingFromLock(lock, (location) => {
    const manifest = inRepository(location, 'package.json');
    return existsSync(manifest) ? JSON.parse(readFileSync(manifest, 'utf8')).version : null;
  });
  if (missing.length === 0) return;
  console.log(`setup: npm ci (${missing.join(', ')})`);
  await runNpmOrFail(['ci']);
}

const pythonModules = 'import numpy, scipy, torch, onnx, pytest, xdist';

/**
 * The interpreter for training and its tests: HAPTOFLOW_PYTHON, else the system's own, else the one on PATH.
 * The system's own comes first because another python3 earlier on PATH lacks Debian's packages.
 * @returns {string | null}
 */
export function findPython() {
  const named = process.env.HAPTOFLOW_PYTHON;
  const candidates = named ? [named] : ['/usr/bin/python3', 'python3', 'python'];
  return candidates.find((candidate) => succeeds(candidate, ['-c', pythonModules])) ?? null;
}

/** `findPython`, or a CommandError that says what is missing. */
export function pythonOrFail() {
  const python = findPython();
  if (python) return python;
  const subject = process.env.HAPTOFLOW_PYTHON ? `HAPTOFLOW_PYTHON=${process.env.HAPTOFLOW_PYTHON}` : 'the system\'s Python';
  throw new CommandError(`${subject} cannot \`${pythonModules}\`: install the packages of Training/pyproject.toml`, 2);
}
