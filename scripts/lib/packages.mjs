/** Debian packages by purpose. A command names its purposes, so that the demo needs neither PyTorch nor GoogleTest. */
export const packagesByPurpose = {
  build: [
    'cmake', 'ninja-build', 'g++', 'pkg-config', 'libglm-dev', 'nlohmann-json3-dev', 'libcli11-dev', 'libsndfile1-dev',
  ],
  // ccache makes every build after the first one short.
  test: ['ccache', 'libgtest-dev', 'libgmock-dev', 'libsoxr-dev', 'libkissfft-dev', 'binutils'],
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
