import { existsSync } from 'node:fs';
import { inRepository, runOrFail } from '../lib/process.mjs';

const git = async (...args) =>
  (await runOrFail('git', args, { quiet: true })).split('\0').filter((name) => name !== '' && existsSync(inRepository(name)));

/** Every file that git tracks or would track, relative to the root. */
export const repositoryFiles = () => git('ls-files', '-z', '--cached', '--others', '--exclude-standard');

/** The files of `files` that differ from the last commit. */
export async function changedFiles(files) {
  const changed = new Set([
    ...(await git('diff', '-z', '--name-only', 'HEAD')),
    ...(await git('ls-files', '-z', '--others', '--exclude-standard')),
  ]);
  return files.filter((name) => changed.has(name));
}

/** Files whose names end in one of the extensions. */
export const endingIn = (files, ...extensions) => files.filter((name) => extensions.some((extension) => name.endsWith(extension)));
