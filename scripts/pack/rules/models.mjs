import { importedObjectId } from '../imported_ids.mjs';
import { guidsByName } from './metas.mjs';

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
