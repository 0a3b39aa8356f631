// Reads the Unity project in the repository's root as Unity would: every reference has its target, and opening it leaves
// nothing to write, as far as files can say.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { repositoryFiles } from '../../scripts/lib/lint_checks.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { PackageFiles } from '../../scripts/pack/package_files.mjs';
import { guidsByName } from '../../scripts/pack/rules_of_files.mjs';
import { manifestName, rules, writableFolders } from '../../scripts/pack/rules_of_projects.mjs';

const isOfProject = (name) => name.startsWith('ProjectSettings/') || name === manifestName || writableFolders.some((folder) => name.startsWith(`${folder}/`));
const files = new PackageFiles(new Map((await repositoryFiles()).filter(isOfProject).map((name) => [name, readFileSync(inRepository(name))])));
const feature = 'Packages/com.haptoflow.runtime/Runtime/OpenXr/MxInkInteraction.cs';

const complaintsOf = (changed) => Object.entries(rules).flatMap(([name, rule]) => rule(changed).map((complaint) => [name, complaint]));

test('every reference of the project has its target, and every asset its .meta', () => assert.deepEqual(complaintsOf(files), []));

/** The project with changes: text for a file, a function of its text, null to remove it. */
function projectWith(changes) {
  const contents = new Map(files.contents);
  for (const [name, change] of Object.entries(changes)) {
    if (change === null) contents.delete(name);
    else {
      const text = typeof change === 'function' ? change(files.text(name)) : change;
      assert.notEqual(text, contents.get(name)?.toString(), `${name}: the change changes nothing`);
      contents.set(name, text);
    }
  }
  return new PackageFiles(contents);
}

const manifest = 'Packages/manifest.json';
const without = (name) => (text) => JSON.stringify({ ...JSON.parse(text), dependencies: Object.fromEntries(Object.entries(JSON.parse(text).dependencies).filter(([key]) => key !== name)) });
const withVersion = (name, version) => (text) => JSON.stringify({ ...JSON.parse(text), dependencies: { ...JSON.parse(text).dependencies, [name]: version } });
const replaced = (from, to) => (text) => text.replace(from, to);
const guid = guidsByName(files).get('Packages/com.haptoflow.runtime/Runtime/Prefabs/Mouse Pen.prefab');
const meta = (number) => `fileFormatVersion: 2\nguid: ${number}\nDefaultImporter:\n`;

