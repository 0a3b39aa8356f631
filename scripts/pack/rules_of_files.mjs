import { isImported, sampleOf } from './package_files.mjs';

const versionPattern = /^\d+\.\d+\.\d+(-[0-9A-Za-z.-]+)?$/;

const fields = [
  ['name', (value) => /^[a-z0-9][a-z0-9._-]{0,213}$/.test(value), 'a reverse domain name in lower case'],
  ['version', (value) => versionPattern.test(value), 'a semantic version, for example 1.2.3'],
  ['displayName', (value) => value.length > 0, 'a name for people'],
  ['description', (value) => value.length > 0, 'a sentence or two'],
  ['unity', (value) => /^\d+\.\d+$/.test(value), 'the oldest Unity version, for example 2022.3'],
  ['license', (value) => value.length > 0, 'the name of a licence'],
];

/** package.json is valid for Unity's Package Manager: names, versions, dependencies, and samples that exist. */
export function checkManifest(files) {
  let manifest;
  try {
    manifest = JSON.parse(files.text('package.json'));
  } catch (error) {
    return [`package.json: ${files.has('package.json') ? error.message : 'is not there'}`];
  }
  const complaints = fields
    .filter(([key, isGood]) => typeof manifest[key] !== 'string' || !isGood(manifest[key]))
    .map(([key, , expected]) => `package.json: "${key}" is ${JSON.stringify(manifest[key])}; expected ${expected}`);
  for (const [name, version] of Object.entries(manifest.dependencies ?? {})) {
    if (!versionPattern.test(version)) {
      complaints.push(`package.json: dependency "${name}" is ${JSON.stringify(version)}; expected one version: Unity takes no ranges`);
    }
  }
  return [...complaints, ...checkSamples(manifest.samples ?? [], files)];
}

function checkSamples(samples, files) {
  const complaints = [];
  for (const [index, { displayName, description, path: place }] of samples.entries()) {
    const key = `package.json: samples[${index}]`;
    if (!displayName || !description) complaints.push(`${key}: expected "displayName" and "description"`);
    if (!files.folders.includes(place)) complaints.push(`${key}: no folder ${JSON.stringify(place)} in the package`);
  }
  const listed = new Set(samples.map(({ path: place }) => place));
  const unlisted = files.folders.filter((folder) => /^Samples~\/[^/]+$/.test(folder) && !listed.has(folder));
  return [...complaints, ...unlisted.map((folder) => `${folder}: is not among "samples" of package.json, so nobody can import it`)];
}

export const longestPath = 100;

/** The maximum length of a path in the package: the limit of 260 characters of Windows includes project path and cache folder. */
export function checkPathLengths(files) {
  return files.names
    .filter((name) => name.length > longestPath)
    .map((name) => `${name}: the path has ${name.length} characters; expected at most ${longestPath}`);
}

/** No two names differ in case only: on Windows and macOS they would be the same file. */
export function checkCase(files) {
  const seen = new Map();
  const complaints = [];
  for (const name of [...files.folders, ...files.names]) {
    const other = seen.get(name.toLowerCase());
    if (other) complaints.push(`${name}: differs from ${other} in upper and lower case only`);
    seen.set(name.toLowerCase(), name);
  }
  return complaints;
}

/** Relative links of Markdown pages lead to files of the package, since the pages are also read there. */
export function checkLinks(files) {
  const complaints = [];
  for (const name of files.endingIn('.md')) {
    for (const [, target] of files.text(name).matchAll(/\]\(<?([^)>#\s][^)>#]*?)>?(?:#[^)]*)?\)/g)) {
      if (/^[a-z]+:/.test(target)) continue;
      const place = resolved(name, target);
      if (place === null || !(files.has(place) || files.folders.includes(place))) {
        complaints.push(`${name}: links to ${target}, which is not in the package`);
      }
    }
  }
  return complaints;
}

/** The target of a relative link; null for a target outside the package. */
function resolved(name, target) {
  const pieces = name.split('/').slice(0, -1);
  for (const piece of decodeURI(target).replace(/\/$/, '').split('/')) {
    if (piece === '..' && pieces.pop() === undefined) return null;
    if (piece !== '..' && piece !== '.') pieces.push(piece);
  }
  return pieces.join('/');
}

const metaEnding = '.meta';
const isMeta = (name) => name.endsWith(metaEnding);

/** The GUID of a .meta file; null where it has none. */
export const guidOf = (text) => text.match(/^guid: ([0-9a-f]{32})\s*$/m)?.[1] ?? null;

/** The GUID of every file and folder that has a .meta: name -> GUID. */
export function guidsByName(files) {
  const entries = files.names.filter(isMeta).map((name) => [name.slice(0, -metaEnding.length), guidOf(files.text(name))]);
  return new Map(entries.filter(([, guid]) => guid !== null));
}

/**
 * Every file and folder that Unity imports has a .meta: from an immutable package Unity ignores files without one. In a
 * sample that has .meta files every file has one: Unity copies samples to Assets, where a script without .meta gets a new
 * GUID.
 */
export function checkMetasAreThere(files) {
  const samplesWithMetas = new Set(files.names.filter((name) => isMeta(name)).map(sampleOf).filter(Boolean));
  const wants = (name) => isImported(name) || (samplesWithMetas.has(sampleOf(name)) && !name.split('/').at(-1).startsWith('.'));
  return [...files.folders, ...files.names]
    .filter((name) => !isMeta(name) && wants(name) && !files.has(name + metaEnding))
    .map((name) => `${name}: has no .meta; Unity leaves it out of an immutable package`);
}

/** Every .meta has its file: Unity warns of a .meta without one and deletes it. */
export function checkMetasAreWanted(files) {
  const there = new Set([...files.folders, ...files.names]);
  return files.names
    .filter((name) => isMeta(name) && !there.has(name.slice(0, -metaEnding.length)))
    .map((name) => `${name}: belongs to no file`);
}

/** Every .meta has a unique GUID: Unity would give one of two files with the same GUID a new one and break its references. */
export function checkGuids(files) {
  const owners = new Map();
  const complaints = [];
  for (const name of files.names.filter(isMeta)) {
    const guid = guidOf(files.text(name));
    if (guid === null) complaints.push(`${name}: has no line "guid: " with 32 hexadecimal digits in lower case`);
    else if (owners.has(guid)) complaints.push(`${name}: has the GUID of ${owners.get(guid)}`);
    else owners.set(guid, name);
  }
  return complaints;
}

/** Unity's importer for each kind of file whose settings are lost when the .meta names another importer. */
const importers = [
  [/\.cs$/, 'MonoImporter'],
  [/\.prefab$/, 'PrefabImporter'],
  [/\.asmdef$/, 'AssemblyDefinitionImporter'],
  [/\.(so|dll|dylib)$/, 'PluginImporter'],
  [/\.(mixer|asset|mat)$/, 'NativeFormatImporter'],
  [/\.png$/, 'TextureImporter'],
  [/\.haptoflow$/, 'ScriptedImporter'],
  [/^package\.json$/, 'PackageManifestImporter'],
];

/** Every .meta names the importer for its kind of file. */
export function checkImporters(files) {
  const complaints = [];
  for (const name of files.names.filter((candidate) => files.has(candidate + metaEnding))) {
    const importer = importers.find(([pattern]) => pattern.test(name))?.[1];
    if (importer && !new RegExp(`^${importer}:`, 'm').test(files.text(name + metaEnding))) {
      complaints.push(`${name}.meta: expected the settings of ${importer}`);
    }
  }
  return complaints;
}
