// Packs the package and reads the tarball as Unity would.
import assert from 'node:assert/strict';
import { mkdtempSync, readFileSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test, { after, before } from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { repositoryFiles } from '../../scripts/lint/checks.mjs';
import { committedNatives } from '../../scripts/lib/libraries.mjs';
import { checkPackage } from '../../scripts/pack/check_package.mjs';
import { findNatives, foldersFor, pluginsFolder } from '../../scripts/pack/natives.mjs';
import { makeTarball, PackageFiles, readTarball } from '../../scripts/pack/package_files.mjs';
import { stagePackage } from '../../scripts/pack/stage.mjs';

const read = (...parts) => readFileSync(inRepository(...parts), 'utf8');
const { found, absent } = findNatives(foldersFor, new Set(), committedNatives());
let folder;
let tarball;
let files;

before(async () => {
  folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-package-'));
  stagePackage(path.join(folder, 'staged'), await repositoryFiles(), found);
  tarball = await makeTarball(path.join(folder, 'staged'), folder);
  files = await readTarball(tarball.file);
});

after(() => rmSync(folder, { recursive: true, force: true }));

test('Unity would refuse, leave out and lose nothing of the package', () => assert.deepEqual(checkPackage(files), []));

test('the tarball has every staged file', () => {
  assert.deepEqual(files.names, PackageFiles.inFolder(path.join(folder, 'staged')).names);
});

test('the tarball is named by the manifest\'s name and version, which are the repository\'s', () => {
  const { name, version, dependencies } = JSON.parse(files.text('package.json'));
  assert.equal(path.basename(tarball.file), `${name}-${version}.tgz`);
  const repository = JSON.parse(read('package.json'));
  assert.equal(version, repository.version);
  assert.match(files.text('CHANGELOG.md'), new RegExp(`^## \\[${version}\\]`, 'm'));
  const locked = JSON.parse(read('package-lock.json')).packages['node_modules/com.github.asus4.onnxruntime'].version;
  assert.equal(dependencies['com.github.asus4.onnxruntime'], locked);
});

test('the tarball has every library that was built or is in git with its import settings, and no settings of other platforms', () => {
  for (const { platform, file } of found) {
    const name = `${pluginsFolder}/${platform.place}`;
    assert.deepEqual(files.bytes(name), readFileSync(file), name);
    assert.ok(files.has(`${name}.meta`), name);
  }
  for (const { platform } of absent) {
    assert.deepEqual(files.names.filter((name) => name.startsWith(`${pluginsFolder}/${platform.place}`)), [], platform.name);
  }
});

test('the tarball has model, samples, documentation, tests, licence and notices', () => {
  const parts = [
    'Runtime/Models/default.haptoflow', 'Runtime/Mixer/HaptoFlow.mixer', 'Runtime/Core/HaptoFlow.Core.asmdef', 'Editor/HaptoFlow.Editor.asmdef',
    'Samples~/StylusTracing/StylusTracing.unity', 'Samples~/TextureGallery/TextureGallery.unity', 'Samples~/Workshop/Workshop.unity', 'Samples~/SimilarityStudy/SimilarityStudy.unity', 'Samples~/DeviceCheck/DeviceCheck.unity', 'Samples~/HeadlessScenes/crossing.scene.json',
    'Documentation~/installation.md', 'Documentation~/not-proven.md', 'Tests/Runtime/HaptoFlow.Tests.asmdef', 'Tests/Runtime/Support/SceneTest.cs',
    'README.md', 'CHANGELOG.md', 'LICENSE.md', 'Third Party Notices.md',
  ];
  for (const name of parts) assert.ok(files.has(name), name);
  assert.equal(files.text('LICENSE.md'), read('LICENSE'));
});

test('only the packed manifest lists the samples, since only a packed package has their folders', () => {
  const manifest = JSON.parse(read('Packages/com.haptoflow.runtime/package.json'));
  assert.ok(!('samples' in manifest));
  const { samples, ...packed } = JSON.parse(files.text('package.json'));
  assert.deepEqual(samples, JSON.parse(read('Samples~/samples.json')));
  assert.deepEqual(packed, manifest);
  assert.deepEqual(Object.keys(JSON.parse(files.text('package.json'))).slice(-3), ['dependencies', 'samples', 'author']);
});

test('the scene of Workshop is that of the repository\'s project, and its scripts are those of the package', () => {
  assert.equal(files.text('Samples~/Workshop/Workshop.unity'), read('Assets/Workshop.unity'));
  const stray = files.names.filter((name) => /^Samples~\/(?!.*Study\/).*\.(cs|asmdef)$/.test(name));
  assert.deepEqual(stray, []);
});

test('a player leaves the sample scenes out: nothing but a scene calls into their assembly', () => {
  const scripts = files.names.filter((name) => name.startsWith('Runtime/SampleScenes/') && name.endsWith('.cs'));
  assert.ok(scripts.length > 10);
  for (const name of scripts) assert.doesNotMatch(files.text(name), /AlwaysLinkAssembly|RuntimeInitializeOnLoad|\bPreserve\b/, name);
  const users = files.names.filter((name) => name.startsWith('Runtime/') && name.endsWith('.asmdef') && JSON.parse(files.text(name)).references.includes('HaptoFlow.SampleScenes'));
  assert.deepEqual(users, []);
});

test('the tarball has no tools, build outputs or other tests of the repository', () => {
  const strangers = files.names.filter((name) => /(^|\/)(bin|obj|node_modules)\/|^Tests\/(?!Runtime|Editor)|\.(cpp|hpp|py|mjs|csproj)$/.test(name));
  assert.deepEqual(strangers, []);
});

test('the shipped mixer carries the effect behind the attenuation, on a channel of its own, and is never suspended', () => {
  const mixer = files.text('Runtime/Mixer/HaptoFlow.mixer');
  assert.match(mixer, /m_EnableSuspend: 0/);
  const [, effects] = mixer.match(/m_Effects:\n((?: {2}- \{fileID: \d+\}\n)+)/);
  const order = [...effects.matchAll(/fileID: (\d+)/g)].map(([, anchor]) => mixer.match(new RegExp(`&${anchor}\\n[\\s\\S]*?m_EffectName: (.*)`))[1]);
  assert.deepEqual(order, ['Attenuation', 'HaptoFlow Voice']);
  const parameters = new Map([...mixer.matchAll(/m_ParameterName: (\w+)\n {4}m_GUID: ([0-9a-f]{32})/g)].map(([, name, id]) => [id, name]));
  const values = Object.fromEntries([...mixer.matchAll(/^ {4}([0-9a-f]{32}): (.*)$/gm)].map(([, id, value]) => [parameters.get(id), Number(value)]));
  assert.deepEqual(values, { Strength: 1, Voice: 0, Channel: 1 });
  const exposed = Object.fromEntries([...mixer.matchAll(/- guid: ([0-9a-f]{32})\n {4}name: (\w+)/g)].map(([, id, name]) => [name, parameters.get(id)]));
  assert.deepEqual(exposed, { HaptoFlowChannel: 'Channel', HaptoFlowStrength: 'Strength', HaptoFlowVoice: 'Voice' });
});

test('the mixer names the effect and its parameters as the native library declares them', () => {
  const mixer = files.text('Runtime/Mixer/HaptoFlow.mixer');
  const declared = [...read('NativePlugin', 'src', 'unity', 'voice_parameters.cpp').matchAll(/\.name = \{"(\w+)"\}/g)].map(([, name]) => name);
  assert.deepEqual([...mixer.matchAll(/m_ParameterName: (\w+)/g)].map(([, name]) => name), declared);
  const effects = [...mixer.matchAll(/m_EffectName: (.*)/g)].map(([, name]) => name);
  assert.match(read('NativePlugin', 'src', 'unity', 'audio_effect_entry.cpp'), new RegExp(`"${effects.at(-1)}"`));
});

test('the component looks for the voice under the name that the mixer exposes', () => {
  assert.match(files.text('Runtime/Outputs/HapticOutput.cs'), /voiceParameter = "HaptoFlowVoice"/);
});
