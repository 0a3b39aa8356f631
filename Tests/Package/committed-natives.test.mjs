// The native libraries in git, with which Unity plays a clone, and the record of what they were built from.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { cpSync, readFileSync, renameSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { checkNatives } from '../../scripts/lib/lint_checks.mjs';
import { committedPlatforms, complaintsOf, complaintsOfRecord, fileInPackage, hashOfInterface, hashOfSources, importFolder, largestBytes, putIntoPackage, readRecord, sourceFiles } from '../../scripts/lib/libraries.mjs';
import { onDebian } from '../../scripts/lib/setup.mjs';
import { findNatives, platforms, pluginsFolder } from '../../scripts/pack/natives.mjs';
import { PackageFiles } from '../../scripts/pack/package_files.mjs';
import { checkMetasAreThere, checkMetasAreWanted } from '../../scripts/pack/rules_of_files.mjs';
import { checkPlugins } from '../../scripts/pack/rules_of_plugins.mjs';
import { elfOf } from './support/elf.mjs';
import { inFolder } from './support/folder.mjs';

const git = (...words) => spawnSync('git', ['-C', inRepository(), ...words], { encoding: 'utf8' });
const hasGit = git('rev-parse', '--is-inside-work-tree').status === 0;
const notInGit = platforms.filter(({ isInGit }) => !isInGit);
const package_ = 'Packages/com.haptoflow.runtime';

/** A copy of what the build of the plugin reads. */
const inCopy = (act) => inFolder((folder) => {
  for (const name of ['package.json', ...sourceFiles()]) cpSync(inRepository(name), path.join(folder, name), { recursive: true });
  return act(folder);
});

const changed = (folder, name, change) => {
  const file = path.join(folder, ...name.split('/'));
  const before = readFileSync(file, 'utf8');
  assert.notEqual(change(before), before, name);
  writeFileSync(file, change(before));
};

const header = 'NativePlugin/include/haptoflow/haptoflow.h';

test('the libraries in git have the C interface and the struct layouts of the sources', () => {
  assert.equal(readRecord().interface, hashOfInterface(), 'haptoflow.h changed, and the libraries in git did not: `npm run natives`, then commit what it changed');
});

test('git has the libraries of the editors, as recorded, and another file is named with the command that renews it', () => {
  assert.deepEqual(committedPlatforms.map(({ id }) => id), ['linux-x64', 'linux-arm64', 'windows-x64']);
  const record = readRecord();
  assert.deepEqual(complaintsOfRecord(record), []);
  const other = { ...record, files: { ...record.files, 'windows-x64': { ...record.files['windows-x64'], sha256: '0' } } };
  assert.deepEqual(complaintsOfRecord(other), ['windows-x64: is not the file that NativePlugin/natives.json records: `npm run natives` builds it anew']);
});

test('each is of its platform, small, and has the exports of the header; any other is refused', { skip: !onDebian() && 'only Debian has binutils for sure' }, () => {
  for (const platform of committedPlatforms) assert.deepEqual(complaintsOf(platform, fileInPackage(platform)), []);
  assert.ok(largestBytes <= 3.5e6);
  const [linux, , windows] = committedPlatforms;
  const good = readFileSync(fileInPackage(linux));
  inFolder((folder) => {
    const refused = (platform, bytes, name = 'library.so') => {
      writeFileSync(path.join(folder, name), bytes);
      return complaintsOf(platform, path.join(folder, name));
    };
    const renamed = (bytes) => Buffer.from(bytes.toString('latin1').replaceAll('haptoflow_version\0', 'haptoflow_versiox\0'), 'latin1');
    const wrongNames = (id) => [`${id}: does not export haptoflow_version of haptoflow.h`, `${id}: exports haptoflow_versiox, which haptoflow.h does not declare`];
    assert.deepEqual(refused(windows, good), ['windows-x64: is elf-x86-64; expected pe-x86-64']);
    assert.deepEqual(refused(linux, Buffer.alloc(0)), ['linux-x64: is no library; expected elf-x86-64']);
    assert.deepEqual(refused(linux, Buffer.concat([good, Buffer.alloc(largestBytes)])), [`linux-x64: has ${good.length + largestBytes} bytes; expected 3500000 at most`]);
    assert.deepEqual(refused(linux, renamed(good)), wrongNames('linux-x64'));
    assert.deepEqual(refused(windows, renamed(readFileSync(fileInPackage(windows))), 'library.dll'), wrongNames('windows-x64'));
    assert.match(refused(linux, elfOf({ machine: 62, versions: ['GLIBC_2.34'] }))[0], /needs glibc 2\.34; expected 2\.31 or older/);
  });
});

