import { isImported, sampleOf } from './package_files.mjs';
import { guidsByName } from './rules_of_files.mjs';

const testConstraint = 'UNITY_INCLUDE_TESTS';
const testAssemblies = ['UnityEngine.TestRunner', 'UnityEditor.TestRunner'];

/** Assemblies of optional packages, and the package whose version define must guard a reference to them. */
const optionalAssemblies = {
  'Unity.InputSystem': 'com.unity.inputsystem',
  'Unity.XR.Management': 'com.unity.xr.management',
  'Unity.XR.OpenXR': 'com.unity.xr.openxr',
  'Unity.XR.OpenXR.Editor': 'com.unity.xr.openxr',
  'Oculus.VR': 'com.meta.xr.sdk.core',
};

/** Precompiled libraries that an assembly may reference, and the package that brings each; null for Unity's test framework. */
const precompiledLibraries = {
  'Newtonsoft.Json.dll': 'com.unity.nuget.newtonsoft-json',
  'nunit.framework.dll': null,
};

/** The assembly definitions of a package: {file, folder, definition}. Files that are not JSON are reported by another rule. */
export function assembliesOf(files) {
  return files.endingIn('.asmdef').flatMap((file) => {
    try {
      return [{ file, folder: file.includes('/') ? file.slice(0, file.lastIndexOf('/')) : '', definition: JSON.parse(files.text(file)) }];
    } catch {
      return [];
    }
  });
}

const isEditorOnly = ({ definition }) => JSON.stringify(definition.includePlatforms ?? []) === '["Editor"]';
const isTest = ({ definition }) => (definition.defineConstraints ?? []).includes(testConstraint);

/** Every assembly definition parses, and no two have the same name. */
export function checkAssemblyNames(files) {
  const complaints = [];
  const owners = new Map();
  for (const file of files.endingIn('.asmdef')) {
    let name;
    try {
      ({ name } = JSON.parse(files.text(file)));
    } catch (error) {
      complaints.push(`${file}: ${error.message}`);
      continue;
    }
    if (typeof name !== 'string' || name === '') complaints.push(`${file}: has no "name"`);
    else if (owners.has(name)) complaints.push(`${file}: the assembly "${name}" is that of ${owners.get(name)}`);
    else owners.set(name, file);
  }
  return complaints;
}

/** References name assemblies of the package, of its dependencies, or of optional packages guarded by a version define. */
export function checkReferences(files) {
  const assemblies = assembliesOf(files);
  const byName = new Map(assemblies.map((assembly) => [assembly.definition.name, assembly]));
  const byGuid = new Map([...guidsByName(files)].map(([name, guid]) => [guid, assemblies.find(({ file }) => file === name)]));
  const dependencies = Object.keys(readDependencies(files));
  return assemblies.flatMap((assembly) =>
    (assembly.definition.references ?? []).flatMap((reference) => {
      const wanted = reference.startsWith('GUID:') ? byGuid.get(reference.slice('GUID:'.length)) : byName.get(reference);
      const why = wanted ? whyNotTo(assembly, wanted) : whyNotOutside(assembly, reference, dependencies);
      return why ? [`${assembly.file}: reference "${reference}": ${why}`] : [];
    }),
  );
}

/** Precompiled libraries come from a dependency of the package, and Unity reads their list only where "overrideReferences" is set. */
export function checkPrecompiled(files) {
  const dependencies = Object.keys(readDependencies(files));
  return assembliesOf(files).flatMap(({ file, definition }) =>
    (definition.precompiledReferences ?? []).flatMap((library) => {
      const complain = (why) => [`${file}: precompiled reference "${library}": ${why}`];
      if (definition.overrideReferences !== true) return complain('expected "overrideReferences": true');
      if (!(library in precompiledLibraries)) return complain('no package is known that brings it');
      const needed = precompiledLibraries[library];
      if (needed === null) return isTest({ definition }) ? [] : complain(`expected "${testConstraint}" among "defineConstraints"`);
      return dependencies.includes(needed) ? [] : complain(`expected ${needed} among the dependencies in package.json`);
    }),
  );
}

function readDependencies(files) {
  try {
    return JSON.parse(files.text('package.json')).dependencies ?? {};
  } catch {
    return {};
  }
}

function whyNotTo(assembly, wanted) {
  if (isEditorOnly(wanted) && !isEditorOnly(assembly)) return 'an assembly for players cannot use one for the editor';
  const sample = sampleOf(wanted.file);
  return sample !== null && sample !== sampleOf(assembly.file) ? `is in ${sample}, which a project may not have imported` : null;
}

