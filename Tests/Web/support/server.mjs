import { existsSync, readFileSync, statSync } from 'node:fs';
import { createServer } from 'node:http';
import path from 'node:path';

const types = { '.html': 'text/html', '.css': 'text/css', '.mjs': 'text/javascript', '.js': 'text/javascript', '.wasm': 'application/wasm', '.json': 'application/json' };
const isolation = { 'Cross-Origin-Opener-Policy': 'same-origin', 'Cross-Origin-Embedder-Policy': 'require-corp' };

/**
 * Serves folders on the loopback address.
 * @param {{folders: Record<string, string>, isolated?: boolean, headers?: Record<string, string>, mediaTypes?: Record<string, string>,
 *   answers?: Record<string, (body: string) => string>}} options folders by the first part of the path; headers: of every answer besides;
 *   mediaTypes: by ending, instead of the usual; answers: what a path answers to what was sent to it, as JSON
 * @returns {Promise<{address: string, changes: Map<string, (bytes: Buffer) => Buffer | number>, documents: Map<string, string>, close: () => Promise<void>}>} changes: what a
 *   path answers instead of its file: other bytes, or a status; documents: HTML by its path
 */
export async function serve({ folders, isolated = true, headers: more = {}, mediaTypes = {}, answers = {} }) {
  const changes = new Map();
  const documents = new Map();
  const server = createServer(async (request, response) => {
    const { pathname } = new URL(request.url ?? '/', 'http://localhost');
    const [, first, ...rest] = pathname.split('/');
    if (pathname === '/favicon.ico') {
      response.writeHead(204).end();
      return;
    }
    const document = documents.get(pathname);
    if (document !== undefined) {
      response.writeHead(200, { 'Content-Type': types['.html'] }).end(document);
      return;
    }
    const file = folders[first] && path.join(folders[first], ...rest.map(decodeURIComponent));
    const headers = { 'Cache-Control': 'no-store', ...(isolated ? isolation : {}), ...more };
    if (answers[pathname]) {
      let body = '';
      for await (const bytes of request) body += bytes;
      response.writeHead(200, { ...headers, 'Content-Type': types['.json'] }).end(answers[pathname](body));
      return;
    }
    if (!file || !existsSync(file) || !statSync(file).isFile()) {
      response.writeHead(404, headers).end();
      return;
    }
    const changed = changes.get(pathname)?.(readFileSync(file)) ?? readFileSync(file);
    if (typeof changed === 'number') {
      response.writeHead(changed, headers).end();
      return;
    }
    response.writeHead(200, { ...headers, 'Content-Type': mediaTypes[path.extname(file)] ?? types[path.extname(file)] ?? 'application/octet-stream', 'Content-Length': changed.length }).end(changed);
  });
  await new Promise((resolve) => {
    server.listen(0, '127.0.0.1', () => resolve(undefined));
  });
  const { port } = /** @type {import('node:net').AddressInfo} */ (server.address());
  return {
    address: `http://127.0.0.1:${port}`,
    changes,
    documents,
    close: () => new Promise((resolve) => {
      server.closeAllConnections();
      server.close(() => resolve(undefined));
    }),
  };
}
