import assert from 'node:assert/strict';
import test from 'node:test';
import { checkPackage, rules } from '../../scripts/pack/check_package.mjs';
import { modelObject } from '../../scripts/pack/rules_of_assets.mjs';
import { PackageFiles } from '../../scripts/pack/package_files.mjs';
import { elfOf } from './support/elf.mjs';

const guid = (number) => number.toString(16).padStart(32, '0');
const importerGuid = guid(0xa1);
const scriptGuid = guid(0xa2);
const modelGuid = guid(0xa3);
const asmdefGuid = guid(0xa4);
const librarySettings = `  isPreloaded: 1
  platformData:
  - first:
      : Any
    second:
      enabled: 0
      settings:
        Exclude Editor: 0
  - first:
      Editor: Editor
    second:
      enabled: 1
      settings:
        CPU: x86_64
        OS: Linux
  - first:
      Standalone: Linux64
    second:
      enabled: 1
      settings:
        CPU: x86_64
  userData: `;
const library = elfOf({ machine: 62 });

const asmdef = (fields) => JSON.stringify({ references: [], includePlatforms: [], defineConstraints: [], versionDefines: [], ...fields });
const scene = `--- !u!1 &100
GameObject:
  m_Component:
  - component: {fileID: 101}
--- !u!114 &101
MonoBehaviour:
  m_Script: {fileID: 11500000, guid: ${scriptGuid}, type: 3}
  sky: {fileID: 10304, guid: 0000000000000000f000000000000000, type: 0}
  model: {fileID: ${modelObject.id}, guid: ${modelGuid}, type: 3}
  view: {fileID: 100}
`;

/** A minimal package that satisfies every rule. */
function goodFiles() {
  const manifest = {
    name: 'com.example.felt', version: '1.2.3', displayName: 'Felt', description: 'Feels.', unity: '2022.3', license: 'MIT',
    dependencies: { 'com.example.runtime': '0.4.9' },
    samples: [{ displayName: 'Touch', description: 'A scene.', path: 'Samples~/Touch' }],
  };
  const importer = '[ScriptedImporter(1, "haptoflow")]\nclass Importer { void A() => ctx.AddObjectToAsset("model", x); }';
  return {
    'package.json': JSON.stringify(manifest),
    'README.md': 'See [the page](Documentation~/page.md#part).',
    'Documentation~/page.md': '[back](../README.md), [elsewhere](https://example.com/x.md)',
    'Runtime/Felt.asmdef': asmdef({ name: 'Felt', references: ['com.example.runtime'] }),
    'Runtime/Touch.cs': 'using UnityEngine;\n#if UNITY_EDITOR\nusing UnityEditor;\n#endif\nclass Touch { }',
    'Runtime/Core/Core.asmdef': asmdef({ name: 'Core', noEngineReferences: true }),
    'Runtime/Core/Law.cs': '// not UnityEngine\nclass Law { string a = "UnityEngine.Object"; }',
    'Runtime/Models/m.haptoflow': Buffer.from([1, 2, 3]),
    'Runtime/Plugins/Linux/x64/libaudioplugin_haptoflow.so': library,
    'Editor/Felt.Editor.asmdef': asmdef({ name: 'Felt.Editor', references: [`GUID:${asmdefGuid}`], includePlatforms: ['Editor'] }),
    'Editor/Importer.cs': `using UnityEditor;\n${importer}`,
    'Tests/Runtime/Felt.Tests.asmdef': asmdef({ name: 'Felt.Tests', references: ['Felt', 'UnityEngine.TestRunner'], defineConstraints: ['UNITY_INCLUDE_TESTS'] }),
    'Samples~/Touch/Touch.unity': scene,
    'Samples~/Touch/TouchScene.cs': 'class TouchScene { }',
    'Samples~/Touch/Felt.Touch.asmdef': asmdef({ name: 'Felt.Touch', references: ['Felt', 'Unity.InputSystem'], versionDefines: [{ name: 'com.unity.inputsystem' }] }),
  };
}

const fixedGuids = {
  'Editor/Importer.cs': importerGuid, 'Samples~/Touch/TouchScene.cs': scriptGuid, 'Runtime/Models/m.haptoflow': modelGuid, 'Runtime/Felt.asmdef': asmdefGuid,
};
const importerOf = (name) => {
  if (name.endsWith('.cs')) return 'MonoImporter:';
  if (name.endsWith('.asmdef')) return 'AssemblyDefinitionImporter:';
  if (name.endsWith('.so')) return `PluginImporter:\n${librarySettings}`;
  if (name.endsWith('.haptoflow')) return `ScriptedImporter:\n  script: {fileID: 11500000, guid: ${importerGuid}, type: 3}`;
  return name === 'package.json' ? 'PackageManifestImporter:' : 'DefaultImporter:';
};