function whyNotOutside({ definition }, reference, dependencies) {
  if (testAssemblies.includes(reference)) {
    return (definition.defineConstraints ?? []).includes(testConstraint) ? null : `expected "${testConstraint}" among "defineConstraints"`;
  }
  if (dependencies.includes(reference)) return null;
  const needed = optionalAssemblies[reference];
  if (needed === undefined) return 'no assembly of this name or GUID in the package or its dependencies';
  const isGuarded = (definition.versionDefines ?? []).some(({ name }) => name === needed);
  return isGuarded ? null : `expected a version define of ${needed}, which a project may lack`;
}

/** The assembly that compiles a source: the definition in the nearest folder above it. */
function ownerOf(name, assemblies) {
  const above = assemblies.filter(({ folder }) => folder === '' || name.startsWith(`${folder}/`));
  return above.sort((a, b) => b.folder.length - a.folder.length)[0] ?? null;
}

/** Every script belongs to an assembly definition: Unity does not compile other scripts of a package. */
export function checkScriptsBelong(files) {
  const assemblies = assembliesOf(files);
  return files
    .endingIn('.cs')
    .filter((name) => (isImported(name) || sampleOf(name) !== null) && ownerOf(name, assemblies) === null)
    .map((name) => `${name}: no assembly definition in its folder or above`);
}

/** Runtime assemblies use no editor namespace, and assemblies without engine references no engine namespace. */
export function checkNamespaces(files) {
  const assemblies = assembliesOf(files);
  const complaints = [];
  for (const name of files.endingIn('.cs')) {
    const owner = ownerOf(name, assemblies);
    if (owner === null || isEditorOnly(owner)) continue;
    const lines = playerLines(files.text(name));
    const where = ({ number, text }) => `${name}:${number}: ${text.trim()}`;
    for (const line of linesNaming(lines, 'UnityEditor')) {
      complaints.push(`${where(line)}: ${owner.definition.name} is for players; expected #if UNITY_EDITOR around it`);
    }
    if (!owner.definition.noEngineReferences) continue;
    for (const line of linesNaming(lines, 'UnityEngine')) complaints.push(`${where(line)}: ${owner.definition.name} has no engine references`);
  }
  return complaints;
}

/** Assemblies in folders named Editor are for the editor only, and those in Tests only for projects that run tests. */
export function checkPlatforms(files) {
  return assembliesOf(files).flatMap((assembly) => {
    const complaints = [];
    const { file } = assembly;
    if (file.startsWith('Editor/') && !isEditorOnly(assembly)) complaints.push(`${file}: expected "includePlatforms": ["Editor"]`);
    if (file.startsWith('Tests/') && !isTest(assembly)) complaints.push(`${file}: expected "${testConstraint}" among "defineConstraints"`);
    if (file.startsWith('Tests/Editor/') && !isEditorOnly(assembly)) complaints.push(`${file}: expected "includePlatforms": ["Editor"]`);
    return complaints;
  });
}

/** Reads C# sources for the package checker: which lines only the editor compiles. */

/** The source with comments and the content of strings replaced by spaces; line numbers stay. */
export function withoutCommentsAndStrings(source) {
  const blank = (text) => text.replace(/[^\n]/g, ' ');
  const pattern = /\/\/[^\n]*|\/\*[\s\S]*?\*\/|\$?@"(?:[^"]|"")*"|@\$"(?:[^"]|"")*"|\$?"(?:\\.|[^"\\\n])*"|'(?:\\.|[^'\\\n])+'/g;
  return source.replace(pattern, blank);
}

const onlyInEditor = (condition) => /(^|[^!\w])UNITY_EDITOR\b/.test(condition) && !condition.includes('||');

/**
 * The lines that a player compiles, numbered from 1: those outside the branches for UNITY_EDITOR.
 * @returns {{number: number, text: string}[]}
 */
export function playerLines(source) {
  const open = [];
  const lines = [];
  withoutCommentsAndStrings(source).split('\n').forEach((text, index) => {
    const directive = text.match(/^\s*#\s*(if|elif|else|endif)\b(.*)$/);
    if (!directive) {
      if (!open.some((branch) => branch.isEditor)) lines.push({ number: index + 1, text });
      return;
    }
    const [, word, condition] = directive;
    if (word === 'if') open.push({ isEditor: onlyInEditor(condition), condition });
    else if (word === 'endif') open.pop();
    else if (open.length > 0) {
      const before = open.pop().condition;
      const isElseOfPlayer = word === 'else' && /!\s*UNITY_EDITOR\b/.test(before) && !before.includes('&&');
      open.push({ isEditor: word === 'elif' ? onlyInEditor(condition) : isElseOfPlayer, condition });
    }
  });
  return lines;
}

/** Lines that name a namespace or one nested in it, such as "UnityEditor" or "UnityEditor.Build". */
export const linesNaming = (lines, namespace) => lines.filter(({ text }) => new RegExp(`(^|[^\\w.])${namespace}\\b`).test(text));
