import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { CommandError, inRepository, run, runNpmOrFail, runOrFail, succeeds } from './process.mjs';

/** Debian packages by purpose. A command names its purposes, so that the demo needs neither PyTorch nor GoogleTest. */
export const packagesByPurpose = {
  build: [
    'cmake', 'ninja-build', 'g++', 'pkg-config', 'libglm-dev', 'nlohmann-json3-dev', 'libcli11-dev', 'libsndfile1-dev',
    'liblodepng-dev',
  ],
  // ccache makes every build after the first one short.
  test: ['ccache', 'libgtest-dev', 'libgmock-dev', 'libkissfft-dev', 'binutils'],
  libcxx: ['clang-16', 'libc++-16-dev', 'libc++abi-16-dev'],
  realtime: ['clang-22', 'libclang-rt-22-dev'],
  python: [
    'python3', 'python3-torch', 'python3-onnx', 'python3-numpy', 'python3-scipy', 'python3-pandas', 'python3-matplotlib',
    'python3-tqdm', 'python3-pytest', 'python3-pytest-xdist', 'python3-openpyxl', 'libopenblas0-pthread',
  ],
  // What the demo draws its page with.
  drawings: ['python3-matplotlib', 'python3-scipy'],
  // The compilers for Windows x64 and Linux arm64.
  cross: ['g++-mingw-w64-x86-64-posix', 'binutils-mingw-w64-x86-64', 'g++-aarch64-linux-gnu'],
  // What the tests of those libraries need besides; debootstrap makes the system with an older C library.
  platforms: ['wine', 'wine64', 'qemu-user', 'googletest', 'debootstrap'],
  // The compiler for browsers, and the browser of its tests.
  web: ['emscripten'],
  browser: ['chromium', 'pulseaudio', 'pulseaudio-utils'],
  // Firefox and the MiniBrowser of WebKitGTK, for the long tests. MiniBrowser draws into a window, so that it needs an X server.
  browsers: [
    'firefox-esr', 'libwebkit2gtk-4.1-0', 'gstreamer1.0-plugins-base', 'gstreamer1.0-plugins-good', 'gstreamer1.0-pulseaudio', 'xvfb', 'xauth',
  ],
  // Libraries that the SDK needs, and curl for Microsoft's install script: see dotnet.mjs.
  dotnet: ['ca-certificates', 'curl', 'libicu-dev'],
  // mono-devel has the facades of .NET Standard.
  mono: ['mono-runtime', 'mono-devel'],
  // The font of the charts that the C# tests draw.
  pictures: ['fonts-inter'],
  // git lists the files that belong to the project.
  files: ['git'],
  lint: ['git', 'clang-format', 'clang-tidy', 'python3', 'shellcheck'],
};

/**
 * Purposes whose packages some releases of Debian lack, with the sentence that says what is skipped there and where to get
 * the packages. The packages of every other purpose are required.
 */
export const optionalPurposes = {
  libcxx:
    'The build with Clang\'s library is left out: it needs Clang 16, which this system\'s packages do not have. Debian 12 ' +
    'and Ubuntu 24.04 have it (clang-16, libc++-16-dev, libc++abi-16-dev)',
  realtime:
    'RealtimeSanitizer is left out: it needs Clang 22, which this system\'s packages do not have. Debian 12 has it in ' +
    'bookworm-security (clang-22, libclang-rt-22-dev); elsewhere the packages of apt.llvm.org bring it',
  web:
    'The engine for browsers is left out: it needs Emscripten, which this system\'s packages do not have. Debian 12 has it ' +
    '(emscripten); elsewhere https://emscripten.org brings it',
  browser:
    'The part of the web\'s tests in a browser is left out: it needs Chromium, and PulseAudio to unplug a sound device, which this system\'s ' +
    'packages do not have. Debian 12 has them (chromium, pulseaudio, pulseaudio-utils); HAPTOFLOW_CHROMIUM names another Chromium',
  browsers:
    'The part of the web\'s tests in Firefox and WebKit is left out: it needs both, which this system\'s packages do not have. Debian 12 has them ' +
    '(firefox-esr; libwebkit2gtk-4.1-0 with gstreamer1.0-plugins-base, gstreamer1.0-plugins-good, gstreamer1.0-pulseaudio, xvfb and xauth)',
  mono:
    'The run under Mono is left out: it needs Mono 6.8, which this system\'s packages do not have. Debian 12 and Ubuntu ' +
    '24.04 have it (mono-runtime, mono-devel)',
};

