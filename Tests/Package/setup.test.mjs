import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { missingFromLock, missingPackages, offeredPackages, optionalPurposes, packagesByPurpose, selectPackages } from '../../scripts/lib/setup.mjs';
import { cachedVariable } from '../../scripts/lib/native_build.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { runners } from '../../scripts/lib/test_runners.mjs';

test('the demo installs no PyTorch, no test library and no cross compiler', () => {
  for (const name of selectPackages(['build', 'drawings'])) assert.doesNotMatch(name, /torch|gtest|mingw|aarch64|wine|clang/);
});

test('the packages of several purposes are joined, each package once', () => {
  const selected = selectPackages(['python', 'lint']);
  assert.equal(new Set(selected).size, selected.length);
  for (const name of [...packagesByPurpose.python, ...packagesByPurpose.lint]) assert.ok(selected.includes(name), name);
});

test('a purpose that does not exist is an error', () => {
  assert.throws(() => selectPackages(['tset']), /"tset"/);
});

test('only packages that dpkg does not list as installed are missing', () => {
  const listing = 'cmake installed\nninja-build config-files\n';
  assert.deepEqual(missingPackages(['cmake', 'ninja-build', 'g++'], listing), ['ninja-build', 'g++']);
});

test('npm packages are missing where absent or of another version than the lock says', () => {
  const lock = {
    packages: {
      '': { name: 'root' },
      'node_modules/a': { version: '1.0.0' },
      'node_modules/b': { version: '2.0.0' },
      'node_modules/linked': { resolved: 'Packages/linked', link: true },
      'node_modules/only-elsewhere': { version: '3.0.0', optional: true },
      'Packages/linked': { version: '0.1.0' },
    },
  };
  const installed = { 'node_modules/a': '1.0.0', 'node_modules/b': '1.9.0', 'node_modules/linked': '0.1.0' };
  assert.deepEqual(missingFromLock(lock, (location) => installed[location] ?? null), ['node_modules/b']);
  assert.deepEqual(missingFromLock(lock, () => null), ['node_modules/a', 'node_modules/b', 'node_modules/linked']);
});

test('a CMake cache variable is read by its exact name', () => {
  const cache = 'HAPTOFLOW_BUILD_TESTS_EXTRA:BOOL=OFF\nHAPTOFLOW_BUILD_TESTS:BOOL=ON\n';
  assert.equal(cachedVariable(cache, 'HAPTOFLOW_BUILD_TESTS'), 'ON');
  assert.equal(cachedVariable('', 'HAPTOFLOW_BUILD_TESTS'), null);
});

test('the lock file names no host and pins every development package to one version', () => {
  const lock = JSON.parse(readFileSync(inRepository('package-lock.json'), 'utf8'));
  // Where an author takes donations is no host that packages come from.
  for (const each of Object.values(lock.packages)) delete each.funding;
  assert.doesNotMatch(JSON.stringify(lock), /https?:/);
  const { devDependencies } = JSON.parse(readFileSync(inRepository('package.json'), 'utf8'));
  for (const [name, version] of Object.entries(devDependencies)) assert.match(version, /^\d+\.\d+\.\d+$/, name);
});

test('a package is offered where apt names a candidate version', () => {
  const policy = [
    'clang-22:', '  Installed: (none)', '  Candidate: 1:22.1.8-1~deb12u1', '  Version table:', '     1:22.1.8 500',
    'libclang-rt-22-dev:', '  Installed: (none)', '  Candidate: (none)', '  Version table:',
    'git:', '  Installed: 1:2.39', '  Candidate: 1:2.39', '',
  ].join('\n');
  assert.deepEqual(offeredPackages(['clang-22', 'libclang-rt-22-dev', 'git', 'unknown'], policy), ['clang-22', 'git']);
  assert.deepEqual(offeredPackages(['git'], ''), []);
});

