// Packs both packages and reads their tarballs as Unity would; reads the folders as Unity gets them from a git URL.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test, { after, before } from 'node:test';
import { committedNatives } from '../../scripts/lib/libraries.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { repositoryFiles } from '../../scripts/lib/lint_checks.mjs';
import { checkPackage } from '../../scripts/pack/check_package.mjs';
import { dependencyName, packDependency } from '../../scripts/pack/dependency.mjs';
import { packageName, studiesName } from '../../scripts/pack/layout.mjs';
import { findNatives, foldersFor, pluginsFolder } from '../../scripts/pack/natives.mjs';
import { makeTarball, PackageFiles, readTarball } from '../../scripts/pack/package_files.mjs';
import { stagePackage, stageStudies } from '../../scripts/pack/stage.mjs';

const read = (...parts) => readFileSync(inRepository(...parts), 'utf8');
const { found, absent } = findNatives(foldersFor, new Set(), committedNatives());
const names = await repositoryFiles();
const { version } = JSON.parse(read('package.json'));
let folder;
let tarball;
let files;
let studies;

before(async () => {
  folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-package-'));
  stagePackage(path.join(folder, 'staged'), names, found);
  stageStudies(path.join(folder, 'studies'), names);
  tarball = await makeTarball(path.join(folder, 'staged'), folder);
  files = await readTarball(tarball.file);
  studies = await readTarball((await makeTarball(path.join(folder, 'studies'), folder)).file);
});

after(() => rmSync(folder, { recursive: true, force: true }));

test('Unity would refuse, leave out and lose nothing of the packages, and a tarball has every staged file', () => {
  assert.deepEqual(checkPackage(files), []);
  assert.deepEqual(checkPackage(studies, files), []);
  assert.deepEqual(files.names, PackageFiles.inFolder(path.join(folder, 'staged')).names);
});

test('the tarballs have the repository\'s version; one needs ONNX Runtime as it is locked, the other needs the first', () => {
  const manifest = JSON.parse(files.text('package.json'));
  assert.equal(path.basename(tarball.file), `${packageName}-${version}.tgz`);
  assert.match(files.text('CHANGELOG.md'), new RegExp(`^## \\[${version}\\]`, 'm'));
  assert.equal(manifest.dependencies[dependencyName], JSON.parse(read('package-lock.json')).packages[`node_modules/${dependencyName}`].version);
  const { name, version: ofStudies, dependencies } = JSON.parse(studies.text('package.json'));
  assert.deepEqual({ name, ofStudies, dependencies }, { name: studiesName, ofStudies: version, dependencies: { [packageName]: version } });
});

test('the tarball has every library that was built or is in git with its import settings, and no settings of other platforms', () => {
  for (const { platform, file } of found) {
    const name = `${pluginsFolder}/${platform.place}`;
    assert.deepEqual(files.bytes(name), readFileSync(file), name);
    assert.ok(files.has(`${name}.meta`), name);
  }
  for (const { platform } of absent) assert.deepEqual(files.names.filter((name) => name.startsWith(`${pluginsFolder}/${platform.place}`)), [], platform.name);
});