/** Every package of the purposes, each once, in order. Throws RangeError for a purpose that does not exist. */
export function selectPackages(purposes) {
  const selected = new Set();
  for (const purpose of purposes) {
    const packages = packagesByPurpose[purpose];
    if (!packages) throw new RangeError(`no packages are known for the purpose "${purpose}"`);
    packages.forEach((name) => selected.add(name));
  }
  return [...selected];
}

/** The packages of `wanted` that are not installed, by the output of `dpkg-query -W -f '${Package} ${db:Status-Status}\n'`. */
export function missingPackages(wanted, dpkgOutput) {
  const installed = new Set(
    dpkgOutput
      .split('\n')
      .map((line) => line.trim().split(' '))
      .filter(([, status]) => status === 'installed')
      .map(([name]) => name),
  );
  return wanted.filter((name) => !installed.has(name));
}

/** The packages of `wanted` that apt can install, by the output of `apt-cache policy ...`. */
export function offeredPackages(wanted, policyOutput) {
  const offered = new Set([...policyOutput.matchAll(/^(\S+):\n(?: {2}.*\n)*? {2}Candidate: (?!\(none\))\S/gm)].map(([, name]) => name));
  return wanted.filter((name) => offered.has(name));
}

/**
 * The entries of a package-lock.json (version 3) that node_modules lacks or has in another version.
 * @param {object} lock parsed lock file
 * @param {(location: string) => string | null} installedVersion version of the package at a location, null where none is
 * @returns {string[]} locations, for example "node_modules/marked"
 */
export function missingFromLock(lock, installedVersion) {
  return Object.entries(lock.packages)
    .filter(([location]) => location.startsWith('node_modules/'))
    .filter(([location, entry]) => {
      const expected = entry.link ? lock.packages[entry.resolved]?.version : entry.version;
      return !entry.optional && installedVersion(location) !== expected;
    })
    .map(([location]) => location);
}

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

/** @throws CommandError as `setUp`, without installing anything */
export function requireInstallable(purposes) {
  if (!onDebian()) return checkForeignSystem(purposes);
  const missing = requiredAndMissing(purposes);
  if (missing.length > 0 && rootCommand() === null) {
    throw new CommandError(
      `${missing.length} system packages are missing and installing them needs root. Run this once, then again what you ran:\n` +
        `  sudo apt-get update && sudo ${installWords(missing).join(' ')}`,
      2,
    );
  }
}

const requiredAndMissing = (purposes) => missingOf(selectPackages(purposes.filter((purpose) => !optionalPurposes[purpose])));

async function installSystemPackages(purposes) {
  requireInstallable(purposes);
  if (!onDebian()) {
    return purposes.filter((purpose) => optionalPurposes[purpose] && !succeeds(programOf(purpose), ['--version'])).map((purpose) => optionalPurposes[purpose]);
  }
  const missing = requiredAndMissing(purposes);
  const asRoot = rootCommand();
  if (missing.length > 0) await runApt(asRoot, ['apt-get', 'update', '-qq']);
  const { wanted, leftOut } = optionalPackages(purposes, asRoot);
  const all = [...new Set([...missing, ...wanted])];
  if (all.length > 0) {
    console.log(`setup: installing ${all.length} system packages for ${purposes.join(' and ')}: ${all.join(' ')}`);
    await runApt(asRoot, ['env', 'DEBIAN_FRONTEND=noninteractive', ...installWords(all)]);
  }
  return leftOut;
}

/** The packages of optional purposes that are missing and that apt offers, and a sentence for each purpose that is skipped. */
function optionalPackages(purposes, asRoot) {
  const wanted = [];
  const leftOut = [];
  for (const purpose of purposes.filter((each) => optionalPurposes[each])) {
    const missing = missingOf(selectPackages([purpose]));
    if (missing.length === 0) continue;
    const policy = spawnSync('apt-cache', ['policy', ...missing], { encoding: 'utf8', env: { ...process.env, LC_ALL: 'C' } });
    if (offeredPackages(missing, policy.stdout ?? '').length < missing.length) leftOut.push(optionalPurposes[purpose]);
    else if (asRoot === null) leftOut.push(`${optionalPurposes[purpose].split(':')[0]}: run sudo ${installWords(missing).join(' ')}`);
    else wanted.push(...missing);
  }
  return { wanted, leftOut };
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

/** The environment of the training's programs. */
export const trainingEnvironment = () => ({ PYTHONPATH: inRepository('Training'), OPENBLAS_NUM_THREADS: '1', PYTHONDONTWRITEBYTECODE: '1' });

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
