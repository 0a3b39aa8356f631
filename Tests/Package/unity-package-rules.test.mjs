import assert from 'node:assert/strict';
import test from 'node:test';
import { checkPackage, rules } from '../../scripts/pack/check_package.mjs';
import { importedObjectId, xxHash64 } from '../../scripts/pack/rules_of_assets.mjs';
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
  model: {fileID: ${importedObjectId('model')}, guid: ${modelGuid}, type: 3}
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

/** Asserts that only the named rule complains, once, with a message that matches. */
function complains(rule, changes, pattern) {
  const files = packageWith(changes);
  const found = Object.entries(rules).flatMap(([name, check]) => check(files).map((complaint) => [name, complaint]));
  assert.deepEqual(found.map(([name]) => name), [rule], JSON.stringify(found));
  assert.match(found[0][1], pattern);
}

const meta = (number, importer) => `fileFormatVersion: 2\nguid: ${guid(number)}\n${importer}\n`;
const edited = (fields) => (text) => JSON.stringify({ ...JSON.parse(text), ...fields });
const plugin = 'Runtime/Plugins/Linux/x64/libaudioplugin_haptoflow.so';

test('a good package has no complaints', () => assert.deepEqual(checkPackage(packageWith()), []));

test('a manifest without a semantic version is found', () => complains('manifest', { 'package.json': edited({ version: '1.2' }) }, /"version" is "1\.2"/));
test('a manifest that is no JSON is found', () => {
  assert.match(rules.manifest(packageWith({ 'package.json': '{' }))[0], /^package\.json: /);
  assert.match(rules.manifest(packageWith({ 'package.json': null }))[0], /is not there/);
});
test('a dependency with a range is found', () => complains('manifest', { 'package.json': edited({ dependencies: { 'com.example.runtime': '^0.4.9' } }) }, /takes no ranges/));
test('a sample whose folder is missing is found, and a folder that is no sample', () => {
  const files = packageWith({ 'package.json': edited({ samples: [{ displayName: 'A', description: 'B', path: 'Samples~/Tuoch' }] }) });
  const complaints = rules.manifest(files);
  assert.match(complaints[0], /no folder "Samples~\/Tuoch"/);
  assert.match(complaints[1], /^Samples~\/Touch: is not among "samples"/);
});

test('a path over 100 characters is found', () => {
  const name = `Documentation~/${'x'.repeat(83)}.md`;
  assert.equal(name.length, 101);
  complains('path lengths', { [name]: '' }, /101 characters/);
});
test('names that differ in case only are found', () => complains('upper and lower case', { 'Documentation~/Page.md': '' }, /upper and lower case/));

test('a file without .meta is found', () => complains('a .meta for everything', { 'Runtime/Touch.cs.meta': null }, /^Runtime\/Touch\.cs: has no \.meta/));
test('a folder without .meta is found', () => complains('a .meta for everything', { 'Runtime/Core.meta': null }, /^Runtime\/Core: has no \.meta/));
test('a file of a sample without .meta is found', () => complains('a .meta for everything', { 'Samples~/Touch/Notes.md': 'x' }, /^Samples~\/Touch\/Notes\.md/));
test('pages and samples without any .meta need none', () => {
  const manifest = edited({ samples: [...JSON.parse(goodFiles()['package.json']).samples, { displayName: 'A', description: 'B', path: 'Samples~/Plain' }] });
  assert.deepEqual(checkPackage(packageWith({ 'package.json': manifest, 'Samples~/Plain/a.csv': 't\n', 'Documentation~/.hidden': '' })), []);
});
test('a .meta without its file is found', () => complains('no .meta for nothing', { 'Runtime/Gone.cs.meta': meta(900, 'MonoImporter:') }, /^Runtime\/Gone\.cs\.meta: belongs to no file/));
test('a GUID that two files share is found', () => complains('GUIDs', { 'Runtime/Touch.cs.meta': (text) => text.replace(/guid: .*/, `guid: ${guid(1)}`) }, /has the GUID of/));
test('a .meta without a GUID is found', () => complains('GUIDs', { 'Runtime/Touch.cs.meta': 'fileFormatVersion: 2\nguid: XYZ\nMonoImporter:\n' }, /no line "guid: "/));
test('a .meta of another kind of file is found', () => complains('importers', { 'Runtime/Touch.cs.meta': meta(901, 'DefaultImporter:') }, /expected the settings of MonoImporter/));