test('every package of the lock file runs on the Node that the README asks for', () => {
  const [, oldest] = readFileSync(inRepository('README.md'), 'utf8').match(/Node (\d+)\.\d+/);
  const { packages } = JSON.parse(readFileSync(inRepository('package-lock.json'), 'utf8'));
  const tooNew = Object.entries(packages).filter(([, { engines }]) => engines?.node).filter(([, { engines }]) => {
    const lowest = engines.node.split('||').map((range) => Number(range.match(/\d+/)?.[0] ?? 0));
    return Math.min(...lowest) > Number(oldest);
  });
  assert.deepEqual(tooNew.map(([name, { engines }]) => `${name} needs Node ${engines.node}`), []);
});

test('the sentence of each optional purpose names its packages and where to get them', () => {
  for (const [purpose, sentence] of Object.entries(optionalPurposes)) {
    assert.ok(packagesByPurpose[purpose].length > 0, purpose);
    assert.match(sentence, /is left out: it needs .+ Debian 12/, purpose);
    for (const name of packagesByPurpose[purpose]) assert.ok(sentence.includes(name), `${purpose}: ${name}`);
  }
});

/** Programs that scripts and tests start, with the package that contains each. `run` installs Node and npm. */
const packageOfProgram = {
  cmake: 'cmake',
  ctest: 'cmake',
  ninja: 'ninja-build',
  nm: 'binutils',
  mono: 'mono-runtime',
  emcc: 'emscripten',
  emcmake: 'emscripten',
  curl: 'curl',
  git: 'git',
  'clang-format': 'clang-format',
  'clang-tidy': 'clang-tidy',
  shellcheck: 'shellcheck',
  'clang-16': 'clang-16',
  'clang++-16': 'clang-16',
  'clang-22': 'clang-22',
  'clang++-22': 'clang-22',
  python3: 'python3',
  '/usr/bin/python3': 'python3',
  wine: 'wine',
  wine64: 'wine64',
  'qemu-aarch64': 'qemu-user',
  debootstrap: 'debootstrap',
  'x86_64-w64-mingw32-objdump': 'binutils-mingw-w64-x86-64',
  'x86_64-w64-mingw32-gcc-posix': 'g++-mingw-w64-x86-64-posix',
  'x86_64-w64-mingw32-g++-posix': 'g++-mingw-w64-x86-64-posix',
  'x86_64-w64-mingw32-windres': 'binutils-mingw-w64-x86-64',
  'aarch64-linux-gnu-gcc': 'g++-aarch64-linux-gnu',
  'aarch64-linux-gnu-g++': 'g++-aarch64-linux-gnu',
};

/** Text files below a folder of the repository. */
function filesBelow(folder, pattern) {
  return readdirSync(inRepository(folder), { withFileTypes: true }).flatMap((entry) => {
    const name = path.posix.join(folder, entry.name);
    if (entry.isDirectory()) return entry.name === 'node_modules' ? [] : filesBelow(name, pattern);
    return pattern.test(entry.name) ? [name] : [];
  });
}

const startPatterns = [
  // Of a script: run('git', ...); emulators name theirs as `command`.
  /\b(?:run|runOrFail|succeeds|spawn|spawnSync|execFileSync)\(\s*'([^']+)'/g,
  /\bjudgeJunit\([^,]+, '([^']+)'/g,
  /\bcommand: '([^']+)'/g,
  // Of a C++ test and of Python.
  /\bpopen\(\s*"([\w./+-]+) /g,
  /\[\s*"([\w./+-]+)", "[^"]*"[^\]]*\],? *(?:cwd|check|capture_output|env)/g,
  // Of CMake and its presets.
  /CMAKE_(?:C|CXX|RC)_COMPILER"?:? "?([\w./+-]+)/g,
  /find_program\(\w+ NAMES ([\w.+-]+)/g,
];

/** The programs that a source starts by name. */
function programsIn(text) {
  return [...new Set(startPatterns.flatMap((pattern) => [...text.matchAll(pattern)].map(([, name]) => name)))];
}

// Programs of every Debian, programs that `run` installs, and programs that are only started where they exist.
const always = new Set(['sh', '/bin/sh', 'bash', 'tar', 'mount', 'umount', 'apt-get', 'apt-cache', 'dpkg-query', 'sudo', 'npm', 'node', 'dotnet', 'ccache']);

/** The purposes that a script passes to set-up. */
const purposesOf = (script) => [...readFileSync(inRepository('scripts', script), 'utf8').matchAll(/setUp\(\[([^\]]*)\]\)/g)].flatMap(([, list]) => [...list.matchAll(/'(\w+)'/g)].map(([, name]) => name));

