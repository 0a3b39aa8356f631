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

/**
 * GUIDs in scenes, prefabs, mixers and other assets belong to files of the package or are built into Unity.
 * @param {Set<string>} known GUIDs of files elsewhere
 */
export function checkAssetGuids(files, known = new Set()) {
  const owners = new Map([...guidsByName(files)].map(([name, guid]) => [guid, name]));
  const complaints = [];
  for (const name of [...files.endingIn(...yamlEndings), ...files.endingIn('.meta')]) {
    const text = files.text(name);
    for (const found of text.matchAll(/\{fileID: -?\d+, guid: ([0-9a-f]{32})/g)) {
      const guid = found[1];
      if (builtIn.has(guid) || known.has(guid) || guid === noGuid) continue;
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

/** The identifier with which the model importer adds its main object; null without such an importer. */
function modelIdentifier(files) {
  const importer = importerOfModels(files);
  return importer && (files.text(importer).match(/AddObjectToAsset\(\s*"([^"]+)"/)?.[1] ?? null);
}

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

/** Scenes refer to a model by its GUID and by the fileID derived from the importer's identifier. */
export function checkModelReferences(files) {
  const models = new Map([...guidsByName(files)].filter(([name]) => name.endsWith(modelEnding)).map(([name, guid]) => [guid, name]));
  const complaints = [];
  for (const name of files.endingIn('.unity', '.prefab', '.asset')) {
    for (const [, id, guid] of files.text(name).matchAll(/\{fileID: (-?\d+), guid: ([0-9a-f]{32}), type: 3\}/g)) {
      if (!models.has(guid)) continue;
      const identifier = modelIdentifier(files);
      const expected = identifier === null ? 'a ScriptedImporter for models in the package' : importedObjectId(identifier);
      if (id !== expected) complaints.push(`${name}: refers to ${models.get(guid)} as fileID ${id}; expected ${expected}`);
    }
  }
  return complaints;
}

const mask = (1n << 64n) - 1n;
const primes = [0x9e3779b185ebca87n, 0xc2b2ae3d27d4eb4fn, 0x165667b19e3779f9n, 0x85ebca77c2b2ae63n, 0x27d4eb2f165667c5n];
const rotate = (value, bits) => ((value << BigInt(bits)) | (value >> BigInt(64 - bits))) & mask;
const round = (sum, lane) => (rotate((sum + lane * primes[1]) & mask, 31) * primes[0]) & mask;

/** xxHash64 with seed 0 (Collet; the algorithm's public specification). @param {Buffer} bytes @returns {bigint} */
export function xxHash64(bytes) {
  let at = 0;
  let hash;
  if (bytes.length >= 32) {
    const sums = [(primes[0] + primes[1]) & mask, primes[1], 0n, (1n << 64n) - primes[0]];
    for (; at + 32 <= bytes.length; at += 32) {
      sums.forEach((sum, lane) => {
        sums[lane] = round(sum, bytes.readBigUInt64LE(at + 8 * lane));
      });
    }
    hash = (rotate(sums[0], 1) + rotate(sums[1], 7) + rotate(sums[2], 12) + rotate(sums[3], 18)) & mask;
    for (const sum of sums) hash = ((hash ^ round(0n, sum)) * primes[0] + primes[3]) & mask;
  } else {
    hash = primes[4];
  }
  hash = (hash + BigInt(bytes.length)) & mask;
  for (; at + 8 <= bytes.length; at += 8) hash = (rotate(hash ^ round(0n, bytes.readBigUInt64LE(at)), 27) * primes[0] + primes[3]) & mask;
  if (at + 4 <= bytes.length) {
    hash = (rotate(hash ^ ((BigInt(bytes.readUInt32LE(at)) * primes[0]) & mask), 23) * primes[1] + primes[2]) & mask;
    at += 4;
  }
  for (; at < bytes.length; at += 1) hash = (rotate(hash ^ ((BigInt(bytes[at]) * primes[4]) & mask), 11) * primes[0]) & mask;
  hash = ((hash ^ (hash >> 33n)) * primes[1]) & mask;
  hash = ((hash ^ (hash >> 29n)) * primes[2]) & mask;
  return hash ^ (hash >> 32n);
}

/**
 * The fileID by which scenes refer to a ScriptableObject that a ScriptedImporter added under an identifier: Unity hashes
 * the object's native type, the identifier and a count. Published asset files agree: the identifier "<root>" of input
 * action assets gives -944628639613478452, "tree" of visual trees 9197481963319205126.
 */
export function importedObjectId(identifier) {
  return BigInt.asIntN(64, xxHash64(Buffer.from(`Type:MonoBehaviour->${identifier}0`, 'utf8'))).toString();
}
