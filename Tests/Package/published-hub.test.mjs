import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { createHash } from 'node:crypto';
import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { after, beforeEach, test } from 'node:test';
import { bringEncodec, cacheRoot, repositoryFolder } from '../../scripts/published/checkpoint.mjs';
import { askedWaitSeconds, download, endpointOf, listFiles, networkError, resolveRevision } from '../../scripts/published/hub.mjs';
import { commit, deafAddress, startHub } from './support/hub_server.mjs';

/** Bytes that look random and are the same every time. */
function noise(length, seed) {
  const blocks = Array.from({ length: Math.ceil(length / 32) }, (_, i) => createHash('sha256').update(`${seed} ${i}`).digest());
  return Buffer.concat(blocks).subarray(0, length);
}

const weights = noise(3_000_000, 'weights');
const meta = Buffer.from('{"model_type": "flow_matching"}\n');
const codec = noise(200_000, 'codec');
const codecName = `encodec_24khz-${createHash('sha256').update(codec).digest('hex').slice(0, 8)}.th`;
const textures = Object.fromEntries(Array.from({ length: 7 }, (_, i) => [`sensor_data/accel/38/38_${i}_20_500_0.parquet`, noise(20_000 + i, `accel ${i}`)]));
const hub = await startHub({
  pageSize: 3,
  repositories: [
    { type: 'model', name: 'lab/touch', licence: 'apache-2.0', files: { 'README.md': Buffer.from('x'), 'accel/meta.json': meta, 'accel/model.safetensors': weights } },
    { type: 'model', name: 'lab/closed', gated: true, files: { 'accel/meta.json': meta } },
    { type: 'dataset', name: 'lab/textures', licence: ['cc-by-4.0'], files: { ...textures, 'sensor_data/force/38/a.parquet': meta, 'texture_list.xlsx': meta } },
  ],
  elsewhere: { [`/encodec/v0/${codecName}`]: codec },
});
const model = { type: 'model', name: 'lab/touch' };
const dataset = { type: 'dataset', name: 'lab/textures' };
const deaf = await deafAddress();
const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-hub-'));
after(async () => {
  await hub.close();
  rmSync(folder, { recursive: true, force: true });
});

// What one test meets: the lines it was told, the seconds it was to wait, a folder of its own.
let said;
let waited;
let into;
let connection;
let number = 0;
beforeEach(() => {
  said = [];
  waited = [];
  into = path.join(folder, String((number += 1)));
  connection = { hubUrl: hub.address, say: (line) => said.push(line), wait: async (seconds) => { waited.push(seconds); } };
  hub.requests.length = 0;
  delete process.env.HF_TOKEN;
});

const entryOf = async (repo, name) => (await listFiles({ repo, folder: path.posix.dirname(name), ...connection })).find((entry) => entry.path === name);
const weightsEntry = () => entryOf(model, 'accel/model.safetensors');
const bring = async (options = {}) => download({ repo: model, file: await weightsEntry(), into, ...connection, ...options });
const filesOf = (place) => readdirSync(place, { withFileTypes: true }).flatMap((entry) => (entry.isDirectory() ? filesOf(path.join(place, entry.name)) : [entry.name]));

test('a listing has every page, with sizes, folders and the SHA-256 of large files', async () => {
  const entries = await listFiles({ repo: dataset, folder: 'sensor_data/accel/38', ...connection });
  assert.deepEqual(entries.map((entry) => entry.path), Object.keys(textures));
  for (const { path: name, size, sha256, type } of entries) {
    assert.equal(type, 'file');
    assert.equal(size, textures[name].length);
    assert.equal(sha256, createHash('sha256').update(textures[name]).digest('hex'));
  }
  assert.equal(hub.requests.length, 3);
  const folders = await listFiles({ repo: dataset, folder: 'sensor_data', ...connection });
  assert.deepEqual(folders.map(({ type, path: name }) => [type, name]), [['directory', 'sensor_data/accel'], ['directory', 'sensor_data/force']]);
  const root = await listFiles({ repo: dataset, ...connection });
  assert.deepEqual(root.map(({ path: name, sha256 }) => [name, sha256]), [['sensor_data', null], ['texture_list.xlsx', null]]);
});

