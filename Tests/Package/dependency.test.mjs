// The tarball of ONNX Runtime, which pack writes beside the package's.
import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, symlinkSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/repository.mjs';
import { dependencyName, packDependency } from '../../scripts/pack/dependency.mjs';
import { makeTarball, readTarball } from '../../scripts/pack/tarball.mjs';

async function inFolder(act) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-dependency-'));
  try {
    await act(folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}

/** An unpacked package as npm installs it, and a manifest that depends on it. */
function makeUp(folder, version = '1.2.3') {
  const source = path.join(folder, 'source');
  const files = {
    'package.json': JSON.stringify({ name: dependencyName, version }),
    LICENSE: 'MIT, as it was',
    'LICENSE.meta': 'guid: 1',
    'ThirdPartyNotices.txt': 'theirs',
    'Plugins/Linux/x64/libonnxruntime.so': 'native',
    'Plugins/iOS~/Headers/onnxruntime_c_api.h': 'header',
  };
  for (const [name, text] of Object.entries(files)) {
    mkdirSync(path.dirname(path.join(source, name)), { recursive: true });
    writeFileSync(path.join(source, name), text);
  }
  const manifest = path.join(folder, 'package.json');
  writeFileSync(manifest, JSON.stringify({ dependencies: { [dependencyName]: '1.2.3' } }));
  return { source, manifest, files };
}

test('the tarball has every file of the package as it is, licence included, in the layout that Unity reads', () =>
  inFolder(async (folder) => {
    const { source, manifest, files } = makeUp(folder);
    const out = path.join(folder, 'out');
    mkdirSync(out);
    const { file, isNew } = await packDependency(out, { source, manifest });
    assert.equal(isNew, true);
    assert.deepEqual(readdirSync(out), [`${dependencyName}-1.2.3.tgz`], 'nothing is left beside it');
    const packed = readTarball(readFileSync(file));
    assert.deepEqual([...packed.keys()].sort(), Object.keys(files).map((name) => `package/${name}`).sort());
    for (const [name, text] of Object.entries(files)) assert.equal(packed.get(`package/${name}`).toString(), text, name);
  }));

test('tar reads the tarball, and npm lists the same files as in its own', { skip: process.platform === 'win32' }, () =>
  inFolder(async (folder) => {
    const { source, manifest } = makeUp(folder);
    const deep = `Runtime/${'folder/'.repeat(15)}${'n'.repeat(80)}.cs`;
    mkdirSync(path.dirname(path.join(source, deep)), { recursive: true });
    writeFileSync(path.join(source, deep), 'x'.repeat(513));
    writeFileSync(path.join(source, 'empty.meta'), '');
    writeFileSync(path.join(source, 'Plugins', 'large.bin'), Buffer.alloc(300_000, 7));
    const { file } = await packDependency(folder, { source, manifest });
    const listed = spawnSync('tar', ['tzf', file], { encoding: 'utf8' });
    assert.equal(listed.status, 0, listed.stderr);
    const byNpm = await makeTarball(source, source);
    const [ours, npms] = [file, byNpm.file].map((each) => readTarball(readFileSync(each)));
    assert.deepEqual(listed.stdout.trim().split('\n').sort(), [...npms.keys()].sort());
    for (const [name, content] of npms) assert.deepEqual(ours.get(name), content, name);
  }));

test('anything but a plain file, and a name too long for a header, are refused', { skip: process.platform === 'win32' }, () =>
  inFolder(async (folder) => {
    const linked = makeUp(path.join(folder, 'linked'));
    symlinkSync('LICENSE', path.join(linked.source, 'link'));
    await assert.rejects(packDependency(folder, linked), /link: is no plain file/);
    const long = makeUp(path.join(folder, 'long'));
    writeFileSync(path.join(long.source, 'n'.repeat(120)), '');
    await assert.rejects(packDependency(folder, long), /too long for a tarball/);
    assert.ok(!existsSync(path.join(folder, `${dependencyName}-1.2.3.tgz`)));
  }));

test('a tarball of that version is kept, since a version never changes', () =>
  inFolder(async (folder) => {
    const { source, manifest } = makeUp(folder);
    writeFileSync(path.join(folder, `${dependencyName}-1.2.3.tgz`), 'made before');
    const { file, isNew, bytes } = await packDependency(folder, { source, manifest });
    assert.equal(isNew, false);
    assert.equal(bytes, 11);
    assert.equal(readFileSync(file, 'utf8'), 'made before');
  }));

test('the partial file of an interrupted pack is replaced', () =>
  inFolder(async (folder) => {
    const { source, manifest } = makeUp(folder);
    const out = path.join(folder, 'out');
    mkdirSync(out);
    writeFileSync(path.join(out, `${dependencyName}-1.2.3.tgz.partial`), 'half of a tarball that was longer than the one to come'.repeat(1000));
    const { file } = await packDependency(out, { source, manifest });
    assert.ok(readTarball(readFileSync(file)).has('package/LICENSE'));
    assert.deepEqual(readdirSync(out), [path.basename(file)]);
  }));

test('a package of another version than the manifest\'s, a missing package and one without licence are refused', () =>
  inFolder(async (folder) => {
    const other = makeUp(path.join(folder, 'other'), '1.2.4');
    await assert.rejects(packDependency(folder, other), /holds com\.github\.asus4\.onnxruntime 1\.2\.4; expected com\.github\.asus4\.onnxruntime 1\.2\.3: run `npm ci`/);
    await assert.rejects(packDependency(folder, { ...other, source: path.join(folder, 'nowhere') }), /nowhere: holds no package/);
    const bare = makeUp(path.join(folder, 'bare'));
    rmSync(path.join(bare.source, 'LICENSE'));
    await assert.rejects(packDependency(folder, bare), /has no LICENSE/);
    assert.ok(!existsSync(path.join(folder, `${dependencyName}-1.2.3.tgz`)));
  }));

test('the package that npm installed here carries its licence and its notices', () => {
  const names = readdirSync(inRepository('node_modules', dependencyName));
  for (const name of ['LICENSE', 'ThirdPartyNotices.txt', 'package.json', 'package.json.meta']) assert.ok(names.includes(name), name);
});
