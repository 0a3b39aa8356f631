import assert from 'node:assert/strict';
import { mkdirSync, mkdtempSync, rmSync, writeFileSync } from 'node:fs';
import http from 'node:http';
import os from 'node:os';
import path from 'node:path';
import { after, before, test } from 'node:test';
import { optionsOf } from '../../scripts/play.mjs';
import { serveFolder } from '../../scripts/lib/static_server.mjs';

let folder = '';
/** @type {Awaited<ReturnType<typeof serveFolder>>} */
let served;

before(async () => {
  const parent = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-page-'));
  folder = path.join(parent, 'page');
  mkdirSync(folder);
  writeFileSync(path.join(parent, 'secret.txt'), 'secret');
  writeFileSync(path.join(folder, 'index.html'), '<!doctype html>');
  writeFileSync(path.join(folder, 'engine.wasm'), 'x');
  served = await serveFolder({ folder });
});
after(() => {
  served.close();
  rmSync(path.dirname(folder), { recursive: true, force: true });
});

/** Without fetch, which tidies paths. */
const get = (/** @type {string} */ place, method = 'GET') => new Promise((resolve, reject) => {
  const request = http.request({ host: '127.0.0.1', port: new URL(served.address).port, path: place, method }, (response) => {
    response.resume();
    resolve({ status: response.statusCode, headers: response.headers });
  });
  request.on('error', reject).end();
});

test('the page comes with the headers for shared memory, and with its types', async () => {
  const page = await get('/');
  assert.equal(page.status, 200);
  assert.equal(page.headers['cross-origin-opener-policy'], 'same-origin');
  assert.equal(page.headers['cross-origin-embedder-policy'], 'require-corp');
  assert.match(page.headers['content-type'], /text\/html/);
  assert.equal((await get('/engine.wasm')).headers['content-type'], 'application/wasm');
});

test('nothing outside the folder is served, whatever the path', async () => {
  for (const place of ['/../secret.txt', '/%2e%2e/secret.txt', '/..%2fsecret.txt', '/%', '/missing.mjs']) assert.equal((await get(place)).status, 404, place);
  assert.equal((await get('/', 'POST')).status, 405);
});

test('a port that is taken is named with a remedy', async () => {
  await assert.rejects(serveFolder({ folder, port: Number(new URL(served.address).port) }), /port \d+ is taken: name another/);
});

test('options are read, and wrong ones named', () => {
  assert.deepEqual(optionsOf([]), { port: 0, opens: true, rebuilds: false });
  assert.deepEqual(optionsOf(['--port', '8080', '--no-open']), { port: 8080, opens: false, rebuilds: false });
  assert.throws(() => optionsOf(['--port', 'many']), /1 to 65535/);
  assert.throws(() => optionsOf(['--port']), /--port/);
  assert.throws(() => optionsOf(['--fast']), /--fast/);
});
