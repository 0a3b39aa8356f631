import { mkdirSync, mkdtempSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { runNpmOrFail, runOrFail } from '../lib/process.mjs';
import { PackageFiles } from './package_files.mjs';

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
