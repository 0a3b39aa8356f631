// The hub of the package tests, with the files of a folder as a data set: node serve_hub.mjs NAME FOLDER. Prints its address, then
// a line for each request, until standard input ends.
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import { startHub } from '../Package/support/hub_server.mjs';

const [name, folder] = process.argv.slice(2);
const below = (inside) => readdirSync(path.join(folder, inside), { withFileTypes: true }).flatMap((entry) => {
  const here = path.posix.join(inside, entry.name);
  return entry.isDirectory() ? below(here) : [here];
});
const files = Object.fromEntries(below('').map((file) => [file, readFileSync(path.join(folder, file))]));
const hub = await startHub({ repositories: [{ type: 'dataset', name, files, licence: 'cc-by-4.0' }], pageSize: 1 });
console.log(hub.address);
hub.requests.push = (...requests) => {
  for (const { place, url } of requests) console.log(`${place} ${url}`);
};
process.stdin.on('end', () => hub.close()).resume();