test('where the sources are newer lint names the command without a complaint, and where they are the same it says nothing', async () => {
  const record = readRecord();
  const newer = await checkNatives({ ...record, sources: '0' });
  assert.deepEqual(newer.complaints, []);
  assert.match(newer.warnings.join(), /^NativePlugin\/natives\.json: .* older than the sources .*`npm run natives`/);
  assert.deepEqual((await checkNatives({ ...record, sources: hashOfSources() })).warnings, []);
  assert.equal((await checkNatives({ ...record, files: {} })).complaints.length, committedPlatforms.length);
});

test('everything that git has of the plugin\'s sources counts, and nothing of the command line, the benchmarks or the tests', { skip: !hasGit && 'no git' }, () => {
  const tracked = git('ls-files', '-z', 'CMakeLists.txt', 'CMakePresets.json', 'NativePlugin').stdout.split('\0').filter((name) => name !== '');
  // Settings of tools in the folders of sources begin with a dot.
  const others = ['NativePlugin/bench/', 'NativePlugin/cli/', 'NativePlugin/headless/', 'NativePlugin/import/', 'NativePlugin/natives.json'];
  assert.deepEqual(sourceFiles(), tracked.filter((name) => !others.some((other) => name.startsWith(other)) && !path.posix.basename(name).startsWith('.')).sort());
});

test('the hash of the sources is that of any checkout, with the line ends of Windows and an editor\'s backups too', () => {
  inCopy((folder) => {
    assert.equal(hashOfSources(folder), hashOfSources());
    changed(folder, header, (text) => text.replaceAll('\n', '\r\n'));
    changed(folder, 'CMakePresets.json', (text) => text.replaceAll('\n', '\r\n'));
    writeFileSync(path.join(folder, 'NativePlugin', 'src', 'capi', 'handles.cpp~'), 'old');
    assert.equal(hashOfSources(folder), hashOfSources());
    assert.equal(hashOfInterface(folder), hashOfInterface());
  });
});

