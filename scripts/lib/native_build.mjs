import { existsSync, readFileSync } from 'node:fs';
import os from 'node:os';
import { CommandError, inRepository, runOrFail, succeeds } from './process.mjs';

/** The value of a variable in a CMakeCache.txt, null where it is not set. */
export function cachedVariable(cacheText, name) {
  return cacheText.match(new RegExp(`^${name}:[A-Z]+=(.*)$`, 'm'))?.[1] ?? null;
}

/**
 * Builds a preset. Configures it first where it is not configured, or is configured without the tests that `tests` requests.
 * @param {{preset?: string, tests?: boolean, targets?: string[]}} options targets: empty builds all
 */
export async function buildNative({ preset = 'release', tests = false, targets = [] } = {}) {
  const folder = presetFolder(preset);
  const cache = inRepository(folder, 'CMakeCache.txt');
  const cached = existsSync(cache) ? readFileSync(cache, 'utf8') : '';
  const configured = existsSync(inRepository(folder, 'build.ninja'));
  const hasTests = cachedVariable(cached, 'HAPTOFLOW_BUILD_TESTS') === 'ON';
  if (!configured || (tests && !hasTests)) {
    console.log(`build: configuring ${folder}`);
    await runOrFail('cmake', ['--preset', preset, `-DHAPTOFLOW_BUILD_TESTS=${tests ? 'ON' : 'OFF'}`, ...vcpkgFeatures(preset, tests)], { env: launchers(), quiet: true });
  }
  console.log(`build: ${targets.length > 0 ? targets.join(', ') : 'everything'} in ${folder}`);
  const targetArgs = targets.length > 0 ? ['--target', ...targets] : [];
  await runOrFail('cmake', ['--build', '--preset', preset, '-j', String(os.cpus().length), ...targetArgs], { quiet: !process.stdout.isTTY });
}

/** The option that makes vcpkg install the tests' libraries, for a preset whose libraries come from vcpkg. */
const vcpkgFeatures = (name, tests) => (tests && findPreset(name).toolchainFile?.includes('VCPKG_ROOT') ? ['-DVCPKG_MANIFEST_FEATURES=tests'] : []);

/** The compiler launcher: ccache where it is installed, unless CMake's own variables name another. */
export function launchers() {
  if (!succeeds('ccache', ['--version'])) return {};
  return { CMAKE_C_COMPILER_LAUNCHER: 'ccache', CMAKE_CXX_COMPILER_LAUNCHER: 'ccache', ...pick(process.env, 'CMAKE_C_COMPILER_LAUNCHER', 'CMAKE_CXX_COMPILER_LAUNCHER') };
}

const pick = (values, ...names) => Object.fromEntries(names.filter((name) => values[name] !== undefined).map((name) => [name, values[name]]));

function findPreset(preset) {
  const presets = JSON.parse(readFileSync(inRepository('CMakePresets.json'), 'utf8')).configurePresets;
  const found = presets.find((candidate) => candidate.name === preset && candidate.binaryDir);
  if (!found) throw new CommandError(`CMakePresets.json has no configure preset "${preset}" with a binaryDir`, 2);
  return found;
}

/** The build folder of a configure preset, relative to the repository. */
export const presetFolder = (preset) => findPreset(preset).binaryDir.replace('${sourceDir}/', '');
