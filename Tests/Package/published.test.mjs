import assert from 'node:assert/strict';
import { spawn } from 'node:child_process';
import { createHash } from 'node:crypto';
import { copyFileSync, mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, beforeEach, test } from 'node:test';
import { checkpointNames, defaultSpec, localCheckpoint, originLines, parseSpec } from '../../scripts/published/checkpoint.mjs';
import { barText, progressBar } from '../../scripts/published/progress.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { commit, deafAddress, startHub } from './support/hub_server.mjs';

const golden = (name) => readFileSync(inRepository('Tests', 'Golden', 'published', 'heun', name));
const codec = golden('encodec.th');
const sha256Of = (bytes) => createHash('sha256').update(bytes).digest('hex');
const codecName = `encodec_24khz-${sha256Of(codec).slice(0, 8)}.th`;
const [meta, weights] = [golden('meta.json'), golden('model.safetensors')];
const hub = await startHub({
  repositories: [
    {
      type: 'model',
      name: 'tamago117/HaptoFlow',
      licence: 'apache-2.0',
      files: {
        'README.md': Buffer.from('# weights'),
        'haptoflow_accel/meta.json': meta,
        'haptoflow_accel/model.safetensors': weights,
        'two/meta.json': meta,
        'two/a.safetensors': weights,
        'two/b.safetensors': weights,
      },
    },
  ],
  elsewhere: { [`/encodec/v0/${codecName}`]: codec },
});
const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-published-'));
after(async () => {
  await hub.close();
  rmSync(folder, { recursive: true, force: true });
});
beforeEach(() => {
  hub.requests.length = 0;
});

const cache = path.join(folder, 'cache');

/** Runs `./run published` as on a machine whose hub is the stand-in. */
function published(words, env = {}) {
  const all = { ...process.env, INIT_CWD: folder, XDG_CACHE_HOME: cache, HF_ENDPOINT: hub.address, HAPTOFLOW_ENCODEC_URL: `${hub.contentAddress}/encodec/v0/${codecName}`, ...env };
  const child = spawn(process.execPath, [inRepository('scripts', 'published.mjs'), ...words], { env: all });
  return new Promise((resolve) => {
    const texts = { stdout: '', stderr: '' };
    for (const name of ['stdout', 'stderr']) child[name].on('data', (chunk) => { texts[name] += chunk; });
    child.on('close', (status) => resolve({ status, ...texts }));
  });
}

// The engine that measures levels is the Linux library.
const linuxOnly = process.platform === 'linux' ? false : 'import-published measures levels with the Linux library';