test('a revision is resolved to its commit and the licence that the page states, of models and data sets', async () => {
  assert.deepEqual(await resolveRevision({ repo: model, revision: 'v1', ...connection }), { commit, licence: 'apache-2.0' });
  assert.deepEqual(await resolveRevision({ repo: dataset, ...connection }), { commit, licence: 'cc-by-4.0' });
  assert.deepEqual(await resolveRevision({ repo: { type: 'model', name: 'lab/closed' }, ...connection }), { commit, licence: null });
});

test('a large file comes over the redirect in one request for its bytes, and its parts are gone', async () => {
  const heard = [];
  const { place, sha256, isNew } = await bring({ advance: (bytes, size, isHere) => heard.push([bytes, size, isHere]) });
  assert.equal(place, path.join(into, 'accel', 'model.safetensors'));
  assert.deepEqual(readFileSync(place), weights);
  assert.equal(sha256, createHash('sha256').update(weights).digest('hex'));
  assert.equal(isNew, true);
  assert.deepEqual(hub.ranges('model.safetensors'), ['bytes=0-']);
  assert.equal(hub.requests.filter(({ url }) => url.includes('/resolve/')).length, 1);
  assert.deepEqual(filesOf(into), ['model.safetensors']);
  assert.equal(heard.reduce((sum, [bytes]) => sum + bytes, 0), weights.length);
  assert.ok(heard.every(([, size, isHere]) => size === weights.length && !isHere));
});

