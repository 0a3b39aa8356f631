import { copyFileSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { inRepository } from '../lib/process.mjs';
import { writeHtmlPages } from './html_pages.mjs';
import { folderGuids, folderMeta, packageName, placeInPackage, samplesList, studiesName } from './layout.mjs';
import { platforms, pluginsFolder } from './natives.mjs';

/** Empties a folder and copies there what belongs to a package, by the place of each file. */
function copyPackage(folder, files, ofPackage, isLeftOut = () => false) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  for (const name of files) {
    const place = placeInPackage(name, ofPackage);
    if (place !== null && !isLeftOut(place)) copyTo(inRepository(name), path.join(folder, place));
  }
}

/** A link to a page that is in another package becomes the page's name: no path leads there. */
function nameOtherPages(pages, owner) {
  for (const file of existsSync(pages) ? readdirSync(pages).filter((name) => name.endsWith('.md')) : []) {
    const named = readFileSync(path.join(pages, file), 'utf8').replace(/\[([^\]]*)\]\(([\w-]+\.md)(#[^)]*)?\)/g, (link, text, page) =>
      existsSync(path.join(pages, page)) ? link : `${text} (\`${page}\` of ${owner})`);
    writeFileSync(path.join(pages, file), named);
  }
}

/** Assembles the package of the studies in a folder, as `stagePackage` does the other. */
export function stageStudies(folder, files) {
  copyPackage(folder, files, studiesName);
  nameOtherPages(path.join(folder, 'Documentation~'), 'HaptoFlow');
}

/**
 * Assembles the package in a folder. The folder is emptied first.
 * @param {string} folder of the package's root @param {string[]} files of the repository, relative to its root
 * @param {{platform: object, file: string}[]} natives the libraries
 */
export function stagePackage(folder, files, natives) {
  // The libraries are those that were chosen; git may have older ones.
  copyPackage(folder, files, packageName, isLibrary);
  if (files.includes(samplesList)) listSamples(path.join(folder, 'package.json'), inRepository(samplesList));
  for (const { platform, file } of natives) copyTo(file, path.join(folder, pluginsFolder, platform.place));
  dropMetasOfAbsent(path.join(folder, pluginsFolder));
  nameOtherPages(path.join(folder, 'Documentation~'), 'HaptoFlow Studies');
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
