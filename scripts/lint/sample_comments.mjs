// Prints comments and docstrings of this repository, drawn at random: node scripts/lint/sample_comments.mjs --help
import { readFileSync } from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { CommandError, runMain } from '../lib/process.mjs';
import { inRepository, repositoryRoot, callerFolder } from '../lib/repository.mjs';
import { commentBlocks, draw, hasComments } from './comment_blocks.mjs';
import { repositoryFiles } from './files.mjs';

const help = `usage: node scripts/lint/sample_comments.mjs [--count 50] [--seed N] [PATH...]

Prints COUNT comments and docstrings, whole blocks with file and line, drawn at random from every C++, C#, Python and
JavaScript file that git tracks or would track. Read them to judge whether the sources read plainly.

  --count COUNT  how many blocks (50)
  --seed N       a whole number; the same seed draws the same blocks from the same sources. Printed when not given
  PATH           draws from these files and folders only`;

function wholeNumber(name, text, least) {
  if (!/^\d+$/.test(text) || Number(text) < least || Number(text) > 0xffffffff) {
    throw new CommandError(`--${name} ${text}: expected a whole number from ${least} to ${0xffffffff}`, 2);
  }
  return Number(text);
}

function optionsOf(words) {
  const options = { count: { type: 'string', default: '50' }, seed: { type: 'string' } };
  try {
    const { values, positionals } = parseArgs({ args: words, options, allowPositionals: true });
    const seed = values.seed === undefined ? Math.floor(Math.random() * 1e6) : wholeNumber('seed', values.seed, 0);
    return { count: wholeNumber('count', values.count, 1), seed, paths: positionals };
  } catch (error) {
    throw error instanceof CommandError ? error : new CommandError(error.message, 2);
  }
}

/** The files at or below `paths`, which are relative to where the command was typed; all files where there are none. */
function filesBelow(files, paths) {
  const wanted = paths.map((name) => path.relative(repositoryRoot, path.resolve(callerFolder(), name)).split(path.sep).join('/'));
  const isBelow = (name, folder) => folder === '' || name === folder || name.startsWith(`${folder}/`);
  const unknown = wanted.findIndex((folder) => !files.some((name) => isBelow(name, folder)));
  if (unknown !== -1) throw new CommandError(`${paths[unknown]}: no C++, C#, Python or JavaScript file of this repository is there`, 2);
  return wanted.length === 0 ? files : files.filter((name) => wanted.some((folder) => isBelow(name, folder)));
}

await runMain('sample_comments', async (words) => {
  const { count, seed, paths } = optionsOf(words);
  const files = filesBelow((await repositoryFiles()).filter(hasComments).sort(), paths);
  const blocks = files.flatMap((name) => commentBlocks(name, readFileSync(inRepository(name), 'utf8')).map((block) => ({ name, ...block })));
  for (const { name, line, text } of draw(blocks, count, seed)) console.log(`${name}:${line}\n${text}\n`);
  console.log(`${Math.min(count, blocks.length)} of ${blocks.length} comments in ${files.length} files, --seed ${seed}`);
}, { help });
