import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { inRepository } from '../lib/process.mjs';
import { writeHtmlPages } from './html_pages.mjs';
import { folderGuids, folderMeta, placeInPackage, samplesList } from './layout.mjs';
import { platforms, pluginsFolder } from './natives.mjs';

/**
 * Assembles the package in a folder. The folder is emptied first.
 * @param {string} folder of the package's root @param {string[]} files of the repository, relative to its root
 * @param {{platform: object, file: string}[]} natives the libraries
 */
export function stagePackage(folder, files, natives) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  for (const name of files) {
    const place = placeInPackage(name);
    // The libraries are those that were chosen; git may have older ones.
    if (place !== null && !isLibrary(place)) copyTo(inRepository(name), path.join(folder, place));
  }
  if (files.includes(samplesList)) listSamples(path.join(folder, 'package.json'), inRepository(samplesList));
  for (const { platform, file } of natives) copyTo(file, path.join(folder, pluginsFolder, platform.place));
  dropMetasOfAbsent(path.join(folder, pluginsFolder));
  if (existsSync(path.join(folder, 'Documentation~'))) writeHtmlPages(path.join(folder, 'Documentation~'));
  for (const [place, guid] of Object.entries(folderGuids)) {
    if (existsSync(path.join(folder, place))) writeFileSync(path.join(folder, `${place}.meta`), folderMeta(guid));
  }
}

const isLibrary = (place) => platforms.some((platform) => place === `${pluginsFolder}/${platform.place}`);

/**
 * Puts the list of samples into a manifest, behind the dependencies. The repository's manifest is without it: where the
 * package is used from a clone or a git URL, its folder has no samples, and every Import button would fail.
 */
function listSamples(manifest, list) {
  const samples = readJson(list);
  const entries = Object.entries(readJson(manifest)).flatMap((entry) => (entry[0] === 'dependencies' ? [entry, ['samples', samples]] : [entry]));
  writeFileSync(manifest, `${JSON.stringify(Object.fromEntries(entries), null, 2)}\n`);
}

const readJson = (file) => JSON.parse(readFileSync(file, 'utf8'));

function copyTo(from, to) {
  mkdirSync(path.dirname(to), { recursive: true });
  copyFileSync(from, to);
}

/** Deletes the .meta files of libraries that are not there, and folders left empty: git has the .meta of every platform. */
function dropMetasOfAbsent(folder) {
  if (!existsSync(folder)) return;
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    if (entry.isDirectory()) dropMetasOfAbsent(path.join(folder, entry.name));
  }
  for (const name of readdirSync(folder)) {
    if (name.endsWith('.meta') && !existsSync(path.join(folder, name.slice(0, -'.meta'.length)))) rmSync(path.join(folder, name));
  }
  if (readdirSync(folder).length === 0) {
    rmSync(folder, { recursive: true });
    rmSync(`${folder}.meta`, { force: true });
  }
}
