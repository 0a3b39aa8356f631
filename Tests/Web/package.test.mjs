import assert from 'node:assert/strict';
import { execFileSync } from 'node:child_process';
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { packEngine } from '../../scripts/lib/web_build.mjs';
import { hasBrowser, openPage } from './support/browser.mjs';
import { sample } from './support/engine.mjs';

let folder = '';
let installed = '';
let tarball;

before(async () => {
  folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-web-'));
  mkdirSync(path.join(folder, 'packed'));
  tarball = await packEngine(path.join(folder, 'packed'));
  writeFileSync(path.join(folder, 'package.json'), '{ "private": true, "type": "module" }');
  execFileSync('npm', ['install', '--offline', '--no-audit', '--no-fund', '--loglevel=error', tarball.file], { cwd: folder, shell: process.platform === 'win32' });
  installed = path.join(folder, 'node_modules', 'haptoflow-web');
});
after(() => rmSync(folder, { recursive: true, force: true }));

test('the package has its page, licence, notices and types, and weighs at most 8 MB', () => {
  for (const name of ['README.md', 'LICENSE', 'NOTICES.md', 'haptoflow.d.ts', 'node.d.ts']) assert.ok(existsSync(path.join(installed, name)), name);
  const { dependencies, version } = JSON.parse(readFileSync(path.join(installed, 'package.json'), 'utf8'));
  assert.equal(dependencies, undefined);
  assert.match(version, /^\d+\.\d+\.\d+$/);
  assert.ok(tarball.bytes < 8e6, `${tarball.bytes} bytes`);
});

test('its page is one screen', () => {
  assert.ok(readFileSync(path.join(installed, 'README.md'), 'utf8').split('\n').length <= 60);
});

test('the notices name what is inside', () => {
  const text = readFileSync(path.join(installed, 'NOTICES.md'), 'utf8');
  for (const name of ['onnxruntime-web', 'Emscripten', 'musl', 'libc++', 'GLM', 'nlohmann-json']) assert.ok(text.includes(name), name);
});

test('installed in Node, it renders by its name', () => {
  writeFileSync(path.join(folder, 'render.mjs'), `
    import { openOffline } from 'haptoflow-web/node';
    const { render, model } = await openOffline();
    const { samples } = render(${JSON.stringify({ scene: sample('tracing.scene.json'), stroke: sample('tracing.stroke.csv'), quality: 'draft' })});
    console.log(JSON.stringify({ labels: model.labels.length, peak: samples.reduce((most, each) => Math.max(most, Math.abs(each)), 0) }));
    process.exit(0);`);
  const { labels, peak } = JSON.parse(execFileSync(process.execPath, ['render.mjs'], { cwd: folder, encoding: 'utf8' }));
  assert.equal(labels, 20);
  assert.ok(peak > 0.001);
});

test('installed, its files alone make a page sound', { skip: !hasBrowser }, async () => {
  const opened = await openPage({ engine: installed });
  try {
    const silence = await opened.page.evaluate(async () => {
      const { started, hand, slide } = globalThis.tools;
      const { haptics, voice } = await started();
      await hand(voice, 0.5, slide('wood'));
      const found = voice.silence;
      await haptics.close();
      return found;
    });
    assert.equal(silence, 'none');
  } finally {
    await opened.close();
  }
});