test('a small file, of which the listing knows Git\'s name only, is checked by it', async () => {
  const file = await entryOf(model, 'accel/meta.json');
  assert.equal(file.sha256, null);
  const { place, sha256 } = await download({ repo: model, file, into, ...connection });
  assert.deepEqual(readFileSync(place), meta);
  assert.equal(sha256, createHash('sha256').update(meta).digest('hex'));
  rmSync(place);
  hub.fail('resolve-cache', { wrong: true });
  await assert.rejects(download({ repo: model, file, into, ...connection }), /meta\.json: its Git name is [0-9a-f]{40}, and the hub's listing says/);
  assert.deepEqual(filesOf(into), []);
});

test('a complete file is not requested again', async () => {
  await bring();
  hub.requests.length = 0;
  const { isNew, sha256 } = await bring();
  assert.equal(isNew, false);
  assert.equal(sha256, createHash('sha256').update(weights).digest('hex'));
  assert.ok(hub.requests.every(({ url }) => url.includes('/tree/')), 'only the listing is asked for');
});

test('a file in the cache that was damaged is downloaded again', async () => {
  const { place } = await bring();
  const damaged = Buffer.from(weights);
  damaged[1000] ^= 1;
  writeFileSync(place, damaged);
  assert.equal((await bring()).isNew, true);
  assert.deepEqual(readFileSync(place), weights);
  assert.match(said.join('\n'), /out of date or damaged: its SHA-256 is/);
});

test('a connection that is cut goes on at the byte where it ended', async () => {
  hub.fail('/repos/lab/touch', { cutAfter: 1_200_000 }, { cutAfter: 500_000 });
  const { place } = await bring();
  assert.deepEqual(readFileSync(place), weights);
  const [first, second, third] = hub.ranges('model.safetensors').map((range) => Number(range.match(/\d+/)[0]));
  assert.equal(first, 0);
  assert.ok(second > 0 && second <= 1_200_000, String(second));
  assert.ok(third > second && third <= second + 500_000, String(third));
  assert.match(said[0], /model\.safetensors: the connection was cut; [\d.]+ of 3\.0 MB are here, going on in 1 s/);
});

test('a download that is cut again and again gives up with what to do, and the next run goes on where it ended', async () => {
  hub.fail('/repos/lab/touch', ...Array(5).fill({ cutAfter: 100_000 }));
  await assert.rejects(bring(), /the connection was cut 5 times in a row .*MB are here and stay: run again/);
  assert.deepEqual(waited, [1, 2, 4, 8]);
  const [part] = filesOf(into);
  const here = readFileSync(path.join(into, 'accel', part)).length;
  assert.ok(here > 0);
  hub.requests.length = 0;
  const heard = [];
  const { place } = await bring({ advance: (bytes, size, isHere) => heard.push([bytes, isHere]) });
  assert.deepEqual(hub.ranges('model.safetensors'), [`bytes=${here}-`]);
  assert.deepEqual(heard[0], [here, true]);
  assert.deepEqual(readFileSync(place), weights);
});

test('a long file may be cut as often as each try brings a mebibyte', async () => {
  hub.fail('/repos/lab/touch', ...Array(4).fill({ cutAfter: 50_000 }), { cutAfter: 2_000_000 }, ...Array(3).fill({ cutAfter: 50_000 }));
  assert.deepEqual(readFileSync((await bring()).place), weights);
});

test('a part of another version of the file is not continued', async () => {
  mkdirSync(path.join(into, 'accel'), { recursive: true });
  writeFileSync(path.join(into, 'accel', 'model.safetensors.00000000.part'), noise(1000, 'older'));
  await bring();
  assert.deepEqual(hub.ranges('model.safetensors'), ['bytes=0-']);
});

test('a server that does not heed the range begins anew, and the file is whole', async () => {
  hub.fail('/repos/lab/touch', { cutAfter: 1_200_000 }, { whole: true });
  const heard = [];
  const { place } = await bring({ advance: (bytes) => heard.push(bytes) });
  assert.deepEqual(readFileSync(place), weights);
  assert.equal(heard.reduce((sum, bytes) => sum + bytes, 0), weights.length);
});

test('wrong bytes are deleted, and the message states both SHA-256', async () => {
  hub.fail('/repos/lab/touch', { wrong: true });
  const right = createHash('sha256').update(weights).digest('hex');
  await assert.rejects(bring(), new RegExp(`its SHA-256 is [0-9a-f]{64}, and the hub's listing says ${right}: .* is deleted; run again`));
  assert.deepEqual(filesOf(into), []);
  assert.deepEqual(readFileSync((await bring()).place), weights);
});

test('a hub that is asked too often is asked again after the seconds that it names, in listings and in files', async () => {
  hub.fail('/tree/', { status: 429, headers: { 'Retry-After': '7' } });
  hub.fail('/resolve/', { status: 429, headers: { RateLimit: '"resolvers";r=0;t=123' } }, { status: 503 });
  await bring();
  assert.deepEqual(waited, [7, 123, 2]);
  assert.match(said[0], /^127\.0\.0\.1:\d+ answers fewer requests \(429\): waiting 7 s$/);
});

test('a hub that stays busy is left with a sentence after five tries, and at once where it asks for more than five minutes', async () => {
  hub.fail('/tree/', ...Array(5).fill({ status: 429, headers: { 'Retry-After': '2' } }));
  await assert.rejects(weightsEntry(), /answers fewer requests \(429\), 5 times in a row: run again later; what is downloaded stays/);
  assert.deepEqual(waited, [2, 2, 2, 2]);
  hub.fail('/tree/', { status: 429, headers: { 'Retry-After': '3600' } });
  await assert.rejects(weightsEntry(), /\(429\) and asks to wait 3600 s: run again later/);
});

test('the wait is read from seconds, from a date and from the hub\'s RateLimit header', () => {
  const now = Date.parse('2026-11-28T12:00:00Z');
  const wait = (headers) => askedWaitSeconds(new Headers(headers), now);
  assert.equal(wait({ 'Retry-After': '12' }), 12);
  assert.equal(wait({ 'Retry-After': 'Sat, 28 Nov 2026 12:01:30 GMT' }), 90);
  assert.equal(wait({ 'Retry-After': 'Sat, 28 Nov 2026 11:00:00 GMT' }), 0);
  assert.equal(wait({ RateLimit: '"api";r=0;t=55' }), 55);
  assert.equal(wait({}), null);
});

test('a listing that is cut, before its answer or within, is asked for again, and given up after five tries', async () => {
  hub.fail('/tree/', { hangUp: true }, { cutAfter: 20 });
  assert.equal((await weightsEntry()).size, weights.length);
  assert.deepEqual(waited, [1, 2]);
  hub.fail('/tree/', ...Array(5).fill({ cutAfter: 20 }));
  await assert.rejects(weightsEntry(), /the connection was cut 5 times in a row: run again/);
});

test('a repository, a revision, a folder and a file that are not there are named', async () => {
  const named = (repo, query) => listFiles({ repo, ...query, ...connection });
  await assert.rejects(named(model, { folder: 'haptoflow_audio' }), /has no "haptoflow_audio" in the model repository lab\/touch at revision main \(404\): http.*\/lab\/touch shows/);
  await assert.rejects(resolveRevision({ repo: model, revision: 'v9', ...connection }), /no model repository lab\/touch with the revision v9 \(404\)/);
  await assert.rejects(named({ type: 'model', name: 'lab/none' }, {}), /does not show the model repository lab\/none \(401\): it does not exist, or it is private or gated/);
  process.env.HF_TOKEN = 'hf_member';
  await assert.rejects(resolveRevision({ repo: { type: 'dataset', name: 'lab/none' }, ...connection }), /no dataset repository lab\/none with the revision main \(404\): http.*\/datasets\/lab\/none/);
  const gone = { type: 'file', path: 'accel/none.bin', size: 3, oid: '0'.repeat(40), sha256: null };
  await assert.rejects(download({ repo: model, file: gone, into, ...connection }), /no "accel\/none\.bin" in the model repository lab\/touch at revision main/);
});

test('a gated repository says where its terms are and how a token is given; a token opens it', async () => {
  const closed = { repo: { type: 'model', name: 'lab/closed' }, folder: 'accel', ...connection };
  await assert.rejects(listFiles(closed), /lab\/closed \(401\).* gated\. See http.*\/lab\/closed; .* set HF_TOKEN/);
  process.env.HF_TOKEN = 'hf_stranger';
  await assert.rejects(listFiles(closed), /lab\/closed \(403\)/);
  process.env.HF_TOKEN = 'hf_member';
  assert.equal((await listFiles(closed)).length, 1);
  process.env.HF_TOKEN = 'secret';
  await assert.rejects(listFiles(closed), (error) => /HF_TOKEN is set and is no token/.test(error.message) && !error.message.includes('secret'));
});

test('a token goes to the hub and not to the host that has the bytes', async () => {
  process.env.HF_TOKEN = 'hf_member';
  await bring();
  const of = (where) => hub.requests.filter(({ place }) => place === where).map(({ headers }) => headers.authorization);
  assert.ok(of('hub').length > 0 && of('hub').every((token) => token === 'Bearer hf_member'));
  assert.deepEqual(of('content'), [undefined]);
});

test('without a network the message names the host, the reason, the proxy\'s variables and the way by hand', async () => {
  await assert.rejects(listFiles({ repo: model, ...connection, hubUrl: deaf }), (error) => {
    for (const word of [`${deaf} cannot be reached`, 'ECONNREFUSED', 'HTTPS_PROXY', 'NODE_USE_ENV_PROXY=1', 'NODE_EXTRA_CA_CERTS', 'HF_ENDPOINT', './run published FOLDER']) {
      assert.ok(error.message.includes(word), `${word}: ${error.message}`);
    }
    return true;
  });
  assert.deepEqual(waited, []);
  const failed = Object.assign(new TypeError('fetch failed'), { cause: { code: 'ENOTFOUND' } });
  const told = (env) => networkError('https://huggingface.co/api/x', failed, env, '20.1.0').message;
  assert.match(told({ HTTPS_PROXY: 'http://proxy:1' }), /https:\/\/huggingface\.co cannot be reached \(ENOTFOUND\).*\(HTTPS_PROXY is set\).*this is 20\.1\.0/);
  assert.match(told({}), /HTTPS_PROXY is not set/);
});

test('an answer that is not the hub\'s is said to be none', async () => {
  hub.fail('/tree/', { page: '<html>Please log in to the network</html>' });
  await assert.rejects(weightsEntry(), /not the hub's answer .* check HF_ENDPOINT, and whether a proxy answers in its place/);
});

test('a listing cannot place a file outside the folder', async () => {
  const file = { ...(await weightsEntry()), path: '../../escaped.bin' };
  await assert.rejects(download({ repo: model, file, into, ...connection }), /has a file "\.\.\/\.\.\/escaped\.bin", which is outside its folder; nothing is written/);
});

/** A folder on a disk of 1.5 MB: a file system in memory for root, else a write that fails as on a full disk. */
async function onSmallDisk(work) {
  mkdirSync(into, { recursive: true });
  const mounted = process.platform === 'linux' && spawnSync('mount', ['-t', 'tmpfs', '-o', 'size=1500k', 'tmpfs', into]).status === 0;
  if (mounted) {
    try {
      return await work();
    } finally {
      spawnSync('umount', [into]);
    }
  }
  const { open } = await import('node:fs/promises');
  const probe = await open(process.execPath);
  const kind = Object.getPrototypeOf(probe);
  await probe.close();
  const { appendFile } = kind;
  let room = 1_500_000;
  kind.appendFile = function limited(chunk) {
    room -= chunk.length;
    return room < 0 ? Promise.reject(Object.assign(new Error('ENOSPC'), { code: 'ENOSPC' })) : appendFile.call(this, chunk);
  };
  try {
    return await work();
  } finally {
    kind.appendFile = appendFile;
  }
}

test('a full disk keeps what is there and says how much is needed', async () => {
  await onSmallDisk(async () => {
    await assert.rejects(bring(), (error) => {
      const [, here, needed] = error.message.match(/the disk is full \(ENOSPC\)\. ([\d.]+) MB of model\.safetensors are here and stay; ([\d.]+) MB more are needed: make room, or set XDG_CACHE_HOME/) ?? assert.fail(error.message);
      assert.ok(Number(here) > 1 && Math.abs(Number(here) + Number(needed) - 3) < 0.11, error.message);
      return true;
    });
    const [part] = filesOf(into);
    const kept = readFileSync(path.join(into, 'accel', part));
    assert.ok(kept.length > 1_000_000);
    assert.deepEqual(kept, weights.subarray(0, kept.length));
  });
});

test('a cache that cannot be written is named with the variable that moves it', async () => {
  writeFileSync(into, 'a file in its place');
  await assert.rejects(bring(), /cannot be written \((ENOTDIR|EEXIST)\): set XDG_CACHE_HOME/);
});

test('EnCodec\'s file is checked by the digits in its name, resumed, and kept', async () => {
  const address = `${hub.contentAddress}/encodec/v0/${codecName}`;
  hub.fail(codecName, { cutAfter: 60_000 });
  const first = await bringEncodec({ address, root: into, ...connection });
  assert.equal(first.place, path.join(into, 'encodec', codecName));
  assert.deepEqual(readFileSync(first.place), codec);
  assert.equal(hub.ranges(codecName).length, 2);
  assert.equal((await bringEncodec({ address, root: into, ...connection })).isNew, false);
  assert.equal(hub.ranges(codecName).length, 2);
});

test('another file under EnCodec\'s name is deleted, and a place without it says what to set', async () => {
  const address = `${hub.contentAddress}/encodec/v0/${codecName}`;
  hub.fail(codecName, { wrong: true });
  await assert.rejects(bringEncodec({ address, root: into, ...connection }), /its SHA-256 is [0-9a-f]{64}, and its name says [0-9a-f]{8}: .* deleted/);
  assert.deepEqual(filesOf(into), []);
  await assert.rejects(bringEncodec({ address: `${hub.contentAddress}/none-00000000.th`, root: into, ...connection }), /answers 403: HAPTOFLOW_ENCODEC_URL names another place/);
  await assert.rejects(bringEncodec({ address: `${deaf}/x-00000000.th`, root: into, ...connection }), /127\.0\.0\.1:\d+ cannot be reached \(ECONNREFUSED\)/);
});

test('what is complete and was not renamed is renamed without its bytes coming again', async () => {
  const address = `${hub.contentAddress}/encodec/v0/${codecName}`;
  mkdirSync(path.join(into, 'encodec'), { recursive: true });
  writeFileSync(path.join(into, 'encodec', `${codecName}.${codecName.slice(-11, -3)}.part`), codec);
  const { place } = await bringEncodec({ address, root: into, ...connection });
  assert.deepEqual(readFileSync(place), codec);
  assert.deepEqual(filesOf(into), [codecName]);
});

test('the cache lies where each system keeps caches, apart for models, data sets and revisions', () => {
  assert.equal(cacheRoot({ XDG_CACHE_HOME: '/x' }, 'linux'), path.resolve('/x/haptoflow'));
  assert.equal(cacheRoot({ HOME: '/users/a' }, 'linux'), path.resolve('/users/a/.cache/haptoflow'));
  assert.equal(cacheRoot({ LOCALAPPDATA: '/local' }, 'win32'), path.resolve('/local/haptoflow/cache'));
  assert.equal(repositoryFolder(dataset, 'refs/pr/1', '/c'), path.join('/c', 'datasets', 'lab', 'textures', 'refs%2Fpr%2F1'));
});

test('the endpoint is the hub\'s, or HF_ENDPOINT, and a word that is no address is refused', () => {
  assert.equal(endpointOf({}), 'https://huggingface.co');
  assert.equal(endpointOf({ HF_ENDPOINT: 'https://mirror.example/' }), 'https://mirror.example');
  assert.throws(() => endpointOf({ HF_ENDPOINT: 'mirror' }), /HF_ENDPOINT=mirror: expected an address/);
});
