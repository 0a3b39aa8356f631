// Checks that a release's tag is the version that every manifest states; --help
import { readFileSync } from 'node:fs';
import { CommandError, inRepository, runMain } from '../lib/process.mjs';
import { packageName, studiesName } from '../pack/layout.mjs';

const help = `usage: node scripts/release/check_tag.mjs TAG

Ends with 1 unless TAG is "v" and the version of package.json, the Unity packages have the same version, and CHANGELOG.md
has a section for it.`;

await runMain('check_tag', async ([tag, ...others]) => {
  if (tag === undefined || others.length > 0) throw new CommandError(`expected one tag\n\n${help}`, 2);
  const { version } = JSON.parse(readFileSync(inRepository('package.json'), 'utf8'));
  if (tag !== `v${version}`) throw new CommandError(`the tag is ${tag}, and package.json says ${version}: tag the commit v${version}, or raise the version`);
  for (const name of [packageName, studiesName]) {
    const { version: stated, dependencies } = JSON.parse(readFileSync(inRepository('Packages', name, 'package.json'), 'utf8'));
    const wrong = [stated, dependencies[packageName] ?? version].find((each) => each !== version);
    if (wrong !== undefined) throw new CommandError(`Packages/${name}/package.json says ${wrong}, and package.json ${version}: make them equal`);
  }
  const hasSection = new RegExp(`^## .*\\b${version.replaceAll('.', '\\.')}\\b`, 'm').test(readFileSync(inRepository('CHANGELOG.md'), 'utf8'));
  if (!hasSection) throw new CommandError(`CHANGELOG.md: has no section "## ${version}"; write what changed`);
  console.log(`check_tag: ${tag}`);
}, { help });