test('the tarballs have model, samples, pages, tests, licence and notices, and nothing else of the repository', () => {
  const parts = [
    'Runtime/Models/default.haptoflow', 'Runtime/Prefabs/HaptoFlow.mixer', 'Editor/HaptoFlow.Editor.asmdef', 'Samples~/StylusTracing/StylusTracing.unity', 'Samples~/HeadlessScenes/crossing.scene.json',
    'Documentation~/installation.md', 'Documentation~/index.html', 'Tests/Runtime/HaptoFlow.Tests.asmdef', 'CHANGELOG.md', 'Third Party Notices.md',
  ];
  for (const name of parts) assert.ok(files.has(name), name);
  for (const name of ['Runtime/HaptoFlow.Studies.asmdef', 'Samples~/LatencyStudy/LatencyStudy.unity', 'Samples~/SimilarityStudy/SimilarityStudySettings.asset']) assert.ok(studies.has(name), name);
  assert.ok(studies.endingIn('.md').some((name) => name.startsWith('Documentation~/')));
  for (const each of [files, studies]) assert.equal(each.text('LICENSE.md'), read('LICENSE'));
  const strangers = [...files.names, ...studies.names].filter((name) => /(^|\/)(bin|obj|node_modules)\/|^Tests\/(?!Runtime|Editor)|\.(cpp|hpp|py|mjs|csproj)$/.test(name));
  assert.deepEqual(strangers, []);
  assert.deepEqual(files.names.filter((name) => /Stud(y|ies)\//.test(name)), [], 'studies are no part of the everyday package');
});

test('only the packed manifest lists the samples, since only a packed package has their folders; the scene of Workshop is the project\'s', () => {
  const manifest = JSON.parse(read('Packages', packageName, 'package.json'));
  const { samples, ...packed } = JSON.parse(files.text('package.json'));
  assert.deepEqual([samples, packed], [JSON.parse(read('Samples~/samples.json')), manifest]);
  assert.ok(!('samples' in manifest));
  assert.equal(files.text('Samples~/Workshop/Workshop.unity'), read('Assets/Workshop.unity'));
});

test('a link to a page of the other package becomes the page\'s name', () => {
  assert.match(files.text('Documentation~/index.md'), /\(`stud[\w-]+\.md` of HaptoFlow Studies\)/);
  assert.ok(studies.names.some((name) => name.endsWith('.md') && /\(`installation\.md` of HaptoFlow\)/.test(studies.text(name))));
});

test('a player leaves the sample scenes out: nothing but a scene calls into their assembly', () => {
  const scripts = files.names.filter((name) => name.startsWith('Runtime/SampleScenes/') && name.endsWith('.cs'));
  for (const name of scripts) assert.doesNotMatch(files.text(name), /AlwaysLinkAssembly|RuntimeInitializeOnLoad|\bPreserve\b/, name);
  const users = files.names.filter((name) => name.startsWith('Runtime/') && name.endsWith('.asmdef') && JSON.parse(files.text(name)).references.includes('HaptoFlow.SampleScenes'));
  assert.deepEqual([scripts.length > 0, users], [true, []]);
});

test('the mixer has the library\'s effect behind the attenuation, on a channel of its own, never suspended, under the names that the code looks for', () => {
  const mixer = files.text('Runtime/Prefabs/HaptoFlow.mixer');
  assert.match(mixer, /m_EnableSuspend: 0/);
  const [, effects] = mixer.match(/m_Effects:\n((?: {2}- \{fileID: \d+\}\n)+)/);
  const order = [...effects.matchAll(/fileID: (\d+)/g)].map(([, anchor]) => mixer.match(new RegExp(`&${anchor}\\n[\\s\\S]*?m_EffectName: (.*)`))[1]);
  assert.deepEqual(order, ['Attenuation', 'HaptoFlow Voice']);
  assert.match(read('NativePlugin', 'src', 'unity', 'audio_effect_entry.cpp'), new RegExp(`"${order[1]}"`));
  const parameters = new Map([...mixer.matchAll(/m_ParameterName: (\w+)\n {4}m_GUID: ([0-9a-f]{32})/g)].map(([, name, id]) => [id, name]));
  assert.deepEqual([...parameters.values()], [...read('NativePlugin', 'src', 'unity', 'voice_effect.cpp').matchAll(/\.name = \{"(\w+)"\}/g)].map(([, name]) => name));
  const values = Object.fromEntries([...mixer.matchAll(/^ {4}([0-9a-f]{32}): (.*)$/gm)].map(([, id, value]) => [parameters.get(id), Number(value)]));
  assert.deepEqual(values, { Strength: 1, Voice: 0, Channel: 1 });
  const exposed = Object.fromEntries([...mixer.matchAll(/- guid: ([0-9a-f]{32})\n {4}name: (\w+)/g)].map(([, id, name]) => [name, parameters.get(id)]));
  assert.deepEqual(exposed, { HaptoFlowChannel: 'Channel', HaptoFlowStrength: 'Strength', HaptoFlowVoice: 'Voice' });
  assert.match(files.text('Runtime/Outputs/HapticOutput.cs'), /voiceParameter = "HaptoFlowVoice"/);
});

/** A package's folder as Unity gets it from a git URL: ...git?path=/Packages/NAME */
const folderOf = (name) => new PackageFiles(new Map(
  names.filter((file) => file.startsWith(`Packages/${name}/`)).map((file) => [file.slice(`Packages/${name}/`.length), readFileSync(inRepository(file))])));

test('a git URL gives a whole package, offers nothing that it lacks, and says what does not come with it', () => {
  const [own, ofStudies] = [packageName, studiesName].map(folderOf);
  assert.deepEqual([checkPackage(own), checkPackage(ofStudies, own)], [[], []]);
  assert.deepEqual(own.folders.filter((name) => name.endsWith('~')), []);
  for (const each of [own, ofStudies]) assert.match(each.text('README.md').replace(/\s+/g, ' '), /A git URL brings no `Documentation~`/);
  for (const name of own.endingIn('.cs')) {
    for (const [, place] of own.text(name).matchAll(/"Packages\/com\.haptoflow\.runtime\/([^"]+)"/g)) assert.ok(own.names.some((file) => file.startsWith(place)), `${name}: ${place}`);
  }
  const builders = own.names.flatMap((name) => [...(name.match(/^Runtime\/SampleScenes\/(?:\w+\/)?(\w+Scene)\.cs$/) ?? [])].slice(1));
  const made = [...own.text('Editor/Scene/SampleSceneMenu.cs').matchAll(/Make<(\w+Scene)>\("/g)].map(([, name]) => name);
  assert.deepEqual(made.sort(), builders.sort());
});

/** An unpacked ONNX Runtime as npm installs it, and a manifest that depends on version 1.2.3 of it. */
function runtimeIn(place, installed = '1.2.3') {
  const source = path.join(place, 'source');
  const contents = { 'package.json': JSON.stringify({ name: dependencyName, version: installed }), LICENSE: 'MIT, as it was', 'Plugins/iOS~/onnxruntime.h': 'header' };
  for (const [name, text] of Object.entries(contents)) {
    mkdirSync(path.dirname(path.join(source, name)), { recursive: true });
    writeFileSync(path.join(source, name), text);
  }
  writeFileSync(path.join(place, 'package.json'), JSON.stringify({ dependencies: { [dependencyName]: '1.2.3' } }));
  return { source, manifest: path.join(place, 'package.json'), contents };
}

test('ONNX Runtime\'s tarball has every file as it is; one of that version is kept, since a version never changes', async () => {
  const { contents, ...given } = runtimeIn(path.join(folder, 'runtime'));
  const out = path.join(folder, 'out');
  const { file, isNew } = await packDependency(out, given);
  const packed = await readTarball(file);
  assert.deepEqual(Object.fromEntries(packed.names.map((name) => [name, packed.text(name)])), contents);
  assert.deepEqual([isNew, readdirSync(out)], [true, [`${dependencyName}-1.2.3.tgz`]]);
  writeFileSync(file, 'made before');
  assert.deepEqual(await packDependency(out, given), { file, bytes: 11, isNew: false });
});

test('ONNX Runtime in another version than the manifest\'s, a missing one and one without licence are refused', async () => {
  const other = runtimeIn(path.join(folder, 'other'), '1.2.4');
  await assert.rejects(packDependency(folder, other), /holds com\.github\.asus4\.onnxruntime 1\.2\.4; expected com\.github\.asus4\.onnxruntime 1\.2\.3: run `npm ci`/);
  await assert.rejects(packDependency(folder, { ...other, source: path.join(folder, 'nowhere') }), /nowhere: holds no package/);
  const bare = runtimeIn(path.join(folder, 'bare'));
  rmSync(path.join(bare.source, 'LICENSE'));
  await assert.rejects(packDependency(folder, bare), /has no LICENSE/);
  assert.ok(!existsSync(path.join(folder, `${dependencyName}-1.2.3.tgz`)));
});
