import { isImported, sampleOf } from '../package_files.mjs';

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
