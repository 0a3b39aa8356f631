import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { gzipSync } from 'node:zlib';
import { inRepository } from '../../scripts/lib/repository.mjs';

const script = (name, ...words) => spawnSync(process.execPath, [inRepository('scripts', 'release', `${name}.mjs`), ...words], { encoding: 'utf8' });
const { version } = JSON.parse(readFileSync(inRepository('package.json'), 'utf8'));

function inFolder(act) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-release-'));
  try {
    return act(folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** A gzipped tar archive of files by name, as npm makes it. */
function tarball(files) {
  const blocks = Object.entries(files).flatMap(([name, text]) => {
    const header = Buffer.alloc(512);
    header.write(`package/${name}`, 0);
    header.write('0000644\0', 100);
    header.write(`${Buffer.byteLength(text).toString(8).padStart(11, '0')}\0`, 124);
    header.write('0', 156);
    const content = Buffer.alloc(512 * Math.ceil(Buffer.byteLength(text) / 512));
    content.write(text);
    return [header, content];
  });
  return gzipSync(Buffer.concat([...blocks, Buffer.alloc(1024)]));
}

function elf(machine, alignment) {
  const bytes = Buffer.alloc(64 + 56);
  bytes.writeUInt32BE(0x7f454c46, 0);
  bytes.writeUInt16LE(machine, 18);
  bytes.writeBigUInt64LE(64n, 32);
  bytes.writeUInt16LE(56, 54);
  bytes.writeUInt16LE(1, 56);
  bytes.writeUInt32LE(1, 64);
  bytes.writeBigUInt64LE(BigInt(alignment), 64 + 48);
  return bytes;
}

test('every script of a release shows its help', () => {
  for (const name of ['check_pages', 'check_tag', 'check_tarball', 'collect_natives', 'unity_project', 'upm_branch']) {
    const { status, stdout } = script(name, '--help');
    assert.equal(status, 0, name);
    assert.match(stdout, new RegExp(`^usage: node scripts/release/${name}\\.mjs`), name);
    assert.equal(script(name).status, 2, name);
  }
});

test('libraries that lie anywhere below a folder go to the build folders of their presets, and a missing one is named', () => {
  inFolder((folder) => {
    const [from, to] = [path.join(folder, 'artifacts'), path.join(folder, 'repository')];
    mkdirSync(path.join(from, 'native-android-arm64', 'deep'), { recursive: true });
    mkdirSync(path.join(from, 'native-linux-x64'), { recursive: true });
    writeFileSync(path.join(from, 'native-android-arm64', 'deep', 'libaudioplugin_haptoflow.so'), elf(183, 16384));
    writeFileSync(path.join(from, 'native-linux-x64', 'libaudioplugin_haptoflow.so'), elf(62, 4096));
    const { status, stderr } = script('collect_natives', from, to);
    assert.equal(status, 1);
    assert.match(stderr, /has no library for windows-x64, macos/);
    assert.deepEqual(readFileSync(path.join(to, 'build', 'android-arm64', 'libaudioplugin_haptoflow.so')), elf(183, 16384));
    assert.deepEqual(readFileSync(path.join(to, 'build', 'native', 'libaudioplugin_haptoflow.so')), elf(62, 4096));
  });
});

test('an Android library aligned to 4 KiB is refused, one aligned to 16 KiB passes, and one for another processor is named', () => {
  inFolder((folder) => {
    const file = path.join(folder, 'library.so');
    for (const [bytes, status, said] of [[elf(183, 4096), 1, /aligned to 4096 bytes, expected 16384/], [elf(183, 16384), 0, /aligned to 16384 bytes/], [elf(62, 16384), 1, /is elf-x86-64; expected elf-arm64/]]) {
      writeFileSync(file, bytes);
      const result = script('check_pages', file);
      assert.equal(result.status, status);
      assert.match(result.stdout + result.stderr, said);
    }
  });
});

test('a tag that is not the version is refused', () => {
  assert.match(script('check_tag', 'v99.0.0').stderr, new RegExp(`the tag is v99\\.0\\.0, and package\\.json says ${version.replaceAll('.', '\\.')}`));
  assert.equal(script('check_tag', `v${version}`).status, 0);
});

test('a tarball without manifest and library is refused with a line for each complaint', () => {
  inFolder((folder) => {
    const file = path.join(folder, 'bad.tgz');
    writeFileSync(file, tarball({ 'package.json': '{}', 'Runtime/Lonely.cs': 'class Lonely {}' }));
    const { status, stderr } = script('check_tarball', file, '--require', 'linux-x64');
    assert.equal(status, 1);
    assert.match(stderr, /Runtime\/Lonely\.cs/);
    assert.match(stderr, /Linux\/x64\/libaudioplugin_haptoflow\.so: is missing; it is the library of linux-x64/);
    assert.equal(script('check_tarball', file, '--require', 'amiga').status, 2);
  });
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
    assert.match(publish({ 'package.json': manifest('2.0.0') }, '--dry-run').stdout, /would get com\.example 2\.0\.0/);
    assert.equal(git(remote, 'rev-list', '--count', 'upm'), '2');
  });
});

test('a remote that cannot be read is an error that names it', () => {
  inFolder((folder) => {
    writeFileSync(path.join(folder, 'package.tgz'), tarball({ 'package.json': '{}' }));
    const { status, stderr } = script('upm_branch', path.join(folder, 'package.tgz'), '--remote', path.join(folder, 'nowhere'));
    assert.equal(status, 1);
    assert.match(stderr, /nowhere: cannot be read/);
  });
});

test('a Unity project installs both tarballs and lists the package as testable', () => {
  inFolder((folder) => {
    const names = [`com.haptoflow.runtime-${version}.tgz`, 'com.github.asus4.onnxruntime-0.4.9.tgz'];
    for (const name of names) writeFileSync(path.join(folder, name), name);
    const project = path.join(folder, 'project');
    const { status, stderr } = script('unity_project', project, '--unity', '2022.3.62f1', '--tarballs', folder);
    assert.equal(status, 0, stderr);
    const manifest = JSON.parse(readFileSync(path.join(project, 'Packages', 'manifest.json'), 'utf8'));
    assert.deepEqual(manifest.testables, ['com.haptoflow.runtime']);
    for (const name of names) assert.ok(existsSync(path.join(project, 'Packages', name)));
    assert.equal(manifest.dependencies['com.haptoflow.runtime'], `file:${names[0]}`);
    assert.match(readFileSync(path.join(project, 'ProjectSettings', 'ProjectVersion.txt'), 'utf8'), /^m_EditorVersion: 2022\.3\.62f1$/m);
    assert.equal(script('unity_project', project, '--unity', '2022.3.62f1', '--tarballs', project).status, 1);
  });
});