/** [what, file, change of its text, whether it is of the interface] */
const changes = [
  ['a source', 'NativePlugin/src/dsp/gate.cpp', (text) => `${text}// More.\n`, false],
  ['a profile', 'NativePlugin/profiles/flat.json', (text) => `${text}\n`, false],
  ['a compiler option', 'NativePlugin/cmake/HaptoFlowTargets.cmake', (text) => text.replace('-ffp-contract=off', '-ffp-contract=on'), false],
  ['the version of ONNX Runtime\'s headers', 'package.json', (text) => text.replace(/(com\.github\.asus4\.onnxruntime": ")[^"]*/, '$10.5.0'), false],
  ['a comment in the header', header, (text) => `${text}/* haptoflow_other(void) says more. */\n\n`, false],
  ['a comment in Unity\'s header', 'NativePlugin/src/unity/audio_effect_sdk.hpp', (text) => text.replace('\n\n', '\n\n// More.\n\n'), false],
  ['a field of a struct', header, (text) => text.replace('float force_newtons;', 'double force_newtons;'), true],
  ['a function\'s parameter', header, (text) => text.replace('haptoflow_version(void)', 'haptoflow_version(int32_t form)'), true],
  ['the value of a constant', header, (text) => text.replace('#define HAPTOFLOW_PHASES 6', '#define HAPTOFLOW_PHASES 7'), true],
  ['the version', header, (text) => text.replace(/(HAPTOFLOW_VERSION_TEXT ")[^"]*/, '$199.0.0'), true],
  ['a struct shared with Unity', 'NativePlugin/src/unity/audio_effect_sdk.hpp', (text) => text.replace(/\n( +)(std::)?uint32_t /, '\n$1$2uint64_t '), true],
];

test('every change of what the build reads, and a file more or renamed, changes the hash of the sources, and a declaration that of the interface too', () => {
  inCopy((folder) => {
    for (const [what, name, change, isOfInterface] of changes) {
      const before = readFileSync(path.join(folder, name));
      changed(folder, name, change);
      assert.notEqual(hashOfSources(folder), hashOfSources(), what);
      assert.equal(hashOfInterface(folder) !== hashOfInterface(), isOfInterface, what);
      writeFileSync(path.join(folder, name), before);
    }
    const added = path.join(folder, 'NativePlugin', 'src', 'dsp', 'added.cpp');
    writeFileSync(added, '');
    const withOne = hashOfSources(folder);
    assert.notEqual(withOne, hashOfSources());
    renameSync(added, added.replace('added', 'renamed'));
    assert.notEqual(hashOfSources(folder), withOne);
  });
});

test('pack takes a library of git where none was built and the sources are the same, and says why where they are newer', () => {
  const none = () => [];
  const all = findNatives(none, new Set(), (platform) => (platform.isInGit ? `git/${platform.id}` : null));
  assert.deepEqual(all.found.map(({ file, isFromGit }) => [file, isFromGit]), [['git/linux-x64', true], ['git/linux-arm64', true], ['git/windows-x64', true]]);
  const { found, absent } = findNatives(none, new Set(), () => null);
  assert.deepEqual(found, []);
  assert.equal(absent[0].why, 'not built, and that of git is older than the sources; `npm run build -- --platform linux-x64` on Linux x64 adds it');
  assert.match(absent.at(-1).why, /^not built; /);
  inFolder((folder) => {
    writeFileSync(path.join(folder, 'libaudioplugin_haptoflow.so'), elfOf({ machine: 62 }));
    const [first] = findNatives(() => [folder], new Set(), () => 'git').found;
    assert.deepEqual([first.file, first.isFromGit], [path.join(folder, 'libaudioplugin_haptoflow.so'), false]);
  });
});

test('a built library of macOS or Android goes into the package with the .meta of itself and its folders, as Unity wants them', () => {
  const stand = { macos: Buffer.from('cffaedfe0c000001', 'hex'), 'android-arm64': elfOf({ machine: 183, libraries: ['libc.so'], alignment: 16384 }) };
  inFolder((folder) => {
    cpSync(inRepository(importFolder), path.join(folder, importFolder), { recursive: true });
    for (const { id, place } of notInGit) {
      const built = path.join(folder, id);
      writeFileSync(built, stand[id]);
      assert.equal(putIntoPackage(place, built, folder), `${package_}/${pluginsFolder}/${place}`);
      putIntoPackage(place, built, folder);
    }
    const plugins = PackageFiles.inFolder(path.join(folder, package_, pluginsFolder));
    const names = notInGit.flatMap(({ place }) => [place, ...place.split('/').map((_, index, all) => `${all.slice(0, index + 1).join('/')}.meta`)]);
    assert.deepEqual(plugins.names, names.sort());
    const files = new PackageFiles(new Map(plugins.names.map((name) => [`${pluginsFolder}/${name}`, plugins.bytes(name)])));
    assert.deepEqual(checkPlugins(files), []);
    assert.deepEqual([checkMetasAreThere, checkMetasAreWanted].flatMap((rule) => rule(plugins)), []);
  });
});
