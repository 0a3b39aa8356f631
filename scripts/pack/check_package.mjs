import { checkAssemblyNames, checkNamespaces, checkPlatforms, checkPrecompiled, checkReferences, checkScriptsBelong } from './rules/assemblies.mjs';
import { checkAnchors, checkAssetGuids, checkSceneScripts } from './rules/assets.mjs';
import { checkLinks } from './rules/links.mjs';
import { checkManifest } from './rules/manifest.mjs';
import { checkGuids, checkImporters, checkMetasAreThere, checkMetasAreWanted } from './rules/metas.mjs';
import { checkModelImporter, checkModelReferences } from './rules/models.mjs';
import { checkCase, checkPathLengths } from './rules/names.mjs';
import { checkPlugins } from './rules/plugins.mjs';

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

/**
 * Checks a package for what Unity would refuse, leave out or lose.
 * @param {import('./package_files.mjs').PackageFiles} files
 * @returns {string[]} one line for each complaint: the file, what is wrong, what was expected; empty for a good package
 */
export const checkPackage = (files) => Object.values(rules).flatMap((rule) => rule(files));