test('from the hub to a model file on this disk, over a cut connection and a hub that asks to wait', { skip: linuxOnly }, async () => {
  hub.fail('model.safetensors', { status: 429, headers: { 'Retry-After': '0' } });
  hub.fail('/repos/tamago117', { cutAfter: 100_000 });
  const { status, stdout, stderr } = await published(['--peak-g', '1.5', '-o', 'real.haptoflow']);
  assert.equal(status, 0, stdout + stderr);
  const file = readFileSync(path.join(folder, 'real.haptoflow'));
  const inFile = file.toString('latin1');
  for (const word of [sha256Of(weights), sha256Of(codec), codecName, 'Apache-2.0', 'CC BY 4.0']) assert.ok(inFile.includes(word), `the file states ${word}`);
  // Each part's origin and licence are told before the file is written.
  const lines = stdout.split('\n');
  const lineOf = (pattern) => lines.findIndex((line) => pattern.test(line));
  const written = lineOf(/real\.haptoflow: [\d.]+ MB/);
  assert.ok(written > 0, stdout);
  for (const pattern of [
    new RegExp(`^weights: hf://tamago117/HaptoFlow/haptoflow_accel@${commit}, licence apache-2\\.0, as http.*/tamago117/HaptoFlow states$`),
    new RegExp(`^  model\\.safetensors: ${weights.length} bytes, SHA-256 ${sha256Of(weights)}$`),
    /^recordings that they were trained on: Cluster Haptic Texture Dataset, CC BY 4\.0/,
    new RegExp(`^codec: http.*${codecName}, SHA-256 ${sha256Of(codec)}; EnCodec's code is under the MIT licence, for its weights see https://github\\.com/facebookresearch/encodec$`),
  ]) {
    assert.ok(lineOf(pattern) >= 0 && lineOf(pattern) < written, `${pattern}\n${stdout}`);
  }
  assert.equal(lines.filter((line) => /^weights: /.test(line)).length, 1, 'each part is told once');
  assert.match(stderr, /fewer requests \(429\): waiting 0 s/);
  assert.match(stderr, /model\.safetensors: the connection was cut/);
  assert.match(stderr, /^tamago117\/HaptoFlow: \[#{24}\] 100 %, 0\.3 of 0\.3 MB/m);
  assert.doesNotMatch(stderr, /\x1b/, 'nothing is redrawn where there is no terminal');
  const place = path.join(cache, 'haptoflow', 'models', 'tamago117', 'HaptoFlow', 'main', 'haptoflow_accel');
  assert.deepEqual(readdirSync(place).sort(), ['meta.json', 'model.safetensors', 'origin.json']);
  assert.deepEqual(JSON.parse(readFileSync(path.join(place, 'origin.json'), 'utf8')), {
    origin: `hf://tamago117/HaptoFlow/haptoflow_accel@${commit}`,
    page: `${hub.address}/tamago117/HaptoFlow`,
    repository: 'tamago117/HaptoFlow',
    folder: 'haptoflow_accel',
    revision: 'main',
    commit,
    licence: 'apache-2.0',
    files: { 'meta.json': { size: meta.length, sha256: sha256Of(meta) }, 'model.safetensors': { size: weights.length, sha256: sha256Of(weights) } },
  });
});

test('the folder that was downloaded before does without a network, its origin known, and without a network it is named', { skip: linuxOnly }, async () => {
  const place = path.join(cache, 'haptoflow', 'models', 'tamago117', 'HaptoFlow', 'main', 'haptoflow_accel');
  const address = await deafAddress();
  const deaf = { HF_ENDPOINT: address, HAPTOFLOW_ENCODEC_URL: `${address}/${codecName}` };
  const alone = await published([], deaf);
  assert.equal(alone.status, 1, alone.stdout);
  assert.match(alone.stderr, /^published: http:\/\/127\.0\.0\.1:\d+ cannot be reached \(ECONNREFUSED\)/m);
  assert.ok(alone.stderr.includes(`./run published ${place}`), alone.stderr);
  const { status, stdout, stderr } = await published([place, '--encodec', path.join(cache, 'haptoflow', 'encodec', codecName), '-o', 'again.haptoflow', '--peak-g', '1.5'], deaf);
  assert.equal(status, 0, stdout + stderr);
  assert.match(stdout, new RegExp(`^weights: hf://tamago117/HaptoFlow/haptoflow_accel@${commit}, licence apache-2\\.0`, 'm'));
  assert.deepEqual(readFileSync(path.join(folder, 'again.haptoflow')), readFileSync(path.join(folder, 'real.haptoflow')));
});

/** An interpreter that prints what it was asked to run. */
function printingPython() {
  const file = path.join(folder, 'python');
  writeFileSync(file, '#!/bin/sh\ntest "$1" = -c || printf "asked: %s\\n" "$*"\n', { mode: 0o755 });
  return file;
}

test('a second run requests no bytes and hands the importer the files, the level and the place', { skip: linuxOnly }, async () => {
  const info = inRepository('package.json');
  const { status, stdout, stderr } = await published(['--dataset-info', info], { HAPTOFLOW_PYTHON: printingPython() });
  assert.equal(status, 0, stderr);
  const place = path.join(cache, 'haptoflow');
  const asked = ['-m haptoflow_paper import-published', path.join(place, 'models', 'tamago117', 'HaptoFlow', 'main', 'haptoflow_accel'), '--encodec', path.join(place, 'encodec', codecName), '-o', path.join(folder, 'published.haptoflow'), '--dataset-info', info];
  assert.ok(stdout.includes(`asked: ${asked.join(' ')}\n`), stdout);
  assert.deepEqual(hub.requests.filter(({ place: where, url }) => where === 'content' || url.includes('/resolve')), []);
  assert.doesNotMatch(stderr, /MB\/s/);
});

test('a folder of the hub that is no checkpoint is refused with what it has, before anything of it comes', async () => {
  const root = await published(['hf://tamago117/HaptoFlow@v1']);
  assert.equal(root.status, 1);
  assert.match(root.stderr, /hf:\/\/tamago117\/HaptoFlow@v1 has no meta\.json: expected .* it has README\.md, haptoflow_accel\/, two\//);
  const two = await published(['hf://tamago117/HaptoFlow/two']);
  assert.match(two.stderr, /hf:\/\/tamago117\/HaptoFlow\/two@main has a\.safetensors, b\.safetensors: expected meta\.json and one \.safetensors/);
  const none = await published(['hf://tamago117/HaptoFlow/haptoflow_audio']);
  assert.match(none.stderr, /no "haptoflow_audio" in the model repository tamago117\/HaptoFlow at revision/);
  assert.ok(hub.requests.every(({ url }) => url.startsWith('/api/')));
  for (const { stderr } of [root, two, none]) assert.doesNotMatch(stderr, /^ {4}at /m, 'a sentence, not a stack');
});

test('a checkpoint is meta.json and one .safetensors', () => {
  assert.deepEqual(checkpointNames(['x.safetensors', 'README.md', 'meta.json'], 'here'), ['meta.json', 'x.safetensors']);
  assert.throws(() => checkpointNames([], 'here'), /^Error: here has no meta\.json: .* it has nothing$/);
  assert.throws(() => checkpointNames(['meta.json'], 'here'), /here has no \.safetensors/);
});

test('a folder on this disk brings its codec where it has one, and says what it lacks', () => {
  const local = path.join(folder, 'local');
  assert.throws(() => localCheckpoint(local), /local: no such folder; expected one with meta\.json/);
  mkdirSync(local);
  assert.throws(() => localCheckpoint(local), /local has no meta\.json/);
  for (const name of ['meta.json', 'model.safetensors']) copyFileSync(inRepository('Tests', 'Golden', 'published', 'heun', name), path.join(local, name));
  assert.deepEqual(localCheckpoint(local), { folder: local, codec: null, origin: null });
  writeFileSync(path.join(local, 'encodec.th'), codec);
  assert.equal(localCheckpoint(local).codec, path.join(local, 'encodec.th'));
  writeFileSync(path.join(local, 'origin.json'), '{');
  assert.throws(() => localCheckpoint(local), /origin\.json: not valid JSON .* delete it/);
});

test('what is not known of a part\'s licence is not claimed', () => {
  const codecFile = { place: '/x/encodec.th' };
  const own = originLines({ folder: '/weights', origin: null, codec: codecFile }).join('\n');
  assert.match(own, /^weights: \/weights; where they are from is not known here$/m);
  assert.match(own, /CC BY 4\.0 .* where the weights are those of the paper's authors$/m);
  assert.match(own, /^codec: \/x\/encodec\.th; EnCodec's code/m);
  const other = { origin: 'hf://lab/touch@1', page: 'https://hub/lab/touch', repository: 'lab/touch', licence: null, files: {} };
  const others = originLines({ folder: '/c', origin: other, codec: codecFile }).join('\n');
  assert.match(others, /^weights: hf:\/\/lab\/touch@1, https:\/\/hub\/lab\/touch states no licence$/m);
  assert.match(others, /^recordings that they were trained on: see https:\/\/hub\/lab\/touch$/m);
  assert.doesNotMatch(others, /Apache|CC BY/);
});

test('an address on the hub is read in its parts, and what is none is refused', () => {
  const repo = { type: 'model', name: 'tamago117/HaptoFlow' };
  assert.deepEqual(parseSpec(defaultSpec), { repo, folder: 'haptoflow_accel', revision: 'main' });
  assert.deepEqual(parseSpec('hf://tamago117/HaptoFlow/a/b@v1.0/'.slice(0, -1)), { repo, folder: 'a/b', revision: 'v1.0' });
  assert.deepEqual(parseSpec(`hf://tamago117/HaptoFlow@${commit}`), { repo, folder: '', revision: commit });
  assert.deepEqual(parseSpec('hf://tamago117/HaptoFlow/a@refs/pr/1').revision, 'refs/pr/1');
  assert.equal(parseSpec('some/folder'), null);
  for (const [spec, why] of [
    ['hf://tamago117', /no owner and repository/],
    ['hf:///x/y', /no owner and repository/],
    ['hf://a/b/../c', /no name of a folder/],
    ['hf://a/b//c', /no name of a folder/],
    ['hf://a/b/c@', /"" is no revision/],
    ['hf://a/b/c@x@y', /more than one @/],
    ['https://huggingface.co/a/b', /only hf:\/\/ is read/],
  ]) {
    assert.throws(() => parseSpec(spec), (error) => why.test(error.message) && error.message.includes('expected hf://owner/repo/folder') && error.exitCode === 2, spec);
  }
});

test('words that cannot be meant end with 2 before anything is installed or asked for', async () => {
  for (const [words, why, env] of [
    [['--loud'], /--loud/],
    [['a', 'b'], /"b" is one folder too many/],
    [['--peak-g', '1', '--dataset-info', inRepository('package.json')], /give one/],
    [['--encodec', 'nowhere.th'], /--encodec: .*nowhere\.th is not there/],
    [['-o', 'nowhere/x.haptoflow'], /--out: .*nowhere is not there/],
    [['hf://only'], /no owner and repository/],
    [['nowhere'], /nowhere: no such folder/],
    [[], /HAPTOFLOW_ENCODEC_URL=https:\/\/x\/encodec\.th: expected an address that ends in -<8 digits/, { HAPTOFLOW_ENCODEC_URL: 'https://x/encodec.th' }],
    [[], /HF_ENDPOINT=mirror: expected an address/, { HF_ENDPOINT: 'mirror' }],
  ]) {
    const { status, stdout, stderr } = await published(words, { PATH: '', ...env });
    assert.equal(status, 2, `${words}: ${stdout}${stderr}`);
    assert.match(stderr, why);
    assert.equal(stdout, '');
  }
  assert.equal(hub.requests.length, 0);
});

test('the bar shows share, megabytes and the speed of what is new, on a terminal as it goes and elsewhere once', () => {
  const state = { title: 'lab/touch', bytes: 1_500_000, total: 3_000_000, seconds: 2, newBytes: 1_000_000 };
  assert.equal(barText(state), `lab/touch: [${'#'.repeat(12)}${'.'.repeat(12)}] 50 %, 1.5 of 3.0 MB, 0.5 MB/s`);
  assert.equal(barText({ ...state, total: null, seconds: 0 }), 'lab/touch: 1.5 MB');
  const run = (isTTY, isHere) => {
    const texts = [];
    const bar = progressBar('x', 100, { isTTY, write: (text) => texts.push(text) });
    bar.advance(50, 100, isHere);
    bar.say('waiting');
    bar.end();
    return texts;
  };
  assert.equal(run(false, false).length, 2);
  assert.deepEqual(run(false, true), ['waiting\n']);
  assert.ok(run(true, false).join('').includes('\r\x1b[K'));
});
