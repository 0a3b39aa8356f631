// Publishes the content of the package's tarball as a branch that Unity's Package Manager installs from; --help
import { existsSync, mkdirSync, mkdtempSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { CommandError, callerFolder, inRepository, parsed, run, runMain, runOrFail } from '../lib/process.mjs';
import { readTarball } from './package_files.mjs';

const help = `usage: node scripts/pack/upm_branch.mjs TARBALL --remote URL [--branch upm] [--dry-run]

Makes a commit whose files are those of TARBALL, on top of the branch at the remote (or as its first commit), tags it
BRANCH/VERSION and pushes both. In Unity: Window > Package Manager > + > Install package from git URL, URL.git#upm or
URL.git#upm/VERSION. A tarball whose content the branch already has makes no commit.

  --remote URL   the repository; its credentials are git's
  --branch NAME  the branch (upm)
  --dry-run      everything but the push`;

function optionsOf(words) {
  const options = { remote: { type: 'string' }, branch: { type: 'string', default: 'upm' }, 'dry-run': { type: 'boolean', default: false } };
  const { values, positionals } = parsed(words, options, { allowPositionals: true });
  if (positionals.length !== 1 || values.remote === undefined) throw new CommandError(`expected one tarball and --remote\n\n${help}`, 2);
  return { ...values, tarball: path.resolve(callerFolder(), positionals[0]) };
}

/** The author of the commit: the one that git is configured with, else the workflow's own. */
const identity = ['-c', `user.name=${process.env.GIT_AUTHOR_NAME ?? 'HaptoFlow release'}`, '-c', `user.email=${process.env.GIT_AUTHOR_EMAIL ?? 'release@users.noreply.github.com'}`];

async function publish({ tarball, remote, branch, 'dry-run': dryRun }, folder) {
  const git = (...args) => runOrFail('git', ['-C', folder, ...identity, ...args], { quiet: true });
  await git('init', '--quiet', '--initial-branch', branch);
  const { exitCode, output } = await run('git', ['ls-remote', '--exit-code', remote, `refs/heads/${branch}`], { quiet: true });
  // git ends with 2 where the repository answers and has no such branch.
  if (exitCode !== 0 && exitCode !== 2) throw new CommandError(`${remote}: cannot be read\n${output.trim()}`);
  if (exitCode === 0) {
    await git('fetch', '--quiet', '--depth', '1', remote, `refs/heads/${branch}`);
    await git('reset', '--quiet', '--soft', 'FETCH_HEAD');
  }
  const files = await readTarball(tarball);
  for (const file of files.names) {
    mkdirSync(path.dirname(path.join(folder, file)), { recursive: true });
    writeFileSync(path.join(folder, file), files.bytes(file));
  }
  const { name, version } = JSON.parse(readFileSync(path.join(folder, 'package.json'), 'utf8'));
  // A file that a person's own ignore rules name belongs in, too; line ends stay as they are in the tarball.
  await git('-c', 'core.autocrlf=false', 'add', '--all', '--force');
  const isSame = exitCode === 0 && (await run('git', ['-C', folder, 'diff', '--cached', '--quiet'], { quiet: true })).exitCode === 0;
  if (!isSame) await git('commit', '--quiet', '--message', `${name} ${version}`);
  await git('tag', '--force', `${branch}/${version}`);
  if (!dryRun) await git('push', '--quiet', remote, `HEAD:refs/heads/${branch}`, `refs/tags/${branch}/${version}`);
  console.log(`upm_branch: ${branch} ${isSame ? 'already has' : dryRun ? 'would get' : 'has'} ${name} ${version} (${files.names.length} files)`);
}

await runMain('upm_branch', async (words) => {
  const options = optionsOf(words);
  if (!existsSync(options.tarball)) throw new CommandError(`${options.tarball}: is not there; \`npm run pack\` makes it in ${inRepository('out')}`, 2);
  const folder = mkdtempSync(path.join(os.tmpdir(), 'haptoflow-upm-'));
  try {
    await publish(options, folder);
  } finally {
    rmSync(folder, { recursive: true, force: true });
  }
}, { help });
