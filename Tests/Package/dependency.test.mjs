// The tarball of ONNX Runtime, which pack writes beside the package's.
import assert from 'node:assert/strict';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';
import { dependencyName, packDependency } from '../../scripts/pack/dependency.mjs';
import { readTarball } from '../../scripts/pack/package_files.mjs';

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
    const packed = await readTarball(file);
    assert.deepEqual(packed.names, Object.keys(files).sort());
    for (const [name, text] of Object.entries(files)) assert.equal(packed.text(name), text, name);
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
