import { existsSync, readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { CommandError } from '../lib/process.mjs';

/** Where npm puts packages; the manifest names one in it. */
const installed = 'node_modules';

const isUnitys = (/** @type {string} */ name) => name.startsWith('com.unity.');

/**
 * The packages of a Unity project, found as the Package Manager finds them: those that lie in its folder Packages, those that its manifest
 * names by `file:`, and Unity's own, which the Package Manager downloads.
 * @param {string} project the project's folder
 * @returns {{name: string, version: string, folder: string | null, place: 'project' | 'node_modules' | 'Unity'}[]} folder is null for
 *   Unity's own
 * @throws {CommandError} where the Package Manager would stop: a folder without package, another name, a dependency that nothing provides
 */
export function resolvePackages(project) {
  const manifestFile = path.join(project, 'Packages', 'manifest.json');
  const { dependencies } = readJson(manifestFile);
  const embedded = readdirSync(path.join(project, 'Packages'), { withFileTypes: true })
    .filter((entry) => entry.isDirectory() && existsSync(path.join(project, 'Packages', entry.name, 'package.json')))
    .map((entry) => localPackage(project, path.join(project, 'Packages', entry.name)));
  const named = Object.entries(dependencies).map(([name, version]) => {
    if (!version.startsWith('file:')) return { name, version, folder: null, place: /** @type {const} */ ('Unity') };
    const found = localPackage(project, path.resolve(project, 'Packages', version.slice('file:'.length)));
    if (found.name !== name) throw new CommandError(`${manifestFile}: "${name}": ${found.folder} holds ${found.name}`);
    return found;
  });
  const packages = [...embedded, ...named.filter(({ name }) => embedded.every((each) => each.name !== name))];
  requireDependencies(packages, manifestFile);
  return packages.map(({ name, version, folder, place }) => ({ name, version, folder, place }));
}

function localPackage(/** @type {string} */ project, /** @type {string} */ folder) {
  const place = path.relative(project, folder).split(path.sep)[0] === installed ? /** @type {const} */ ('node_modules') : /** @type {const} */ ('project');
  const file = path.join(folder, 'package.json');
  if (!existsSync(file)) {
    throw new CommandError(`${file}: is missing${place === 'node_modules' ? `: run \`npm ci\` in ${project}` : ', though Packages/manifest.json names its folder'}`);
  }
  return { dependencies: {}, ...readJson(file), folder, place };
}

/** Everything that a package of this folder needs must be named, or be Unity's own. */
function requireDependencies(/** @type {any[]} */ packages, /** @type {string} */ manifestFile) {
  for (const { name, dependencies, folder } of packages.filter((each) => each.folder !== null)) {
    for (const [wanted, version] of Object.entries(dependencies)) {
      const found = packages.find((each) => each.name === wanted);
      if (!found && !isUnitys(wanted)) throw new CommandError(`${manifestFile}: lacks "${wanted}", which ${name} needs`);
      // Unity's registry has every version of its own packages and takes the highest that is asked for.
      if (found?.folder && found.version !== version) {
        throw new CommandError(`${path.join(folder, 'package.json')}: needs ${wanted} ${version}; ${found.folder} holds ${found.version}: run \`npm ci\``);
      }
    }
  }
}

function readJson(/** @type {string} */ file) {
  try {
    return JSON.parse(readFileSync(file, 'utf8'));
  } catch (error) {
    throw new CommandError(`${file}: ${/** @type {Error} */ (error).message}`);
  }
}
