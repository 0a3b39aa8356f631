/** Debian packages by purpose. A command names its purposes, so that the demo needs neither PyTorch nor GoogleTest. */
export const packagesByPurpose = {
  build: [
    'cmake', 'ninja-build', 'g++', 'pkg-config', 'libglm-dev', 'nlohmann-json3-dev', 'libcli11-dev', 'libsndfile1-dev',
  ],
  test: ['libgtest-dev', 'libgmock-dev', 'libsoxr-dev', 'libkissfft-dev'],
  python: [
    'python3', 'python3-torch', 'python3-onnx', 'python3-numpy', 'python3-scipy', 'python3-pandas', 'python3-matplotlib',
    'python3-tqdm', 'python3-pytest', 'python3-pytest-xdist', 'python3-openpyxl', 'libopenblas0-pthread',
  ],
  platforms: [
    'g++-mingw-w64-x86-64-posix', 'wine', 'wine64', 'g++-aarch64-linux-gnu', 'qemu-user', 'googletest',
  ],
  lint: ['clang-format', 'clang-tidy', 'python3'],
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

/** The packages of `wanted` that `dpkg-query -W -f '${Package} ${db:Status-Status}\n'` does not list as installed. */
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

/**
 * What of a package-lock.json (version 3) is not in node_modules as the lock says.
 * @param {object} lock parsed lock file
 * @param {(location: string) => string | null} installedVersion version of the package at a location, null where none is
 * @returns {string[]} locations, for example "node_modules/pngjs"
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
