// The hub (Hugging Face) on the loopback address, for tests: the paths, pages, redirects and headers that its client meets, and
// faults on request. Content of large files comes from a second port, as the hub's comes from another host.
import { createHash } from 'node:crypto';
import http from 'node:http';

export const commit = '3f2a5c0e9d8b7a6f5e4d3c2b1a0f9e8d7c6b5a49';
const hash = (kind, ...parts) => parts.reduce((sum, part) => sum.update(part), createHash(kind)).digest('hex');
const gitName = (bytes) => hash('sha1', `blob ${bytes.length}\0`, bytes);

/**
 * @param {object} content
 * @param {{type: 'model' | 'dataset', name: string, files: Record<string, Buffer>, licence?: string | string[], gated?: boolean}[]} content.repositories
 *   files by their path; larger than 10,000 bytes they are large files (LFS)
 * @param {Record<string, Buffer>} [content.elsewhere] files that no repository has, by their path on the second port
 * @param {number} [content.pageSize] entries of a listing's page
 */
export async function startHub({ repositories, elsewhere = {}, pageSize = 1000 }) {
  /** Every request: {place: 'hub' | 'content', method, url, headers}. */
  const requests = [];
  /** Faults by a part of the path, each list used from its beginning. */
  const faults = new Map();
  const servers = await Promise.all([listen((request, response) => onHub(request, response)), listen((request, response) => onContent(request, response))]);
  const [address, contentAddress] = servers.map((server) => `http://127.0.0.1:${server.address().port}`);

  const faultOf = (url) => [...faults].find(([part, list]) => url.includes(part) && list.length > 0)?.[1].shift();

  function onHub(request, response) {
    requests.push({ place: 'hub', method: request.method, url: request.url, headers: request.headers });
    const fault = faultOf(request.url);
    if (fault?.status) return json(response, fault.status, { error: 'a fault' }, fault.headers);
    if (fault?.page) return send(response, 200, { 'Content-Type': 'text/html' }, fault.page);
    if (fault?.hangUp) return request.socket.destroy();
    const url = new URL(request.url, address);
    const path = decodeURIComponent(url.pathname);
    for (const repository of repositories) {
      const { type, name } = repository;
      const at = (prefix) => (path.startsWith(`${prefix}/`) || path === prefix ? path.slice(prefix.length + 1) : null);
      const page = type === 'model' ? `/${name}` : `/${type}s/${name}`;
      const inApi = at(`/api/${type}s/${name}`);
      const toResolve = at(`${page}/resolve`);
      if ((inApi ?? toResolve) === null && at(`/api/resolve-cache/${type}s/${name}`) === null) continue;
      // The page of a gated repository is open, its files are not.
      if (repository.gated && !inApi?.startsWith('revision/') && request.headers.authorization !== 'Bearer hf_member') {
        const [status, words] = request.headers.authorization ? [403, 'you are not in the authorized list'] : [401, 'you must be authenticated'];
        return json(response, status, { error: `Access to ${type} ${name} is restricted, ${words}.` }, { 'X-Error-Code': 'GatedRepo' });
      }
      if (inApi?.startsWith('revision/')) return revision(response, repository, inApi.slice('revision/'.length));
      if (inApi?.startsWith('tree/')) return tree(response, repository, inApi.slice('tree/'.length), url, fault);
      if (toResolve !== null) return resolve(response, repository, toResolve);
      const [, ...rest] = at(`/api/resolve-cache/${type}s/${name}`).split('/');
      return bytes(request, response, repository.files[rest.join('/')], fault);
    }
    // To a stranger the hub does not say whether a repository exists.
    return request.headers.authorization
      ? json(response, 404, { error: 'Repository not found' }, { 'X-Error-Code': 'RepoNotFound' })
      : json(response, 401, { error: 'Invalid username or password.' }, { 'X-Error-Code': 'RepoNotFound' });
  }

  const isRevision = (word) => ['main', 'HEAD', 'v1', commit].includes(word);
  const noRevision = (response, word) => json(response, 404, { error: `Invalid rev id: ${word}` }, { 'X-Error-Code': 'RevisionNotFound' });

  function revision(response, { name, licence, gated }, word) {
    if (!isRevision(word)) return noRevision(response, word);
    const cardData = licence === undefined ? {} : { cardData: { license: licence } };
    return json(response, 200, { _id: '0123', id: name, private: false, gated: gated ? 'auto' : false, downloads: 1, likes: 0, lastModified: '2026-08-04T00:00:00.000Z', sha: commit, ...cardData });
  }

  function tree(response, { type, name, files }, rest, url, fault) {
    const [word, ...folders] = rest.split('/');
    if (!isRevision(word)) return noRevision(response, word);
    const folder = folders.filter(Boolean).map((part) => `${part}/`).join('');
    const inside = Object.keys(files).filter((path) => path.startsWith(folder)).map((path) => path.slice(folder.length));
    if (inside.length === 0) return json(response, 404, { error: `${folder.slice(0, -1)} does not exist on "${word}"` }, { 'X-Error-Code': 'EntryNotFound' });
    const entries = [...new Set(inside.map((path) => path.split('/')[0] + (path.includes('/') ? '/' : '')))].map((path) => entryOf(folder + path, files));
    const begin = Number(url.searchParams.get('cursor') ?? 0);
    const headers = {};
    if (begin + pageSize < entries.length) {
      url.searchParams.set('cursor', String(begin + pageSize));
      headers.Link = `<${address}/api/${type}s/${name}/tree/${rest}${url.search}>; rel="next"`;
    }
    if (fault?.cutAfter !== undefined) return cut(response, 200, { 'Content-Type': 'application/json; charset=utf-8' }, JSON.stringify(entries).slice(0, fault.cutAfter));
    return json(response, 200, entries.slice(begin, begin + pageSize), headers);
  }

  function resolve(response, { type, name, files }, rest) {
    const [word, ...parts] = rest.split('/');
    if (!isRevision(word)) return noRevision(response, word);
    const path = parts.join('/');
    const content = files[path];
    if (content === undefined) return json(response, 404, { error: 'Entry not found' }, { 'X-Error-Code': 'EntryNotFound' });
    const [status, place] = isLarge(content)
      ? [302, `${contentAddress}/repos/${name}/${path}?Signature=x`]
      : [307, `/api/resolve-cache/${type}s/${name}/${commit}/${path}`];
    return send(response, status, { 'X-Repo-Commit': commit, 'Accept-Ranges': 'bytes', ETag: `"${gitName(content)}"`, Location: place }, '');
  }

  function onContent(request, response) {
    requests.push({ place: 'content', method: request.method, url: request.url, headers: request.headers });
    const fault = faultOf(request.url);
    if (fault?.status) return send(response, fault.status, fault.headers ?? {}, '');
    const path = decodeURIComponent(new URL(request.url, address).pathname);
    const found = repositories.flatMap(({ name, files }) => Object.entries(files).map(([file, content]) => [`/repos/${name}/${file}`, content]));
    const content = Object.fromEntries([...found, ...Object.entries(elsewhere)])[path];
    // A signature is good for one request's address, and a token of the hub is nothing to this host.
    if (content === undefined || request.headers.authorization) return send(response, 403, {}, 'AccessDenied');
    return bytes(request, response, content, fault);
  }

  return {
    address,
    contentAddress,
    requests,
    /**
     * Makes the next requests whose address contains `part` fail, one fault each: {status, headers}; {page: html};
     * {hangUp: true}; {cutAfter: bytes}; {wrong: true} one byte is another; {whole: true} a range is not heeded;
     * undefined lets one pass.
     */
    fail: (part, ...list) => faults.set(part, list),
    /** The ranges that were asked for of files whose address contains `part`, at the place of their bytes. */
    ranges: (part) => requests.filter(({ place, url }) => url.includes(part) && (place === 'content' || url.includes('resolve-cache'))).map(({ headers }) => headers.range),
    async close() {
      await Promise.all(servers.map((server) => new Promise((done) => { server.close(done); server.closeAllConnections(); })));
    },
  };
}

