// Checks that a release's tag is the version that every manifest states; --help
import { readFileSync } from 'node:fs';
import { CommandError, inRepository, runMain } from '../lib/process.mjs';

const help = `usage: node scripts/release/check_tag.mjs TAG

Ends with 1 unless TAG is "v" and the version of package.json, the Unity package has the same version, and CHANGELOG.md
has a section for it.`;

const versionIn = (...parts) => JSON.parse(readFileSync(inRepository(...parts, 'package.json'), 'utf8')).version;

await runMain('check_tag', async ([tag, ...others]) => {
  if (tag === undefined || others.length > 0) throw new CommandError(`expected one tag\n\n${help}`, 2);
  const version = versionIn();
  const ofPackage = versionIn('Packages', 'com.haptoflow.runtime');
  if (tag !== `v${version}`) throw new CommandError(`the tag is ${tag}, and package.json says ${version}: tag the commit v${version}, or raise the version`);
  if (ofPackage !== version) throw new CommandError(`Packages/com.haptoflow.runtime/package.json says ${ofPackage}, and package.json ${version}: make them equal`);
  const hasSection = new RegExp(`^## .*\\b${version.replaceAll('.', '\\.')}\\b`, 'm').test(readFileSync(inRepository('CHANGELOG.md'), 'utf8'));
  if (!hasSection) throw new CommandError(`CHANGELOG.md: has no section "## ${version}"; write what changed`);
  console.log(`check_tag: ${tag}`);
}, { help });
