import { createReadStream, statSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';
import { CommandError } from './process.mjs';

const types = {
  '.html': 'text/html; charset=utf-8', '.css': 'text/css; charset=utf-8', '.mjs': 'text/javascript; charset=utf-8', '.js': 'text/javascript; charset=utf-8',
  '.json': 'application/json', '.wasm': 'application/wasm', '.png': 'image/png', '.svg': 'image/svg+xml',
};
/** What a page must be served with for its threads to share memory. */
const isolationHeaders = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

function fileOf(/** @type {string} */ folder, /** @type {string} */ address) {
  const { pathname } = new URL(address, 'http://localhost');
  const file = path.join(folder, ...decodeURIComponent(pathname).split('/'));
  // A path may not lead out of the folder.
  if (file !== folder && !file.startsWith(folder + path.sep)) return null;
  const found = statSync(file, { throwIfNoEntry: false })?.isDirectory() ? path.join(file, 'index.html') : file;
  return statSync(found, { throwIfNoEntry: false })?.isFile() ? found : null;
}

/**
 * Serves a folder on the loopback address only.
 * @param {{folder: string, port?: number}} options port: 0 or none takes a free one
 * @returns {Promise<{address: string, close: () => void}>}
 */
export async function serveFolder({ folder, port = 0 }) {
  const server = createServer((request, response) => {
    const headers = { 'Cache-Control': 'no-cache', ...isolationHeaders };
    let file = null;
    try {
      file = fileOf(folder, request.url ?? '/');
    } catch {
      // An address that cannot be decoded names no file.
    }
    if (file === null || !['GET', 'HEAD'].includes(request.method ?? '')) {
      response.writeHead(file === null ? 404 : 405, headers).end();
      return;
    }
    response.writeHead(200, { ...headers, 'Content-Type': types[path.extname(file)] ?? 'application/octet-stream', 'Content-Length': statSync(file).size });
    if (request.method === 'HEAD') response.end();
    else createReadStream(file).pipe(response);
  });
  await new Promise((resolve, reject) => {
    server.once('error', (/** @type {any} */ error) => {
      reject(error.code === 'EADDRINUSE' ? new CommandError(`port ${port} is taken: name another with --port, or leave it out for a free one`, 2) : error);
    });
    server.listen(port, '127.0.0.1', () => resolve(undefined));
  });
  const { port: taken } = /** @type {import('node:net').AddressInfo} */ (server.address());
  return {
    address: `http://localhost:${taken}/`,
    close: () => {
      server.closeAllConnections();
      server.close();
    },
  };
}
