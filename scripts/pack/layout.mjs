import { inRepository } from '../lib/process.mjs';

/** Name of the package, as in its manifest. */
export const packageName = 'com.haptoflow.runtime';

/** Name of the package with the user studies, which depends on the other one. Its folder has its samples, since it needs no library. */
export const studiesName = 'com.haptoflow.studies';

/** Path of the package's manifest in the repository. */
export const manifestPath = inRepository('Packages', packageName, 'package.json');

/** Pages about the studies, and their pictures: they go into the studies' package. */
const isOfStudies = (name) => /^Documentation~\/(images\/)?(studies|[a-z]+-study|study-[a-z]+|delay-budget)\.[a-z]+$/.test(name);

/** Folders of the repository and their places in each package. */
const parts = {
  [packageName]: [
    { from: `Packages/${packageName}`, to: '' },
    // The .meta files of the libraries that are not in git.
    { from: 'NativePlugin/import', to: 'Runtime/Plugins' },
    { from: 'Samples~', to: 'Samples~' },
    { from: 'Documentation~', to: 'Documentation~', has: (name) => !isOfStudies(name) },
    { from: 'Tests/Unity', to: 'Tests' },
  ],
  [studiesName]: [
    { from: `Packages/${studiesName}`, to: '' },
    { from: 'Documentation~', to: 'Documentation~', has: isOfStudies },
  ],
};

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
 * The place of a repository file in a package; null for a file that is not packed.
 * @param {string} name relative to the repository, with slashes
 */
export function placeInPackage(name, ofPackage = packageName) {
  if (name in places) return ofPackage === packageName ? places[name] : null;
  const part = parts[ofPackage].find(({ from, has = () => true }) => name.startsWith(`${from}/`) && has(name));
  if (!part) return null;
  const place = [part.to, name.slice(part.from.length + 1)].filter((piece) => piece !== '').join('/');
  const isHidden = place.split('/').some((piece) => piece.startsWith('.'));
  return isHidden ? null : place;
}