/** What is wrong, by the one rule that finds it; how the message reads. @type {[string, string, object, RegExp][]} */
const faults = [
  ['a package folder that is not there', 'packages', { [manifest]: withVersion('com.github.asus4.onnxruntime', 'file:../node_modules/com.github.asus4.gone') }, /there is no node_modules\/com\.github\.asus4\.gone\/package\.json; run npm ci/],
  ['a package folder with another package', 'packages', { [manifest]: withVersion('com.example.other', 'file:../Tests/Unity') }, /"com\.example\.other": Tests\/Unity has another name/],
  ['a dependency of the package in another version', 'packages', { [manifest]: withVersion('com.unity.nuget.newtonsoft-json', '3.0.2') }, /needs com\.unity\.nuget\.newtonsoft-json 3\.2\.1; .* gives 3\.0\.2/],
  ['a testable that is no package of the repository', 'packages', { [manifest]: (text) => JSON.stringify({ ...JSON.parse(text), testables: ['com.haptoflow.test'] }) }, /testable "com\.haptoflow\.test"/],
  ['a module that a scene misses', 'modules', { [manifest]: without('com.unity.modules.ai') }, /Assets\/\w+\.unity: an object of class 196 needs com\.unity\.modules\.ai/],
  ['a module that code misses', 'modules', { [manifest]: without('com.unity.modules.terrain') }, /\.cs: TerrainData needs com\.unity\.modules\.terrain/],
  ['an asset without .meta', 'a .meta for everything', { 'Assets/Note.txt': 'x' }, /^Assets\/Note\.txt: has no \.meta/],
  ['a .meta without asset', 'no .meta for nothing', { 'Assets/Note.txt.meta': meta('0123456789abcdef0123456789abcdef') }, /^Assets\/Note\.txt\.meta: belongs to no file/],
  ['a GUID that the project shares with the package', 'GUIDs', { 'Assets/Note.txt': 'x', 'Assets/Note.txt.meta': meta(guid) }, /has the GUID of/],
  ['a script that nothing has', 'targets of references', { 'Assets/Desk.unity': replaced(/(m_Script: \{fileID: 11500000, guid: )\w{31}/, '$1bad0bad0bad0bad0bad0bad0bad0bad') }, /^Assets\/Desk\.unity:\d+: GUID bad0\w+: no file/],
  ['an object that the prefab lacks', 'targets of references', { 'Assets/Desk.unity': replaced(/(m_CorrespondingSourceObject: \{fileID: )102,/, '$1902,') }, /Mouse Pen\.prefab has no object 902/],
  ['a changed field that the prefab lacks', 'changes of prefabs', { 'Assets/Desk.unity': replaced('propertyPath: m_LocalPosition.x', 'propertyPath: m_LocalPlace.x') }, /changes m_LocalPlace\.x of &101 in .*Mouse Pen\.prefab/],
  ['an object that hangs below no root', 'roots of scenes', { 'Assets/Desk.unity': replaced('  - {fileID: 600}\n', '') }, /the root &600 is not among SceneRoots/],
  ['a scene of the build that is not there', 'scenes of the build', { 'ProjectSettings/EditorBuildSettings.asset': replaced('Assets/Desk.unity', 'Assets/Table.unity') }, /there is no Assets\/Table\.unity/],
];

for (const [what, rule, changes, pattern] of faults) {
  test(`${rule}: ${what} is found, by that rule alone`, () => {
    const found = complaintsOf(projectWith(changes));
    assert.deepEqual([...new Set(found.map(([name]) => name))], [rule], JSON.stringify(found));
    assert.match(found[0][1], pattern);
  });
}

const setting = (name, key) => files.text(`ProjectSettings/${name}.asset`).match(new RegExp(`^ *${key}: (.*)$`, 'm'))?.[1];

/** Settings by their file; 256 is Best Latency, and the rate 0 that of the device. */
const settings = {
  ProjectSettings: { m_ActiveColorSpace: '1', activeInputHandler: '2', AndroidTargetArchitectures: '2' },
  AudioManager: { m_RequestedDSPBufferSize: '256', m_DSPBufferSize: '256', m_SampleRate: '0', m_EnableOutputSuspension: '0', m_DisableAudio: '0' },
  EditorSettings: { m_SerializationMode: '2' },
  VersionControlSettings: { m_Mode: 'Visible Meta Files' },
  UnityConnectSettings: { m_Enabled: '0' },
};
const privateKeys = ['cloudProjectId', 'organizationId', 'projectName', 'AndroidKeystoreName', 'appleDeveloperTeamID', 'ps4Passcode'];

test('colour is linear, both inputs are on, audio has the shortest block and never pauses, git can read the files, and no account or key is named', () => {
  for (const [name, wanted] of Object.entries(settings)) {
    assert.deepEqual(Object.fromEntries(Object.keys(wanted).map((key) => [key, setting(name, key)])), wanted, name);
  }
  for (const key of privateKeys) assert.equal(setting('ProjectSettings', key), '', key);
});

test('a player for Quest has IL2CPP and the model', () => {
  assert.match(files.text('ProjectSettings/ProjectSettings.asset'), /^ {2}scriptingBackend:\n {4}Android: 1$/m);
  assert.ok(Number(setting('ProjectSettings', 'AndroidMinSdkVersion')) >= 29);
  const own = guidsByName(files).get('Assets/HaptoFlow/HaptoFlowSettings.asset');
  assert.match(files.text('ProjectSettings/ProjectSettings.asset'), new RegExp(`^ {2}preloadedAssets:\n {2}- \\{fileID: 11400000, guid: ${own}, type: 2\\}$`, 'm'));
  const model = guidsByName(files).get('Packages/com.haptoflow.runtime/Runtime/Models/default.haptoflow');
  assert.match(files.text('Assets/HaptoFlow/HaptoFlowSettings.asset'), new RegExp(`^ {2}model: \\{fileID: -?\\d+, guid: ${model}, type: 3\\}$`, 'm'));
});

/** The objects of a YAML asset: number -> its text. */
const objectsOf = (name) => new Map([...files.text(name).matchAll(/^--- !u!\d+ &(-?\d+).*\n([\s\S]*?)(?=^--- |$(?![\s\S]))/gm)].map(([, id, text]) => [id, text]));
const fieldOf = (text, key) => text.match(new RegExp(`^ {2}${key}: (.*)$`, 'm'))?.[1];
const listOf = (text, key) => [...(text.match(new RegExp(`^ {2}${key}:\n((?: {2}- .*\n)*)`, 'm'))?.[1] ?? '').matchAll(/fileID: (-?\d+)/g)].map(([, id]) => id);
const namedIn = (objects, name) => [...objects.values()].find((text) => fieldOf(text, 'm_Name') === name);

test('OpenXR is on from the start on Android, and on Windows when a scene asks for it', () => {
  const objects = objectsOf('Assets/XR/XRGeneralSettingsPerBuildTarget.asset');
  const loader = guidsByName(files).get('Assets/XR/Loaders/OpenXRLoader.asset');
  for (const [platform, atStart] of [['Android', '1'], ['Standalone', '0']]) {
    const settings = namedIn(objects, `${platform} Settings`);
    assert.equal(fieldOf(settings, 'm_InitManagerOnStart'), atStart, platform);
    assert.match(objects.get(settings.match(/m_LoaderManagerInstance: \{fileID: (\d+)\}/)[1]), new RegExp(`m_Loaders:\n {2}- \\{fileID: 11400000, guid: ${loader}, type: 2\\}`), platform);
  }
  const starter = guidsByName(files).get('Assets/Scripts/StartHeadset.cs');
  assert.ok(files.text('Assets/Headset.unity').includes(starter));
  assert.ok(!files.text('Assets/Desk.unity').includes(starter), 'a desk starts no headset software');
});

test('MX Ink and the Touch controllers are on for both platforms, Quest for Android, and nothing else', () => {
  const objects = objectsOf('Assets/XR/Settings/OpenXR Package Settings.asset');
  const enabled = (platform) => listOf(namedIn(objects, platform), 'features').map((id) => objects.get(id)).filter((text) => fieldOf(text, 'm_enabled') === '1').map((text) => fieldOf(text, 'featureIdInternal'));
  const pens = ['com.haptoflow.input.mxink', 'com.unity.openxr.feature.input.oculustouch'];
  assert.deepEqual(enabled('Standalone').sort(), pens);
  assert.deepEqual(enabled('Android').sort(), [...pens, 'com.unity.openxr.feature.metaquest'].sort());
  assert.match(files.text(feature), /const string Id = "com\.haptoflow\.input\.mxink"/);
});

// OpenXR opens its page Project Validation, also for what it calls optional, where these are missing.
test('the controls of OpenXR are those that its validation asks for', () => {
  const defines = 'USE_INPUT_SYSTEM_POSE_CONTROL;USE_STICK_CONTROL_THUMBSTICKS';
  assert.ok(files.text('ProjectSettings/ProjectSettings.asset').includes(`  scriptingDefineSymbols:\n    Android: ${defines}\n    Standalone: ${defines}\n`));
});

const git = (...words) => spawnSync('git', words, { cwd: inRepository('.'), encoding: 'utf8' });
const isIgnored = (name) => git('check-ignore', '-q', '--no-index', name).status === 0;

test('git ignores nothing that the project is made of', () => {
  for (const name of [
    'Packages/manifest.json', 'ProjectSettings/ProjectSettings.asset', 'ProjectSettings/GraphicsSettings.asset', 'Assets/Desk.unity', 'Assets/Logs/x.txt', 'Assets/Library/x.asset',
    'Tests/Dotnet/HaptoFlow.Core.csproj', 'Tests/Dotnet/HaptoFlow.slnx', 'Packages/com.haptoflow.studies/Runtime/Logs/StudyLog.cs',
  ]) assert.ok(!isIgnored(name), name);
  assert.equal(git('ls-files', '--cached', '--ignored', '--exclude-standard').stdout, '');
});

test('the assembly that says what is missing refers to nothing that can be missing', () => {
  const definition = JSON.parse(files.text('Assets/Editor/HaptoFlow.ProjectCheck.asmdef'));
  for (const key of ['references', 'precompiledReferences', 'defineConstraints']) assert.deepEqual(definition[key], [], key);
  const used = files.endingIn('.cs').filter((name) => name.startsWith('Assets/Editor/')).flatMap((name) => [...files.text(name).matchAll(/^using ([\w.]+);$/gm)].map(([, space]) => space));
  assert.deepEqual(used.filter((space) => !['UnityEditor', 'UnityEngine'].includes(space) && !space.startsWith('System')), []);
  const { dependencies } = JSON.parse(files.text(manifest));
  assert.ok(files.text('Assets/Editor/RuntimeIsInstalled.cs').includes(`"${dependencies['com.github.asus4.onnxruntime'].replace('file:../', '')}/package.json"`));
});
