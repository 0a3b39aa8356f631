import { inRepository } from '../lib/repository.mjs';

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

/** Files below `parts` that are not packed: in the repository the tests are a package of their own. */
const unpacked = ['Tests/Unity/package.json', 'Tests/Unity/package.json.meta'];

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

/**
 * The place of a repository file in the package; null for a file that is not packed.
 * @param {string} name relative to the repository, with slashes
 */
export function placeInPackage(name) {
  const part = parts.find(({ from }) => name.startsWith(`${from}/`));
  if (!part || unpacked.includes(name)) return null;
  const place = [part.to, name.slice(part.from.length + 1)].filter((piece) => piece !== '').join('/');
  const isHidden = place.split('/').some((piece) => piece.startsWith('.'));
  return isHidden ? null : place;
}
