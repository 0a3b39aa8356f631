import { PackageFiles } from './package_files.mjs';
import { checkAssemblyNames, checkNamespaces, checkPlatforms, checkPrecompiled, checkReferences, checkScriptsBelong } from './rules_of_assemblies.mjs';
import { checkAnchors, checkAssetGuids, checkModelImporter, checkModelReferences, checkSceneScripts } from './rules_of_assets.mjs';
import { checkCase, checkGuids, checkImporters, checkLinks, checkManifest, checkMetasAreThere, checkMetasAreWanted, checkPathLengths } from './rules_of_files.mjs';
import { checkPlugins } from './rules_of_plugins.mjs';

/** The rules of a package by name. */
export const rules = {
  manifest: checkManifest,
  'path lengths': checkPathLengths,
  'upper and lower case': checkCase,
  'a .meta for everything': checkMetasAreThere,
  'no .meta for nothing': checkMetasAreWanted,
  GUIDs: checkGuids,
  importers: checkImporters,
  'assembly names': checkAssemblyNames,
  'assembly references': checkReferences,
  'precompiled references': checkPrecompiled,
  'scripts in assemblies': checkScriptsBelong,
  namespaces: checkNamespaces,
  'assembly platforms': checkPlatforms,
  'GUIDs in assets': checkAssetGuids,
  'anchors in assets': checkAnchors,
  'scripts of scenes': checkSceneScripts,
  'importer of models': checkModelImporter,
  'models of scenes': checkModelReferences,
  'links of pages': checkLinks,
  'native libraries': checkPlugins,
};

// Sorts before every file of the package, so that of two files with one GUID or name the package's own is complained of.
const besides = '.needed/';

/**
 * Checks a package for what Unity would refuse, leave out or lose.
 * @param {PackageFiles} files
 * @param {PackageFiles | null} needed the package that it depends on, to whose assemblies and assets it may refer
 * @returns {string[]} one line for each complaint: the file, what is wrong, what was expected; empty for a good package
 */
export function checkPackage(files, needed = null) {
  const brought = (needed?.names ?? []).map((name) => [`${besides}${name}`, needed.contents.get(name)]);
  const all = new PackageFiles(new Map([...files.contents, ...brought]));
  return Object.values(rules).flatMap((rule) => rule(all)).filter((complaint) => !complaint.startsWith(besides));
}