test('an assembly definition that is no JSON is found', () => assert.match(rules['assembly names'](packageWith({ 'Runtime/Core/Core.asmdef': '{,' }))[0], /^Runtime\/Core\/Core\.asmdef: /));
test('two assemblies of one name are found', () => complains('assembly names', { 'Samples~/Touch/Felt.Touch.asmdef': edited({ name: 'Core' }) }, /the assembly "Core" is that of/));
test('a reference to an assembly that is not there is found', () => complains('assembly references', { 'Runtime/Felt.asmdef': edited({ references: ['Flet'] }) }, /reference "Flet": no assembly/));
test('a GUID reference that leads nowhere is found', () => complains('assembly references', { 'Editor/Felt.Editor.asmdef': edited({ references: [`GUID:${guid(999)}`] }) }, /no assembly of this name or GUID/));
test('an optional assembly without version define is found', () => complains('assembly references', { 'Samples~/Touch/Felt.Touch.asmdef': edited({ versionDefines: [] }) }, /version define of com\.unity\.inputsystem/));
test('the test runner outside of tests is found', () => complains('assembly references', { 'Runtime/Felt.asmdef': edited({ references: ['UnityEngine.TestRunner'] }) }, /UNITY_INCLUDE_TESTS/));
test('a runtime assembly that uses an editor assembly is found', () => complains('assembly references', { 'Runtime/Felt.asmdef': edited({ references: ['Felt.Editor'] }) }, /for players cannot use one for the editor/));
test('a package assembly that uses a sample\'s is found', () => complains('assembly references', { 'Runtime/Felt.asmdef': edited({ references: ['Felt.Touch'] }) }, /may not have imported/));
const withJson = (fields) => edited({ overrideReferences: true, precompiledReferences: ['Newtonsoft.Json.dll'], ...fields });
test('a precompiled library whose package is no dependency is found', () => {
  complains('precompiled references', { 'Runtime/Felt.asmdef': withJson({}) }, /expected com\.unity\.nuget\.newtonsoft-json among the dependencies/);
});
test('a precompiled library that no package is known to bring is found', () => {
  complains('precompiled references', { 'Runtime/Felt.asmdef': withJson({ precompiledReferences: ['Other.dll'] }) }, /no package is known/);
});
test('precompiled references that Unity does not read are found', () => {
  complains('precompiled references', { 'Runtime/Felt.asmdef': withJson({ overrideReferences: false }) }, /expected "overrideReferences": true/);
});
test('the test framework outside of tests is found', () => {
  complains('precompiled references', { 'Runtime/Felt.asmdef': withJson({ precompiledReferences: ['nunit.framework.dll'] }) }, /UNITY_INCLUDE_TESTS/);
});
test('a precompiled library of a dependency is fine', () => {
  const dependencies = { 'com.example.runtime': '0.4.9', 'com.unity.nuget.newtonsoft-json': '3.2.1' };
  assert.deepEqual(checkPackage(packageWith({ 'package.json': edited({ dependencies }), 'Runtime/Felt.asmdef': withJson({}) })), []);
});
test('a script that no assembly compiles is found', () => {
  complains('scripts in assemblies', { 'Stray.cs': 'class Stray { }', 'Stray.cs.meta': meta(902, 'MonoImporter:') }, /^Stray\.cs: no assembly definition/);
});

test('UnityEditor in a runtime assembly is found with its line', () => complains('namespaces', { 'Runtime/Touch.cs': 'class Touch {\n  UnityEditor.Editor e; }' }, /^Runtime\/Touch\.cs:2: UnityEditor\.Editor e/));
test('UnityEditor in the else branch of UNITY_EDITOR is found', () => complains('namespaces', { 'Runtime/Touch.cs': '#if UNITY_EDITOR\nclass A { }\n#else\nusing UnityEditor;\n#endif' }, /^Runtime\/Touch\.cs:4:/));
test('UnityEditor under "not UNITY_EDITOR" or "UNITY_EDITOR or more" is found', () => {
  complains('namespaces', { 'Runtime/Touch.cs': '#if !UNITY_EDITOR\nusing UnityEditor;\n#endif' }, /:2:/);
  complains('namespaces', { 'Runtime/Touch.cs': '#if UNITY_EDITOR || DEBUG\nusing UnityEditor;\n#endif' }, /:2:/);
});
test('UnityEditor in branches for the editor, comments and strings is fine', () => {
  const source = '#if A\n#elif UNITY_EDITOR\nusing UnityEditor;\n#endif\n#if !UNITY_EDITOR\n#else\nusing UnityEditor;\n#endif\n/* UnityEditor */ class T { string s = "UnityEditor"; } // UnityEditor';
  assert.deepEqual(checkPackage(packageWith({ 'Runtime/Touch.cs': source })), []);
});
test('UnityEngine in an assembly without engine references is found', () => complains('namespaces', { 'Runtime/Core/Law.cs': 'using UnityEngine;' }, /has no engine references/));
test('an editor assembly for all platforms is found', () => {
  assert.match(rules['assembly platforms'](packageWith({ 'Editor/Felt.Editor.asmdef': edited({ includePlatforms: [] }) }))[0], /"includePlatforms": \["Editor"\]/);
});
test('a test assembly without a define constraint for tests is found', () => {
  complains('assembly platforms', { 'Tests/Runtime/Felt.Tests.asmdef': edited({ references: ['Felt'], defineConstraints: [] }) }, /UNITY_INCLUDE_TESTS/);
});

