import { mkdirSync, mkdtempSync, readFileSync, readdirSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { runNpmOrFail, runOrFail } from '../lib/process.mjs';

/**
 * A package as Unity would read it: every file by its name in the package, slashes between folders.
 * Folders that end in "~" and names that begin with a dot are included, though Unity imports none of them.
 */
export class PackageFiles {
  /** @param {Map<string, Buffer | string>} contents */
  constructor(contents) {
    this.contents = contents;
    this.names = [...contents.keys()].sort();
    this.folders = [...new Set(this.names.flatMap(parentsOf))].sort();
  }

  /** The files below a folder on disk whose names are wanted. */
  static inFolder(folder, isWanted = () => true) {
    const contents = new Map();
    const add = (place) => {
      for (const entry of readdirSync(path.join(folder, place), { withFileTypes: true })) {
        const name = place === '' ? entry.name : `${place}/${entry.name}`;
        if (entry.isDirectory()) add(name);
        else if (isWanted(name)) contents.set(name, readFileSync(path.join(folder, name)));
      }
    };
    add('');
    return new PackageFiles(contents);
  }

  has(name) {
    return this.contents.has(name);
  }

  bytes(name) {
    return Buffer.from(this.contents.get(name));
  }

  text(name) {
    return this.bytes(name).toString('utf8');
  }

  /** Names with one of the endings. */
  endingIn(...endings) {
    return this.names.filter((name) => endings.some((ending) => name.endsWith(ending)));
  }
}

/** "a/b/c" -> ["a", "a/b"]. */
export function parentsOf(name) {
  const pieces = name.split('/').slice(0, -1);
  return pieces.map((_, index) => pieces.slice(0, index + 1).join('/'));
}

/** Whether Unity imports a file: no part of its name ends in "~" or begins with a dot. */
export const isImported = (name) => name.split('/').every((piece) => !piece.endsWith('~') && !piece.startsWith('.'));

/** The sample a file belongs to, for example "Samples~/StylusTracing"; null outside of samples. */
export const sampleOf = (name) => name.match(/^Samples~\/[^/]+(?=\/)/)?.[0] ?? null;

/**
 * Makes the tarball of a staged package with npm, whose layout Unity's package manager reads.
 * @param {string} folder the staged package @param {string} destination folder for the tarball
 * @returns {Promise<{file: string, bytes: number, unpackedBytes: number}>}
 */
export async function makeTarball(folder, destination) {
  mkdirSync(destination, { recursive: true });
  const words = ['pack', folder, '--pack-destination', destination, '--json', '--ignore-scripts', '--loglevel=error'];
  const output = await runNpmOrFail(words);
  const [{ filename, size, unpackedSize }] = JSON.parse(output.slice(output.indexOf('[')));
  return { file: path.join(destination, filename), bytes: size, unpackedBytes: unpackedSize };
}

/** The files of a package's tarball. @returns {Promise<PackageFiles>} */
export async function readTarball(file) {
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-tarball-'));
  try {
    await runOrFail('tar', ['-xzf', file, '-C', folder], { quiet: true });
    return PackageFiles.inFolder(path.join(folder, 'package'));
  } finally {
    rmSync(folder, { recursive: true });
  }
}
