import { inRepository } from '../lib/process.mjs';

/** Name of the package, as in its manifest. */
export const packageName = 'com.haptoflow.runtime';

/** Path of the package's manifest in the repository. */
export const manifestPath = inRepository('Packages', packageName, 'package.json');

/** Folders of the repository and their places in the package. */
export const parts = [
  { from: `Packages/${packageName}`, to: '' },
  // The .meta files of the libraries that are not in git.
  { from: 'NativePlugin/import', to: 'Runtime/Plugins' },
  { from: 'Samples~', to: 'Samples~' },
  { from: 'Documentation~', to: 'Documentation~' },
  { from: 'Tests/Unity', to: 'Tests' },
];

/** GUIDs of folders that exist only in the package; git has no .meta for them. */
export const folderGuids = { Tests: 'b5f0a2d1c6e84f6f9a3d0c7e51482b96' };

/** The .meta of a folder. */
export const folderMeta = (guid) => `fileFormatVersion: 2
guid: ${guid}
folderAsset: yes
DefaultImporter:
  externalObjects: {}
  userData: 
  assetBundleName: 
  assetBundleVariant: 
`;

/** The list of samples. They lie outside the package's folder, so the repository's manifest does not name them. */
export const samplesList = 'Samples~/samples.json';

/** Single files whose place does not follow from `parts`; null: not packed. */
const places = {
  // One scene of the repository's own project is also that of a sample. No project has both, so they may share the GUID.
  'Assets/Workshop.unity': 'Samples~/Workshop/Workshop.unity',
  'Assets/Workshop.unity.meta': 'Samples~/Workshop/Workshop.unity.meta',
  [samplesList]: null,
  // In the repository the tests are a package of their own.
  'Tests/Unity/package.json': null,
  'Tests/Unity/package.json.meta': null,
};

/**
 * The place of a repository file in the package; null for a file that is not packed.
 * @param {string} name relative to the repository, with slashes
 */
export function placeInPackage(name) {
  if (name in places) return places[name];
  const part = parts.find(({ from }) => name.startsWith(`${from}/`));
  if (!part) return null;
  const place = [part.to, name.slice(part.from.length + 1)].filter((piece) => piece !== '').join('/');
  const isHidden = place.split('/').some((piece) => piece.startsWith('.'));
  return isHidden ? null : place;
}
