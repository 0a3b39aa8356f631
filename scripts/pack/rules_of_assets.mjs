import { sampleOf } from './package_files.mjs';
import { guidsByName } from './rules_of_files.mjs';

/** GUIDs built into Unity: default resources, built-in extra resources, and resources of the editor. */
const builtIn = new Set(['0000000000000000e000000000000000', '0000000000000000f000000000000000', '0000000000000000d000000000000000']);
const noGuid = '0'.repeat(32);

/** Endings of assets that Unity writes as YAML. */
export const yamlEndings = ['.unity', '.prefab', '.mixer', '.asset', '.mat', '.controller', '.playable', '.preset'];

/** The references of a YAML text: {id, guid}; no guid for an object of the same file. */
export const references = (text) => [...text.matchAll(/\{fileID: (-?\d+)(?:, guid: ([0-9a-f]{32}), type: \d)?\}/g)].map(([, id, guid]) => ({ id, guid }));
const lineOf = (text, index) => text.slice(0, index).split('\n').length;

/** GUIDs in scenes, prefabs, mixers and other assets belong to files of the package or are built into Unity. */
export function checkAssetGuids(files) {
  const owners = new Map([...guidsByName(files)].map(([name, guid]) => [guid, name]));
  const complaints = [];
  for (const name of [...files.endingIn(...yamlEndings), ...files.endingIn('.meta')]) {
    const text = files.text(name);
    for (const found of text.matchAll(/\{fileID: -?\d+, guid: ([0-9a-f]{32})/g)) {
      const guid = found[1];
      if (builtIn.has(guid) || guid === noGuid) continue;
      const where = `${name}:${lineOf(text, found.index)}: GUID ${guid}`;
      const owner = owners.get(guid);
      if (owner === undefined) complaints.push(`${where}: no file of the package has it`);
      else if (sampleOf(owner) !== null && sampleOf(owner) !== sampleOf(name)) complaints.push(`${where}: is ${owner}, which a project may not have imported`);
    }
  }
  return complaints;
}

/** In a YAML asset, a fileID without GUID refers to an object of the same asset, and no two objects share an anchor. */
export function checkAnchors(files) {
  const complaints = [];
  for (const name of files.endingIn(...yamlEndings)) {
    const text = files.text(name);
    const anchors = [...text.matchAll(/^--- !u!\d+ &(-?\d+)/gm)].map(([, anchor]) => anchor);
    const twice = anchors.filter((anchor, index) => anchors.indexOf(anchor) !== index);
    complaints.push(...twice.map((anchor) => `${name}: two objects have the anchor &${anchor}`));
    const known = new Set(anchors);
    const missing = references(text).filter(({ id, guid }) => guid === undefined && id !== '0' && !known.has(id));
    complaints.push(...missing.map(({ id }) => `${name}: no object has the anchor &${id}`));
  }
  return complaints;
}

/** A script that a scene refers to has a class with the name of its file, by which Unity finds the class. */
export function checkSceneScripts(files) {
  const owners = new Map([...guidsByName(files)].map(([name, guid]) => [guid, name]));
  const complaints = [];
  for (const name of files.endingIn(...yamlEndings)) {
    for (const [, guid] of files.text(name).matchAll(/m_Script: \{fileID: 11500000, guid: ([0-9a-f]{32}), type: 3\}/g)) {
      const script = owners.get(guid);
      if (script === undefined) continue;
      const wanted = script.split('/').at(-1).replace(/\.cs$/, '');
      const isThere = script.endsWith('.cs') && new RegExp(`\\bclass ${wanted}\\b`).test(files.text(script));
      if (!isThere) complaints.push(`${name}: names the script ${script}; expected a class ${wanted} in it`);
    }
  }
  return complaints;
}

const modelEnding = '.haptoflow';

/** The source of the ScriptedImporter for models; null where there is none. */
const importerOfModels = (files) =>
  files.endingIn('.cs').find((name) => /\[ScriptedImporter\([^\]]*"haptoflow"/.test(files.text(name))) ?? null;

/**
 * The fileID by which scenes refer to a model: Unity hashes the native type, the identifier with which the importer adds the object,
 * and a count (xxHash64 of "Type:MonoBehaviour->model0"). Another identifier would break every scene.
 */
export const modelObject = { identifier: 'model', id: '1022318259475508783' };

/** The .meta of a model names the script of its importer, since Unity cannot change a .meta of an immutable package. */
export function checkModelImporter(files) {
  const importer = importerOfModels(files);
  const guid = guidsByName(files).get(importer);
  return files.endingIn(modelEnding).filter((name) => files.has(`${name}.meta`)).flatMap((name) => {
    if (importer === null) return [`${name}: no ScriptedImporter for it in the package`];
    const isNamed = files.text(`${name}.meta`).includes(`  script: {fileID: 11500000, guid: ${guid}, type: 3}`);
    return isNamed ? [] : [`${name}.meta: expected the line "  script: {fileID: 11500000, guid: ${guid}, type: 3}", the GUID of ${importer}`];
  });
}

/** The importer adds models under the identifier of which scenes have the fileID. */
export function checkModelReferences(files) {
  const models = new Map([...guidsByName(files)].filter(([name]) => name.endsWith(modelEnding)).map(([name, guid]) => [guid, name]));
  const importer = importerOfModels(files);
  const identifier = importer && files.text(importer).match(/AddObjectToAsset\(\s*"([^"]+)"/)?.[1];
  const isOther = importer !== null && identifier !== modelObject.identifier;
  const complaints = isOther ? [`${importer}: adds models as "${identifier}"; expected "${modelObject.identifier}", by which scenes refer to them`] : [];
  for (const name of files.endingIn('.unity', '.prefab', '.asset')) {
    for (const [, id, guid] of files.text(name).matchAll(/\{fileID: (-?\d+), guid: ([0-9a-f]{32}), type: 3\}/g)) {
      if (!models.has(guid)) continue;
      if (id !== modelObject.id) complaints.push(`${name}: refers to ${models.get(guid)} as fileID ${id}; expected ${modelObject.id}`);
    }
  }
  return complaints;
}
