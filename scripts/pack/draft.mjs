// Puts together what a release offers: the tarballs, the demo's page, notes and checksums; --help
import { copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { sha256Of } from '../lib/measured_part.mjs';
import { CommandError, callerFolder, inRepository, parsed, runMain, runOrFail } from '../lib/process.mjs';
import { dependencyName } from './dependency.mjs';
import { packageName, studiesName } from './layout.mjs';
import { platforms, pluginsFolder } from './natives.mjs';
import { readTarball } from './package_files.mjs';

const help = `usage: node scripts/pack/draft.mjs FOLDER [--tarballs out] [--demo FOLDER]

Empties FOLDER and puts there what a release offers: the tarballs of \`npm run pack\`, haptoflow-demo.tgz, SHA256SUMS of
all, and notes.md: how to install, which platforms have a library, and the version's section of CHANGELOG.md.

  --tarballs FOLDER  where the tarballs lie (out)
  --demo FOLDER      the demo's page, as \`npm run demo\` makes it (out/demo)`;

function optionsOf(words) {
  const options = { tarballs: { type: 'string', default: inRepository('out') }, demo: { type: 'string', default: inRepository('out', 'demo') } };
  const { values, positionals } = parsed(words, options, { allowPositionals: true });
  if (positionals.length !== 1) throw new CommandError(`expected a folder\n\n${help}`, 2);
  const [folder, tarballs, demo] = [positionals[0], values.tarballs, values.demo].map((word) => path.resolve(callerFolder(), word));
  return { folder, tarballs, demo };
}

/** The name of the one tarball of a package in a folder. */
function tarballOf(name, folder) {
  const found = existsSync(folder) ? readdirSync(folder).filter((file) => file.startsWith(`${name}-`) && file.endsWith('.tgz')) : [];
  if (found.length !== 1) throw new CommandError(`${folder}: holds ${found.length} tarballs of ${name}; expected one: \`npm run pack\` makes it`);
  return found[0];
}

/** The text below a version's heading in CHANGELOG.md. */
export function changesOf(changelog, version) {
  const sections = changelog.split(/^(?=## )/m);
  const section = sections.find((text) => new RegExp(`^## \\[?${version.replaceAll('.', '\\.')}\\b`).test(text));
  if (!section) throw new CommandError(`CHANGELOG.md: has no section "## ${version}"; write what changed`);
  return section.slice(section.indexOf('\n')).trim();
}

function notesOf({ runtime, tarball, studies, files, version }) {
  const rows = platforms.map(({ name, place }) => `| ${name} | ${files.has(`${pluginsFolder}/${place}`) ? 'yes' : 'no'} |`);
  return `Download the tarballs. In Unity: Window > Package Manager > + > Install package from tarball... (2022.3: Add package
from tarball...), first \`${runtime}\`, then \`${tarball}\`, for user studies also \`${studies}\`. \`sha256sum --check SHA256SUMS\` compares what was downloaded.
\`haptoflow-demo.tgz\` is a page to look at and listen to.

| platform | library in the package |
|---|---|
${rows.join('\n')}

## Changes

${changesOf(readFileSync(inRepository('CHANGELOG.md'), 'utf8'), version)}
`;
}

if (process.argv[1]?.endsWith('draft.mjs')) {
  await runMain('draft', async (words) => {
    const { folder, tarballs, demo } = optionsOf(words);
    const [runtime, tarball, studies] = [dependencyName, packageName, studiesName].map((name) => tarballOf(name, tarballs));
    const files = await readTarball(path.join(tarballs, tarball));
    const { version } = JSON.parse(files.text('package.json'));
    const notes = notesOf({ runtime, tarball, studies, files, version });
    rmSync(folder, { recursive: true, force: true });
    mkdirSync(folder, { recursive: true });
    for (const name of [runtime, tarball, studies]) copyFileSync(path.join(tarballs, name), path.join(folder, name));
    const unpacked = path.join(folder, 'haptoflow-demo');
    cpSync(demo, unpacked, { recursive: true });
    await runOrFail('tar', ['-czf', `${unpacked}.tgz`, '-C', folder, 'haptoflow-demo']);
    rmSync(unpacked, { recursive: true });
    const sums = readdirSync(folder).sort().map((name) => `${sha256Of(path.join(folder, name))}  ${name}\n`);
    writeFileSync(path.join(folder, 'SHA256SUMS'), sums.join(''));
    writeFileSync(path.join(folder, 'notes.md'), notes);
    console.log(`draft: ${folder}: ${sums.length} archives, SHA256SUMS, notes.md`);
  }, { help });
}