/** The good package with its .meta files and with changes: text or bytes for a file, null to remove it. */
function packageWith(changes = {}) {
  const contents = new Map(Object.entries(goodFiles()));
  const imported = (name) => !/(^|\/)[^/]*~(\/|$)/.test(name) || name.startsWith('Samples~/Touch/');
  const plain = new PackageFiles(contents);
  [...plain.folders, ...plain.names].filter(imported).forEach((name, index) => {
    contents.set(`${name}.meta`, `fileFormatVersion: 2\nguid: ${fixedGuids[name] ?? guid(index + 1)}\n${importerOf(name)}\n  externalObjects: {}\n`);
  });
  for (const [name, change] of Object.entries(changes)) {
    if (change === null) contents.delete(name);
    else contents.set(name, typeof change === 'function' ? change(contents.get(name).toString()) : change);
  }
  return new PackageFiles(contents);
}

const meta = (number, importer) => `fileFormatVersion: 2\nguid: ${guid(number)}\n${importer}\n`;
const edited = (fields) => (text) => JSON.stringify({ ...JSON.parse(text), ...fields });
const replaced = (from, to) => (text) => text.replace(from, to);
const withSample = (place) => edited({ samples: [...JSON.parse(goodFiles()['package.json']).samples, { displayName: 'A', description: 'B', path: place }] });
const withJson = (fields) => edited({ overrideReferences: true, precompiledReferences: ['Newtonsoft.Json.dll'], ...fields });
const [felt, touch, plugin] = ['Runtime/Felt.asmdef', 'Samples~/Touch/Felt.Touch.asmdef', 'Runtime/Plugins/Linux/x64/libaudioplugin_haptoflow.so'];
const forArm = Buffer.from(library);
forArm.writeUInt16LE(183, 18);