test('a GUID in a scene that no file has is found with its line', () => {
  complains('GUIDs in assets', { 'Samples~/Touch/Touch.unity': (text) => text.replace(scriptGuid, guid(0xdead)) }, /Touch\.unity:7: GUID 0+dead: no file/);
});
test('a scene that names a file of another sample is found', () => {
  const changes = {
    'package.json': edited({ samples: [...JSON.parse(goodFiles()['package.json']).samples, { displayName: 'A', description: 'B', path: 'Samples~/Other' }] }),
    'Samples~/Other/Other.unity': scene,
    'Samples~/Other/Other.unity.meta': meta(903, 'DefaultImporter:'),
  };
  complains('GUIDs in assets', changes, /Other\.unity:7: GUID .* is Samples~\/Touch\/TouchScene\.cs/);
});
test('a reference inside a scene to an object that is not there is found', () => complains('anchors in assets', { 'Samples~/Touch/Touch.unity': (text) => text.replace('view: {fileID: 100}', 'view: {fileID: 102}') }, /no object has the anchor &102/));
test('two objects of one anchor are found', () => complains('anchors in assets', { 'Samples~/Touch/Touch.unity': (text) => `${text}--- !u!4 &101\n` }, /two objects have the anchor &101/));
test('a scene\'s script without the class of its name is found', () => complains('scripts of scenes', { 'Samples~/Touch/TouchScene.cs': 'class ToucScene { }' }, /expected a class TouchScene/));

test('a model whose .meta does not name its importer is found', () => {
  complains('importer of models', { 'Runtime/Models/m.haptoflow.meta': `fileFormatVersion: 2\nguid: ${modelGuid}\nScriptedImporter:\n` }, /expected the line " {2}script:/);
});
test('a scene that refers to a model by another fileID than the importer gives is found', () => {
  complains('models of scenes', { 'Editor/Importer.cs': (text) => text.replace('"model"', '"main"') }, new RegExp(`expected ${importedObjectId('main')}`));
});
test('a link to a page that is not there is found', () => complains('links of pages', { 'README.md': '[a](Documentation~/gone.md)' }, /links to Documentation~\/gone\.md/));
test('a link out of the package is found', () => complains('links of pages', { 'Documentation~/page.md': '[a](../../LICENSE)' }, /links to \.\.\/\.\.\/LICENSE/));

test('a library for another processor is found', () => {
  const other = Buffer.from(library);
  other.writeUInt16LE(183, 18);
  complains('native libraries', { [plugin]: other }, /is elf-arm64; expected elf-x86-64/);
});
test('an Android library that devices with pages of 16 KiB do not load is found', () => {
  const name = 'Runtime/Plugins/Android/arm64-v8a/libaudioplugin_haptoflow.so';
  const android = (alignment) => rules['native libraries'](packageWith({ [name]: elfOf({ machine: 183, libraries: ['libc.so'], alignment }) })).filter((each) => each.startsWith(name));
  assert.match(android(4096)[0], /aligned to 4096 bytes, expected 16384/);
  assert.deepEqual(android(16384), []);
});
test('a library that a player does not get is found', () => complains('native libraries', { [`${plugin}.meta`]: (text) => text.replace(/Linux64\n {4}second:\n {6}enabled: 1/, 'Linux64\n    second:\n      enabled: 0') }, /enabled for Editor; expected Editor, Linux64/));
test('a library of the wrong editor is found', () => complains('native libraries', { [`${plugin}.meta`]: (text) => text.replace('OS: Linux', 'OS: Windows') }, /the editor of OS Linux/));
test('a library that is not loaded at start is found', () => complains('native libraries', { [`${plugin}.meta`]: (text) => text.replace('isPreloaded: 1', 'isPreloaded: 0') }, /isPreloaded/));
test('a library in no platform\'s place is found', () => {
  const name = 'Runtime/Plugins/Linux/x64/other.so';
  complains('native libraries', { [name]: library, [`${name}.meta`]: meta(904, 'PluginImporter:') }, /other\.so: expected one of/);
});

test('hash and ids agree with the algorithm\'s test values and with published asset files', () => {
  assert.equal(xxHash64(Buffer.from('')).toString(16), 'ef46db3751d8e999');
  assert.equal(xxHash64(Buffer.from('Nobody inspects the spammish repetition')).toString(16), 'fbcea83c8a378bf1');
  assert.equal(importedObjectId('<root>'), '-944628639613478452');
  assert.equal(importedObjectId('tree'), '9197481963319205126');
  assert.equal(importedObjectId('stylesheet'), '7433441132597879392');
});