const purposesOfRunners = (...names) => names.flatMap((name) => runners[name].purposes);

/** Sources that start programs, and the purposes that are set up before they run. */
const starters = [
  { files: () => [...filesBelow('Tests/Package', /(?<!setup\.test)\.mjs$/), 'scripts/lint/files.mjs'], purposes: purposesOfRunners('package') },
  { files: () => [...filesBelow('Tests/Training', /\.py$/), ...filesBelow('Training', /\.py$/)], purposes: purposesOfRunners('training') },
  { files: () => filesBelow('Tests/Native', /\.(cpp|hpp|txt|cmake)$/), purposes: purposesOfRunners('native') },
  { files: () => filesBelow('NativePlugin/cmake', /\.cmake$/), purposes: purposesOfRunners('platforms') },
  { files: () => ['scripts/lib/platform_tests.mjs', 'scripts/lib/exported_names.mjs', 'scripts/lib/android_pages.mjs', 'Tests/Platforms/android-stand-in.cmake'], purposes: purposesOfRunners('platforms') },
  { files: () => ['CMakePresets.json', 'scripts/lib/test_runners.mjs', 'scripts/lib/native_build.mjs'], purposes: Object.values(runners).flatMap(({ purposes, longPurposes = [] }) => [...purposes, ...longPurposes]) },
  { files: () => filesBelow('scripts/web', /\.mjs$/), purposes: purposesOfRunners('web') },
  { files: () => ['scripts/lib/runtime_tests.mjs'], purposes: purposesOfRunners('mono') },
  { files: () => ['scripts/lib/dotnet.mjs'], purposes: purposesOfRunners('dotnet') },
  { files: () => filesBelow('scripts/lint', /\.mjs$/), purposes: purposesOf('lint.mjs') },
  { files: () => filesBelow('scripts/pack', /\.(mjs|py)$/), purposes: purposesOf('pack.mjs') },
];

for (const { files, purposes } of starters) {
  const names = files();
  test(`set-up brings every program that ${names.length === 1 ? names[0] : `${path.posix.dirname(names[0])} (${names.length} files)`} starts`, () => {
    const packages = selectPackages([...new Set(purposes)]);
    assert.ok(names.length > 0);
    for (const name of names) {
      for (const program of programsIn(readFileSync(inRepository(name), 'utf8'))) {
        if (always.has(program)) continue;
        const brings = packageOfProgram[program];
        assert.ok(brings, `${name} starts ${program}, of which packages.mjs does not know the package`);
        assert.ok(packages.includes(brings), `${name} starts ${program}, and set-up does not bring ${brings} before`);
      }
    }
  });
}

test('the programs that a text starts are found', () => {
  assert.deepEqual(programsIn("await run('git', ['ls-files']); succeeds('clang++-22', ['--version'])").sort(), ['clang++-22', 'git']);
  assert.deepEqual(programsIn("return judgeJunit('native.xml', 'ctest', ['--preset'])"), ['ctest']);
  assert.deepEqual(programsIn("{ command: 'wine', args: [] }"), ['wine']);
  assert.deepEqual(programsIn('popen("nm -D x", "r")'), ['nm']);
  assert.deepEqual(programsIn('subprocess.run(\n["git", "rev-parse", "HEAD"], cwd=folder)'), ['git']);
  assert.deepEqual(programsIn('set(CMAKE_CXX_COMPILER x86_64-w64-mingw32-g++-posix)'), ['x86_64-w64-mingw32-g++-posix']);
  assert.deepEqual(programsIn('"CMAKE_C_COMPILER": "clang-22",'), ['clang-22']);
});

test('every program of the list is in a package that some purpose brings', () => {
  const packages = new Set(Object.values(packagesByPurpose).flat());
  for (const [program, name] of Object.entries(packageOfProgram)) assert.ok(packages.has(name), `${program}: ${name}`);
});