/** What is wrong, by the one rule that finds it; how the message reads. @type {[string, string, object, RegExp][]} */
const faults = [
  ['a version that is not semantic', 'manifest', { 'package.json': edited({ version: '1.2' }) }, /"version" is "1\.2"/],
  ['a dependency with a range', 'manifest', { 'package.json': edited({ dependencies: { 'com.example.runtime': '^0.4.9' } }) }, /takes no ranges/],
  ['a sample without its folder', 'manifest', { 'package.json': withSample('Samples~/Tuoch') }, /no folder "Samples~\/Tuoch"/],
  ['a folder that is no sample', 'manifest', { 'Samples~/Other/a.csv': '' }, /^Samples~\/Other: is not among "samples"/],
  ['a path over 100 characters', 'path lengths', { [`Documentation~/${'x'.repeat(83)}.md`]: '' }, /101 characters/],
  ['names that differ in case only', 'upper and lower case', { 'Documentation~/Page.md': '' }, /upper and lower case/],
  ['a file without .meta', 'a .meta for everything', { 'Runtime/Touch.cs.meta': null }, /^Runtime\/Touch\.cs: has no \.meta/],
  ['a folder without .meta', 'a .meta for everything', { 'Runtime/Core.meta': null }, /^Runtime\/Core: has no \.meta/],
  ['a file of a sample without .meta', 'a .meta for everything', { 'Samples~/Touch/Notes.md': 'x' }, /^Samples~\/Touch\/Notes\.md/],
  ['a .meta without its file', 'no .meta for nothing', { 'Runtime/Gone.cs.meta': meta(900, 'MonoImporter:') }, /^Runtime\/Gone\.cs\.meta: belongs to no file/],
  ['a GUID that two files share', 'GUIDs', { 'Runtime/Touch.cs.meta': replaced(/guid: .*/, `guid: ${guid(1)}`) }, /has the GUID of/],
  ['a .meta without a GUID', 'GUIDs', { 'Runtime/Touch.cs.meta': 'fileFormatVersion: 2\nguid: XYZ\nMonoImporter:\n' }, /no line "guid: "/],
  ['a .meta of another kind of file', 'importers', { 'Runtime/Touch.cs.meta': meta(901, 'DefaultImporter:') }, /expected the settings of MonoImporter/],
  ['two assemblies of one name', 'assembly names', { [touch]: edited({ name: 'Core' }) }, /the assembly "Core" is that of/],
  ['an assembly that is not there', 'assembly references', { [felt]: edited({ references: ['Flet'] }) }, /reference "Flet": no assembly/],
  ['a GUID of no assembly', 'assembly references', { 'Editor/Felt.Editor.asmdef': edited({ references: [`GUID:${guid(999)}`] }) }, /no assembly of this name or GUID/],
  ['an optional assembly without version define', 'assembly references', { [touch]: edited({ versionDefines: [] }) }, /version define of com\.unity\.inputsystem/],
  ['the test runner outside of tests', 'assembly references', { [felt]: edited({ references: ['UnityEngine.TestRunner'] }) }, /UNITY_INCLUDE_TESTS/],
  ['a player that needs the editor', 'assembly references', { [felt]: edited({ references: ['Felt.Editor'] }) }, /for players cannot use one for the editor/],
  ['a package that needs a sample', 'assembly references', { [felt]: edited({ references: ['Felt.Touch'] }) }, /may not have imported/],
  ['a library without its package', 'precompiled references', { [felt]: withJson({}) }, /expected com\.unity\.nuget\.newtonsoft-json among the dependencies/],
  ['a library that no package brings', 'precompiled references', { [felt]: withJson({ precompiledReferences: ['Other.dll'] }) }, /no package is known/],
  ['a list of libraries that Unity does not read', 'precompiled references', { [felt]: withJson({ overrideReferences: false }) }, /expected "overrideReferences": true/],
  ['the test framework outside of tests', 'precompiled references', { [felt]: withJson({ precompiledReferences: ['nunit.framework.dll'] }) }, /UNITY_INCLUDE_TESTS/],
  ['a script that no assembly compiles', 'scripts in assemblies', { 'Stray.cs': 'class Stray { }', 'Stray.cs.meta': meta(902, 'MonoImporter:') }, /^Stray\.cs: no assembly definition/],
  ['UnityEditor in a player', 'namespaces', { 'Runtime/Touch.cs': 'class Touch {\n  UnityEditor.Editor e; }' }, /^Runtime\/Touch\.cs:2: UnityEditor\.Editor e/],
  ['UnityEditor in the else of UNITY_EDITOR', 'namespaces', { 'Runtime/Touch.cs': '#if UNITY_EDITOR\nclass A { }\n#else\nusing UnityEditor;\n#endif' }, /:4:/],
  ['UnityEditor under "not UNITY_EDITOR"', 'namespaces', { 'Runtime/Touch.cs': '#if !UNITY_EDITOR\nusing UnityEditor;\n#endif' }, /:2:/],
  ['UnityEditor under "UNITY_EDITOR or more"', 'namespaces', { 'Runtime/Touch.cs': '#if UNITY_EDITOR || DEBUG\nusing UnityEditor;\n#endif' }, /:2:/],
  ['UnityEngine without engine references', 'namespaces', { 'Runtime/Core/Law.cs': 'using UnityEngine;' }, /has no engine references/],
  ['tests in every project', 'assembly platforms', { 'Tests/Runtime/Felt.Tests.asmdef': edited({ references: ['Felt'], defineConstraints: [] }) }, /UNITY_INCLUDE_TESTS/],
  ['a GUID in a scene that no file has', 'GUIDs in assets', { 'Samples~/Touch/Touch.unity': replaced(scriptGuid, guid(0xdead)) }, /Touch\.unity:7: GUID 0+dead: no file/],
  ['a scene with a file of another sample', 'GUIDs in assets', { 'package.json': withSample('Samples~/Other'), 'Samples~/Other/Other.unity': scene, 'Samples~/Other/Other.unity.meta': meta(903, 'DefaultImporter:') }, /Other\.unity:7: GUID .* is Samples~\/Touch\/TouchScene\.cs/],
  ['a scene without an object that it names', 'anchors in assets', { 'Samples~/Touch/Touch.unity': replaced('view: {fileID: 100}', 'view: {fileID: 102}') }, /no object has the anchor &102/],
  ['two objects of one anchor', 'anchors in assets', { 'Samples~/Touch/Touch.unity': (text) => `${text}--- !u!4 &101\n` }, /two objects have the anchor &101/],
  ['a script without the class of its name', 'scripts of scenes', { 'Samples~/Touch/TouchScene.cs': 'class ToucScene { }' }, /expected a class TouchScene/],
  ['a model without its importer', 'importer of models', { 'Runtime/Models/m.haptoflow.meta': `fileFormatVersion: 2\nguid: ${modelGuid}\nScriptedImporter:\n` }, /expected the line " {2}script:/],
  ['an importer that names models otherwise', 'models of scenes', { 'Editor/Importer.cs': replaced('"model"', '"main"') }, /adds models as "main"; expected "model"/],
  ['a model under another fileID', 'models of scenes', { 'Samples~/Touch/Touch.unity': replaced(modelObject.id, '11400000') }, /as fileID 11400000; expected 1022318259475508783/],
  ['a link to no page', 'links of pages', { 'README.md': '[a](Documentation~/gone.md)' }, /links to Documentation~\/gone\.md/],
  ['a link out of the package', 'links of pages', { 'Documentation~/page.md': '[a](../../LICENSE)' }, /links to \.\.\/\.\.\/LICENSE/],
  ['a library for another processor', 'native libraries', { [plugin]: forArm }, /is elf-arm64; expected elf-x86-64/],
  ['a library that a player does not get', 'native libraries', { [`${plugin}.meta`]: replaced(/Linux64\n {4}second:\n {6}enabled: 1/, 'Linux64\n    second:\n      enabled: 0') }, /enabled for Editor; expected Editor, Linux64/],
  ['a library of the wrong editor', 'native libraries', { [`${plugin}.meta`]: replaced('OS: Linux', 'OS: Windows') }, /the editor of OS Linux/],
  ['a library that is not loaded at start', 'native libraries', { [`${plugin}.meta`]: replaced('isPreloaded: 1', 'isPreloaded: 0') }, /isPreloaded/],
  ['a library in no platform\'s place', 'native libraries', { 'Runtime/Plugins/Linux/x64/other.so': library, 'Runtime/Plugins/Linux/x64/other.so.meta': meta(904, 'PluginImporter:') }, /other\.so: expected one of/],
];

for (const [what, rule, changes, pattern] of faults) {
  test(`${rule}: ${what} is found, by that rule alone`, () => {
    const files = packageWith(changes);
    const found = Object.entries(rules).flatMap(([name, check]) => check(files).map((complaint) => [name, complaint]));
    assert.deepEqual(found.map(([name]) => name), [rule], JSON.stringify(found));
    assert.match(found[0][1], pattern);
  });
}

const good = {
  'as it is': {},
  'samples and pages without any .meta': { 'package.json': withSample('Samples~/Plain'), 'Samples~/Plain/a.csv': 't\n', 'Documentation~/.hidden': '' },
  'a library of a dependency': { 'package.json': edited({ dependencies: { 'com.example.runtime': '0.4.9', 'com.unity.nuget.newtonsoft-json': '3.2.1' } }), [felt]: withJson({}) },
  'UnityEditor in branches for the editor, comments and strings': {
    'Runtime/Touch.cs': '#if A\n#elif UNITY_EDITOR\nusing UnityEditor;\n#endif\n#if !UNITY_EDITOR\n#else\nusing UnityEditor;\n#endif\n/* UnityEditor */ class T { string s = "UnityEditor"; } // UnityEditor',
  },
};
for (const [what, changes] of Object.entries(good)) test(`a good package has no complaints: ${what}`, () => assert.deepEqual(checkPackage(packageWith(changes)), []));

test('files that are no JSON are named, and an editor assembly for all platforms', () => {
  const first = (rule, changes) => rules[rule](packageWith(changes))[0];
  assert.match(first('manifest', { 'package.json': '{' }), /^package\.json: /);
  assert.match(first('manifest', { 'package.json': null }), /is not there/);
  assert.match(first('assembly names', { 'Runtime/Core/Core.asmdef': '{,' }), /^Runtime\/Core\/Core\.asmdef: /);
  assert.match(first('assembly platforms', { 'Editor/Felt.Editor.asmdef': edited({ includePlatforms: [] }) }), /"includePlatforms": \["Editor"\]/);
});

test('an Android library that devices with pages of 16 KiB do not load is found', () => {
  const name = 'Runtime/Plugins/Android/arm64-v8a/libaudioplugin_haptoflow.so';
  const android = (alignment) => rules['native libraries'](packageWith({ [name]: elfOf({ machine: 183, libraries: ['libc.so'], alignment }) })).filter((each) => each.startsWith(name));
  assert.match(android(4096)[0], /aligned to 4096 bytes, expected 16384/);
  assert.deepEqual(android(16384), []);
});

test('a package may refer to the package that it needs, whose own faults are not its own', () => {
  const needed = packageWith({ 'Runtime/Touch.cs.meta': null });
  const contents = {
    'package.json': JSON.stringify({ name: 'com.example.more', version: '0.1.0', displayName: 'More', description: 'More.', unity: '2022.3', license: 'MIT', dependencies: { 'com.example.felt': '0.1.0' } }),
    'More.asmdef': asmdef({ name: 'More', references: ['Felt'] }),
  };
  const more = new PackageFiles(new Map(Object.entries(contents).flatMap(([name, text], index) => [[name, text], [`${name}.meta`, `fileFormatVersion: 2\nguid: ${guid(800 + index)}\n${importerOf(name)}\n`]])));
  assert.deepEqual(checkPackage(more, needed), []);
  assert.match(checkPackage(more)[0], /reference "Felt": no assembly/);
});
