import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, readFileSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { platforms } from '../../scripts/pack/natives.mjs';
import { changesOf } from '../../scripts/pack/draft.mjs';
import { elfOf } from './support/elf.mjs';
import { inFolder } from './support/folder.mjs';

const script = (name, ...words) => spawnSync(process.execPath, [inRepository('scripts', 'pack', `${name}.mjs`), ...words], { encoding: 'utf8' });
const { version } = JSON.parse(readFileSync(inRepository('package.json'), 'utf8'));

/** A gzipped tar archive of files by name, in the folder in which npm puts them. */
const tarball = (files) => inFolder((folder) => {
  for (const [name, content] of Object.entries(files)) {
    const file = path.join(folder, 'package', name);
    mkdirSync(path.dirname(file), { recursive: true });
    writeFileSync(file, content);
  }
  return spawnSync('tar', ['-czf', '-', '-C', folder, 'package'], { maxBuffer: 1e8 }).stdout;
});

const elf = (machine, alignment) => elfOf({ machine, alignment });
const android = (alignment) => elfOf({ machine: 183, libraries: ['libc.so'], alignment });

test('libraries that lie anywhere below a folder go to the build folders of their presets, and a missing one is named', () => {
  inFolder((folder) => {
    const [from, to] = [path.join(folder, 'artifacts'), path.join(folder, 'repository')];
    mkdirSync(path.join(from, 'native-android-arm64', 'deep'), { recursive: true });
    mkdirSync(path.join(from, 'native-linux-x64'), { recursive: true });
    mkdirSync(path.join(from, 'native-linux-arm64'), { recursive: true });
    writeFileSync(path.join(from, 'native-android-arm64', 'deep', 'libaudioplugin_haptoflow.so'), android(16384));
    writeFileSync(path.join(from, 'native-linux-arm64', 'libaudioplugin_haptoflow.so'), elf(183, 65536));
    writeFileSync(path.join(from, 'native-linux-x64', 'libaudioplugin_haptoflow.so'), elf(62, 4096));
    const { status, stderr } = script('collect_natives', from, to);
    assert.equal(status, 1);
    assert.match(stderr, /has no library for windows-x64, macos/);
    assert.deepEqual(readFileSync(path.join(to, 'build', 'android-arm64', 'libaudioplugin_haptoflow.so')), android(16384));
    assert.deepEqual(readFileSync(path.join(to, 'build', 'linux-arm64', 'libaudioplugin_haptoflow.so')), elf(183, 65536));
    assert.deepEqual(readFileSync(path.join(to, 'build', 'native', 'libaudioplugin_haptoflow.so')), elf(62, 4096));
  });
});

test('a draft has the tarballs, the demo\'s page, checksums that agree, and notes with clicks, platforms and changes', () => {
  inFolder((folder) => {
    const names = [`com.github.asus4.onnxruntime-0.4.9.tgz`, `com.haptoflow.runtime-${version}.tgz`, `com.haptoflow.studies-${version}.tgz`];
    for (const name of names) writeFileSync(path.join(folder, name), name);
    const library = 'Runtime/Plugins/Windows/x64/audioplugin_haptoflow.dll';
    writeFileSync(path.join(folder, names[1]), tarball({ 'package.json': JSON.stringify({ version }), [library]: 'MZ' }));
    mkdirSync(path.join(folder, 'demo'));
    writeFileSync(path.join(folder, 'demo', 'index.html'), '<p>felt</p>');
    const draft = path.join(folder, 'release');
    const { status, stderr } = script('draft', draft, '--tarballs', folder, '--demo', path.join(folder, 'demo'));
    assert.equal(status, 0, stderr);
    const archives = [...names, 'haptoflow-demo.tgz'];
    assert.deepEqual(readdirSync(draft).sort(), ['SHA256SUMS', ...archives, 'notes.md'].sort());
    const lines = readFileSync(path.join(draft, 'SHA256SUMS'), 'utf8').trim().split('\n').map((line) => line.split('  '));
    assert.deepEqual(lines.map(([, name]) => name).sort(), archives.sort());
    for (const [sum, name] of lines) assert.equal(sum, createHash('sha256').update(readFileSync(path.join(draft, name))).digest('hex'), name);
    assert.match(spawnSync('tar', ['-tzf', path.join(draft, 'haptoflow-demo.tgz')], { encoding: 'utf8' }).stdout, /^haptoflow-demo\/index\.html$/m);
    const notes = readFileSync(path.join(draft, 'notes.md'), 'utf8');
    for (const text of [...names, 'Package Manager > + > Install package from tarball', '| Windows x86-64 | yes |', '| Linux arm64 | no |', 'The repository is a Unity project']) assert.ok(notes.includes(text), text);
    assert.equal(script('draft', draft, '--tarballs', path.join(folder, 'demo')).status, 1, 'without tarballs');
  });
});

