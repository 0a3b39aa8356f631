import { spawnSync } from 'node:child_process';
import { existsSync, readFileSync } from 'node:fs';
import { missingFromLock, missingPackages, offeredPackages, optionalPurposes, selectPackages } from './packages.mjs';
import { CommandError, runNpmOrFail, runOrFail, succeeds } from './process.mjs';
import { inRepository } from './repository.mjs';

/**
 * Installs what a command needs and prints what it installs: system packages (Debian), then npm packages. The .NET SDK
 * is brought apart (dotnet.mjs), since most of the tests run without it.
 * @param {string[]} purposes of packages.mjs
 * @returns {Promise<string[]>} a sentence for each optional purpose that is skipped (see optionalPurposes)
 * @throws CommandError with exit code 2 and one command to type where this process may not install.
 */
export async function setUp(purposes) {
  const leftOut = await installSystemPackages(purposes);
  await installNodePackages();
  leftOut.forEach((sentence) => console.log(`setup: ${sentence}`));
  return leftOut;
}

/** The words that run a command as root: none for root itself, null where this process cannot become root. */
export function rootCommand() {
  if (process.getuid?.() === 0) return [];
  return succeeds('sudo', ['-n', 'true']) ? ['sudo', '-n'] : null;
}

const installWords = (packages) => ['apt-get', 'install', '-y', '-qq', '--no-install-recommends', ...packages];

function missingOf(wanted) {
  const query = spawnSync('dpkg-query', ['-W', '-f', '${Package} ${db:Status-Status}\\n', ...wanted], { encoding: 'utf8' });
  return missingPackages(wanted, query.stdout ?? '');
}

/** Whether this system's packages are Debian's, which set-up installs. */
export const onDebian = () => existsSync('/etc/debian_version') && succeeds('dpkg-query', ['--version']);

async function installSystemPackages(purposes) {
  if (!onDebian()) {
    checkForeignSystem(purposes);
    return purposes.filter((purpose) => optionalPurposes[purpose] && !succeeds(programOf(purpose), ['--version'])).map((purpose) => optionalPurposes[purpose]);
  }
  const optional = purposes.filter((purpose) => optionalPurposes[purpose]);
  const missing = missingOf(selectPackages(purposes.filter((purpose) => !optionalPurposes[purpose])));
  const asRoot = rootCommand();
  if (missing.length > 0) {
    if (asRoot === null) {
      throw new CommandError(
        `${missing.length} system packages are missing and installing them needs root. Run this once, then again what you ran:\n` +
          `  sudo apt-get update && sudo ${installWords(missing).join(' ')}`,
        2,
      );
    }
    console.log(`setup: installing ${missing.length} system packages for ${purposes.join(' and ')}: ${missing.join(' ')}`);
    await runApt(asRoot, ['apt-get', 'update', '-qq']);
    await runApt(asRoot, ['env', 'DEBIAN_FRONTEND=noninteractive', ...installWords(missing)]);
  }
  const leftOut = [];
  for (const purpose of optional) leftOut.push(await installOptional(purpose, asRoot));
  return leftOut.filter((sentence) => sentence !== null);
}

/** Installs the packages of an optional purpose. Null on success, else the sentence that says what is skipped. */
async function installOptional(purpose, asRoot) {
  const wanted = selectPackages([purpose]);
  const missing = missingOf(wanted);
  if (missing.length === 0) return null;
  const policy = spawnSync('apt-cache', ['policy', ...missing], { encoding: 'utf8', env: { ...process.env, LC_ALL: 'C' } });
  const offered = offeredPackages(missing, policy.stdout ?? '');
  if (offered.length < missing.length) return optionalPurposes[purpose];
  if (asRoot === null) return `${optionalPurposes[purpose].split(':')[0]}: run sudo ${installWords(missing).join(' ')}`;
  console.log(`setup: installing ${missing.join(' ')}`);
  await runApt(asRoot, ['env', 'DEBIAN_FRONTEND=noninteractive', ...installWords(missing)]);
  return null;
}

async function runApt(asRoot, words) {
  const [command, ...args] = [...asRoot, ...words];
  try {
    await runOrFail(command, args, { quiet: true });
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    throw new CommandError(`${error.message}\nThe system packages could not be installed: check the network and the sources of apt (sudo apt-get update)`, 2);
  }
}

/** The program whose presence stands for a purpose on systems without apt. */
const programOf = (purpose) => ({ libcxx: 'clang++-16', realtime: 'clang++-22', mono: 'mono', web: 'emcc', browser: 'chromium', browsers: 'firefox-esr' })[purpose];

/** On other systems nothing is installed: names what is missing, and the file that lists it. */
function checkForeignSystem(purposes) {
  const wants = [];
  if (purposes.includes('build')) {
    for (const tool of ['cmake', 'ninja']) {
      if (!succeeds(tool, ['--version'])) {
        wants.push(`${tool} on PATH; the libraries are listed in vcpkg.json (set CMAKE_TOOLCHAIN_FILE to vcpkg's)`);
      }
    }
  }
  if (purposes.includes('files') && !succeeds('git', ['--version'])) wants.push('git on PATH');
  if (purposes.includes('lint') && !succeeds('clang-format', ['--version'])) wants.push('clang-format and clang-tidy on PATH');
  if (purposes.includes('python') && findPython() === null) {
    wants.push('Python 3.11 with the packages of Training/pyproject.toml (HAPTOFLOW_PYTHON names the interpreter)');
  }
  if (purposes.includes('drawings') && findPython(drawingModules) === null) {
    wants.push('Python 3 with numpy, scipy and matplotlib (HAPTOFLOW_PYTHON names the interpreter)');
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

const trainingModules = 'import numpy, scipy, torch, onnx, pytest, xdist';

/** What the demo draws its page with. */
export const drawingModules = 'import numpy, scipy, matplotlib';

/**
 * The interpreter that has modules, by default those of training and its tests: HAPTOFLOW_PYTHON, else the system's own, else the one on PATH.
 * The system's own comes first because another python3 earlier on PATH lacks Debian's packages.
 * @returns {string | null}
 */
export function findPython(modules = trainingModules) {
  const named = process.env.HAPTOFLOW_PYTHON;
  const candidates = named ? [named] : ['/usr/bin/python3', 'python3', 'python'];
  return candidates.find((candidate) => succeeds(candidate, ['-c', modules])) ?? null;
}

/** `findPython`, or a CommandError that says what is missing. */
export function pythonOrFail(modules = trainingModules) {
  const python = findPython(modules);
  if (python) return python;
  const subject = process.env.HAPTOFLOW_PYTHON ? `HAPTOFLOW_PYTHON=${process.env.HAPTOFLOW_PYTHON}` : 'the system\'s Python';
  throw new CommandError(`${subject} cannot \`${modules}\`: install the packages of Training/pyproject.toml`, 2);
}
