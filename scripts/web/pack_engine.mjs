import { copyFileSync, readFileSync } from 'node:fs';
import path from 'node:path';
import { CommandError, inRepository } from '../lib/process.mjs';
import { makeTarball } from '../pack/tarball.mjs';
import { stageEngine } from './build_engine.mjs';

const versionOf = (/** @type {string[]} */ ...names) => JSON.parse(readFileSync(inRepository(...names), 'utf8')).version;

/** Makes the npm package haptoflow-web from the built engine. */
export async function packEngine(destination = inRepository('out')) {
  const [own, root] = [versionOf('Web', 'engine', 'package.json'), versionOf('package.json')];
  if (own !== root) throw new CommandError(`Web/engine/package.json has version ${own}, package.json ${root}: make them the same`);
  const folder = inRepository('out', 'haptoflow-web');
  stageEngine(folder);
  for (const name of ['package.json', 'README.md', 'NOTICES.md']) copyFileSync(inRepository('Web', 'engine', name), path.join(folder, name));
  copyFileSync(inRepository('LICENSE'), path.join(folder, 'LICENSE'));
  return makeTarball(folder, destination);
}
