import { existsSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { CommandError, inRepository } from '../lib/process.mjs';
import { dependencyName } from './dependency.mjs';
import { packageName, studiesName } from './layout.mjs';
import { PackageFiles } from './package_files.mjs';
import { checkAssemblyNames, checkPlatforms, checkReferences, checkScriptsBelong } from './rules_of_assemblies.mjs';
import { checkAnchors, checkAssetGuids, checkModelReferences, checkSceneScripts, yamlEndings } from './rules_of_assets.mjs';
import { checkCase, checkGuids, checkImporters, checkMetasAreThere, checkMetasAreWanted, checkPathLengths, guidsByName } from './rules_of_files.mjs';

/** Folders of the repository into which Unity writes a .meta for every asset, and deletes every .meta without one. */
export const writableFolders = ['Assets', `Packages/${packageName}`, `Packages/${studiesName}`, 'Tests/Unity'];

/** The list of the project's packages. */
export const manifestName = 'Packages/manifest.json';

/** The project as it lies on disk, also where there is no git: with what Unity, a build or a ZIP without .gitignore added. */
export function projectFilesOnDisk() {
  const contents = new Map();
  for (const folder of ['ProjectSettings', ...writableFolders].filter((name) => existsSync(inRepository(name)))) {
    const files = PackageFiles.inFolder(inRepository(folder));
    for (const name of files.names) contents.set(`${folder}/${name}`, files.bytes(name));
  }
  const manifest = inRepository(manifestName);
  if (!existsSync(manifest)) throw new CommandError(`${manifest}: is missing`);
  contents.set(manifestName, readFileSync(manifest));
  return new PackageFiles(contents);
}

/**
 * The project with what `npm ci` brings: of ONNX Runtime for Unity only the manifest, the .meta files and the assembly
 * definitions, since its libraries are large. Without `npm ci` the same as `files`.
 * @param {PackageFiles} files
 */
export function withDependency(files) {
  const folder = inRepository('node_modules', dependencyName);
  if (!existsSync(folder)) return files;
  const brought = PackageFiles.inFolder(folder, (name) => /\.(meta|asmdef)$|^package\.json$/.test(name));
  const contents = new Map(files.contents);
  for (const name of brought.names) contents.set(path.posix.join('node_modules', dependencyName, name), brought.bytes(name));
  return new PackageFiles(contents);
}

/** Settings that Unity's packages for XR write; the scripts that they name are those packages' own. */
const settingsOfPackages = 'Assets/XR/';

/** Unity's modules by the kinds of objects in scenes and prefabs: the number after "!u!". */
const modulesOfClasses = {
  54: 'physics', 64: 'physics', 65: 'physics', 135: 'physics', 136: 'physics', 143: 'physics',
  81: 'audio', 82: 'audio',
  154: 'terrainphysics', 218: 'terrain',
  196: 'ai',
};

/** Unity's modules by words of C# that only code which needs the module contains. */
const modulesOfWords = {
  AndroidJavaObject: 'androidjni',
  AnimationCurve: 'animation',
  AudioSource: 'audio',
  BoxCollider: 'physics',
  GUILayout: 'imgui',
  ImageConversion: 'imageconversion',
  JsonUtility: 'jsonserialize',
  ParticleSystem: 'particlesystem',
  Physics2D: 'physics2d',
  SubsystemManager: 'subsystems',
  TerrainCollider: 'terrainphysics',
  TerrainData: 'terrain',
  UIElements: 'uielements',
  UnityWebRequest: 'unitywebrequest',
  XRDisplaySubsystem: 'xr',
};

const buildSettingsName = 'ProjectSettings/EditorBuildSettings.asset';

/** The files of the folders that Unity writes to. */
const assetsOf = (files) => new PackageFiles(new Map(files.names.filter((name) => writableFolders.some((folder) => name.startsWith(`${folder}/`))).map((name) => [name, files.contents.get(name)])));

/** A folder that is a project's or a package's own root has no .meta. */
function checkEverythingHasMeta(files) {
  const roots = new Set(writableFolders.flatMap((folder) => folder.split('/').map((_, index, pieces) => pieces.slice(0, index + 1).join('/'))));
  return checkMetasAreThere(assetsOf(files)).filter((complaint) => !roots.has(complaint.split(': ')[0]));
}

/** Every package of the manifest that is a folder is there under its name, and every dependency of the packages in the repository is met. */
function checkPackages(files) {
  const complaints = [];
  const { dependencies, testables } = JSON.parse(files.text(manifestName));
  const all = withDependency(files);
  const local = new Map([packageName, studiesName].map((name) => [name, `Packages/${name}`]));
  for (const [name, version] of Object.entries(dependencies)) {
    if (!version.startsWith('file:')) continue;
    const folder = version.startsWith('file:../') ? version.slice('file:../'.length) : `Packages/${version.slice('file:'.length)}`;
    const isThere = all.has(`${folder}/package.json`);
    if (!isThere) complaints.push(`${manifestName}: "${name}": there is no ${folder}/package.json${folder.startsWith('node_modules/') ? '; run npm ci' : ''}`);
    else if (JSON.parse(all.text(`${folder}/package.json`)).name !== name) complaints.push(`${manifestName}: "${name}": ${folder} has another name`);
    if (isThere) local.set(name, folder);
  }
  for (const folder of local.values()) {
    for (const [name, version] of Object.entries(JSON.parse(all.text(`${folder}/package.json`)).dependencies ?? {})) {
      const given = local.has(name) ? JSON.parse(all.text(`${local.get(name)}/package.json`)).version : dependencies[name];
      // A folder that is not there was named above.
      if (given !== version && !given?.startsWith('file:')) complaints.push(`${folder}/package.json: needs ${name} ${version}; ${manifestName} gives ${given ?? 'none'}`);
    }
  }
  return [...complaints, ...(testables ?? []).filter((name) => !local.has(name)).map((name) => `${manifestName}: testable "${name}" is no package of the repository`)];
}

/** The manifest has the modules that scenes, prefabs and code need. */
function checkModules(files) {
  const { dependencies } = JSON.parse(files.text(manifestName));
  const complaints = new Set();
  const need = (name, what, module) => {
    if (!(`com.unity.modules.${module}` in dependencies)) complaints.add(`${name}: ${what} needs com.unity.modules.${module} in ${manifestName}`);
  };
  for (const name of assetsOf(files).endingIn('.unity', '.prefab')) {
    for (const [, number] of files.text(name).matchAll(/^--- !u!(\d+) &/gm)) {
      if (number in modulesOfClasses) need(name, `an object of class ${number}`, modulesOfClasses[number]);
    }
  }
  for (const name of assetsOf(files).endingIn('.cs')) {
    const words = new Set(files.text(name).match(/\w+/g));
    for (const [word, module] of Object.entries(modulesOfWords)) if (words.has(word)) need(name, word, module);
  }
  return [...complaints];
}

/** Every GUID belongs to a file of the project, of the dependency or of Unity, and every fileID to an object of that file. */
function checkTargets(files) {
  const all = withDependency(files);
  const complaints = checkAssetGuids(all).filter((complaint) => !complaint.startsWith(settingsOfPackages));
  const owners = new Map([...guidsByName(all)].map(([name, guid]) => [guid, name]));
  for (const name of files.endingIn(...yamlEndings)) {
    for (const [, id, guid] of files.text(name).matchAll(/\{fileID: (-?\d+), guid: ([0-9a-f]{32}), type: \d\}/g)) {
      const owner = owners.get(guid);
      if (owner === undefined) continue;
      const isScript = owner.endsWith('.cs');
      const isYaml = yamlEndings.some((ending) => owner.endsWith(ending));
      const isThere = isScript ? id === '11500000' : !isYaml || isObjectOf(files.text(owner), owner, id);
      if (!isThere) complaints.push(`${name}: ${owner} has no object ${id}`);
    }
  }
  return complaints;
}

// The number by which scenes name a prefab as a whole.
const wholePrefab = '100100000';

const isObjectOf = (text, owner, id) => (owner.endsWith('.prefab') && id === wholePrefab) || new RegExp(`^--- !u!\\d+ &${id}$`, 'm').test(text);

/** What an instance changes of its prefab is a field that the changed object has. */
function checkChanges(files) {
  const owners = new Map([...guidsByName(files)].map(([name, guid]) => [guid, name]));
  const complaints = [];
  for (const name of files.endingIn('.unity', '.prefab')) {
    for (const [, id, guid, field] of files.text(name).matchAll(/- target: \{fileID: (-?\d+), guid: ([0-9a-f]{32}), type: 3\}\n +propertyPath: (.*)/g)) {
      const prefab = owners.get(guid);
      const object = prefab && files.text(prefab).split(/^--- !u!\d+ &/m).find((text) => text.startsWith(`${id}\n`));
      if (!object?.match(new RegExp(`^ {2}${field.split('.')[0]}:`, 'm'))) complaints.push(`${name}: changes ${field} of &${id} in ${prefab ?? `a prefab ${guid}`}, which has no such field`);
    }
  }
  return complaints;
}

/** Every object but the settings of a scene hangs below a root that the scene lists. */
function checkRoots(files) {
  return assetsOf(files).endingIn('.unity').flatMap((name) => {
    const text = files.text(name);
    const listed = new Set([...(text.split('\nSceneRoots:')[1] ?? '').matchAll(/- \{fileID: (-?\d+)\}/g)].map(([, id]) => id));
    const objects = text.split(/^--- !u!/m).slice(1).map((object) => ({ id: object.match(/^\d+ &(-?\d+)/)[1], object }));
    const isRoot = ({ object }) => /^ {2}m_Father: \{fileID: 0\}$/m.test(object) || /^ {4}m_TransformParent: \{fileID: 0\}$/m.test(object);
    const roots = objects.filter(isRoot).map(({ id }) => id);
    return [
      ...roots.filter((id) => !listed.has(id)).map((id) => `${name}: the root &${id} is not among SceneRoots`),
      ...[...listed].filter((id) => !roots.includes(id)).map((id) => `${name}: SceneRoots lists &${id}, which is no root`),
    ];
  });
}

/** The scenes of the build are scenes of the project. */
function checkBuildScenes(files) {
  const guids = guidsByName(files);
  return [...files.text(buildSettingsName).matchAll(/^ {4}path: (.*)\n {4}guid: (\w+)$/gm)]
    .filter(([, scene, guid]) => !(files.has(scene) && guids.get(scene) === guid))
    .map(([, scene, guid]) => `${buildSettingsName}: there is no ${scene} with the GUID ${guid}`);
}

/**
 * The rules of the Unity project by name; each gives one line for each complaint.
 * @type {Record<string, (files: PackageFiles) => string[]>}
 */
export const rules = {
  packages: checkPackages,
  modules: checkModules,
  'a .meta for everything': checkEverythingHasMeta,
  'no .meta for nothing': (files) => checkMetasAreWanted(assetsOf(files)),
  GUIDs: (files) => checkGuids(withDependency(files)),
  importers: (files) => checkImporters(assetsOf(files)),
  'upper and lower case': checkCase,
  'path lengths': checkPathLengths,
  'assembly names': (files) => checkAssemblyNames(withDependency(files)),
  'assembly references': (files) => checkReferences(withDependency(files)),
  'scripts in assemblies': (files) => checkScriptsBelong(assetsOf(files)),
  'assembly platforms': checkPlatforms,
  'targets of references': checkTargets,
  'anchors in assets': checkAnchors,
  'scripts of scenes': checkSceneScripts,
  'models of scenes': checkModelReferences,
  'changes of prefabs': checkChanges,
  'roots of scenes': checkRoots,
  'scenes of the build': checkBuildScenes,
};