test('the changes of a version are those of its own section', () => {
  const changelog = '# Changelog\n\n## 1.0.1\n\n- Second.\n\n## 1.0.10 (2026)\n\n- Tenth.\n';
  assert.deepEqual(['1.0.1', '1.0.10'].map((each) => changesOf(changelog, each)), ['- Second.', '- Tenth.']);
  assert.throws(() => changesOf(changelog, '2.0.0'), /has no section "## 2\.0\.0"/);
});

test('the workflow of a release requires the library of every platform, and its checks make each', () => {
  const [release, ci] = ['release', 'ci'].map((name) => readFileSync(inRepository('.github', 'workflows', `${name}.yml`), 'utf8'));
  assert.ok(release.includes(`--require ${platforms.map(({ id }) => id).join(',')}`));
  for (const { id } of platforms) assert.match(ci, new RegExp(`name: native-${id}\n`), id);
});

const git = (folder, ...words) => {
  const { status, stdout, stderr } = spawnSync('git', ['-C', folder, ...words], { encoding: 'utf8' });
  assert.equal(status, 0, stderr);
  return stdout.trim();
};

test('the branch holds exactly the files of the tarball, a second release is a second commit, and the same one none', () => {
  inFolder((folder) => {
    const remote = path.join(folder, 'remote.git');
    assert.equal(spawnSync('git', ['init', '--quiet', '--bare', remote]).status, 0);
    const publish = (files, ...words) => {
      writeFileSync(path.join(folder, 'package.tgz'), tarball(files));
      return script('upm_branch', path.join(folder, 'package.tgz'), '--remote', remote, ...words);
    };
    const manifest = (number) => JSON.stringify({ name: 'com.example', version: number });
    assert.equal(publish({ 'package.json': manifest('1.0.0'), 'Runtime/Old.cs': 'old' }).status, 0);
    assert.equal(publish({ 'package.json': manifest('1.1.0'), 'Runtime/New.cs': 'new', '.gitignore': '*.cs' }).status, 0);
    assert.match(publish({ 'package.json': manifest('1.1.0'), 'Runtime/New.cs': 'new', '.gitignore': '*.cs' }).stdout, /already has com\.example 1\.1\.0/);
    assert.equal(git(remote, 'rev-list', '--count', 'upm'), '2');
    assert.deepEqual(git(remote, 'ls-tree', '-r', '--name-only', 'upm').split('\n'), ['.gitignore', 'Runtime/New.cs', 'package.json']);
    assert.equal(git(remote, 'rev-parse', 'upm/1.1.0'), git(remote, 'rev-parse', 'upm'));
    assert.equal(git(remote, 'show', 'upm/1.0.0:Runtime/Old.cs'), 'old');
    assert.match(script('upm_branch', path.join(folder, 'package.tgz'), '--remote', path.join(folder, 'nowhere')).stderr, /nowhere: cannot be read/);
    assert.match(publish({ 'package.json': manifest('2.0.0') }, '--dry-run').stdout, /would get com\.example 2\.0\.0/);
    assert.equal(git(remote, 'rev-list', '--count', 'upm'), '2');
  });
});