/** An address of this machine at which nobody listens any more. */
export async function deafAddress() {
  const server = await listen(() => {});
  const address = `http://127.0.0.1:${server.address().port}`;
  await new Promise((done) => { server.close(done); });
  return address;
}

const isLarge = (content) => content.length > 10_000;

function entryOf(path, files) {
  if (path.endsWith('/')) return { type: 'directory', oid: hash('sha1', path), size: 0, path: path.slice(0, -1) };
  const content = files[path];
  if (!isLarge(content)) return { type: 'file', oid: gitName(content), size: content.length, path };
  const sha256 = hash('sha256', content);
  const pointer = `version https://git-lfs.github.com/spec/v1\noid sha256:${sha256}\nsize ${content.length}\n`;
  const lfs = { oid: sha256, size: content.length, pointerSize: pointer.length };
  return { type: 'file', oid: gitName(Buffer.from(pointer)), size: content.length, lfs, xetHash: hash('sha256', 'xet', content), path };
}

function bytes(request, response, content, fault) {
  const etag = { ETag: `"${createHash('md5').update(content).digest('hex')}"`, 'Accept-Ranges': 'bytes' };
  const range = fault?.whole ? null : request.headers.range?.match(/^bytes=(\d+)-(\d*)$/);
  const from = range ? Number(range[1]) : 0;
  if (range && from >= content.length) return send(response, 416, { 'Content-Range': `bytes */${content.length}` }, '');
  const end = range?.[2] ? Math.min(content.length, Number(range[2]) + 1) : content.length;
  const part = Buffer.from(content.subarray(from, end));
  if (fault?.wrong) part[0] ^= 1;
  const headers = { ...etag, 'Content-Length': part.length, ...(range ? { 'Content-Range': `bytes ${from}-${end - 1}/${content.length}` } : {}) };
  if (fault?.cutAfter === undefined) return send(response, range ? 206 : 200, headers, part);
  return cut(response, range ? 206 : 200, headers, part.subarray(0, fault.cutAfter));
}

/** Ends a connection in the middle of an answer, after what was written has left. */
function cut(response, status, headers, body) {
  response.writeHead(status, headers);
  response.write(body, () => setTimeout(() => response.destroy(), 20));
}

function send(response, status, headers, body) {
  response.writeHead(status, headers);
  response.end(body);
}

const json = (response, status, value, headers = {}) => send(response, status, { 'Content-Type': 'application/json; charset=utf-8', ...headers }, JSON.stringify(value));

function listen(handle) {
  // Node 18.15 runs no `after` outside of tests: what is not closed must not keep the process.
  const server = http.createServer(handle).unref();
  return new Promise((resolve) => server.listen(0, '127.0.0.1', () => resolve(server)));
}
