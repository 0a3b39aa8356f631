// Makes a Unity project that holds the packed package and runs its tests; --help
import { copyFileSync, mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { parseArgs } from 'node:util';
import { CommandError, runMain } from '../lib/process.mjs';
import { inRepository, callerFolder } from '../lib/repository.mjs';
import { dependencyName } from '../pack/dependency.mjs';
import { packageName } from '../pack/layout.mjs';
import { tarballOf } from './tarballs.mjs';

const help = `usage: node scripts/release/unity_project.mjs FOLDER --unity VERSION [--tarballs out]

Makes FOLDER a project of Unity VERSION (for example 2022.3.62f1) that installs the two tarballs of \`npm run pack\` and
lists the package as testable, so that Unity's Test Runner runs its edit-mode and play-mode tests.

  --tarballs FOLDER  where the tarballs lie (out)`;

function optionsOf(words) {
  const options = { unity: { type: 'string' }, tarballs: { type: 'string', default: inRepository('out') } };
  try {
    const { values, positionals } = parseArgs({ args: words, options, allowPositionals: true });
    if (positionals.length !== 1 || !/^\d+\.\d+\.\d+\w+$/.test(values.unity ?? '')) throw new CommandError(`expected a folder and --unity VERSION\n\n${help}`, 2);
    const [folder, tarballs] = [positionals[0], values.tarballs].map((word) => path.resolve(callerFolder(), word));
    return { folder, tarballs, unity: values.unity };
  } catch (error) {
    throw error instanceof CommandError ? error : new CommandError(error.message, 2);
  }
}

await runMain('unity_project', async (words) => {
  const { folder, tarballs, unity } = optionsOf(words);
  const names = [packageName, dependencyName];
  const files = names.map((name) => tarballOf(name, tarballs));
  rmSync(path.join(folder, 'Packages'), { recursive: true, force: true });
  for (const part of ['Assets', 'Packages', 'ProjectSettings']) mkdirSync(path.join(folder, part), { recursive: true });
  files.forEach((file) => copyFileSync(path.join(tarballs, file), path.join(folder, 'Packages', file)));
  const { dependencies } = JSON.parse(readFileSync(inRepository('Packages', packageName, 'package.json'), 'utf8'));
  const others = Object.entries(dependencies).filter(([name]) => name !== dependencyName);
  const manifest = {
    dependencies: {
      ...Object.fromEntries(names.map((name, index) => [name, `file:${files[index]}`])),
      ...Object.fromEntries(others),
      'com.unity.test-framework': '1.1.33',
      'com.unity.modules.ai': '1.0.0',
      'com.unity.modules.animation': '1.0.0',
      'com.unity.modules.audio': '1.0.0',
      'com.unity.modules.imgui': '1.0.0',
      'com.unity.modules.physics': '1.0.0',
      'com.unity.modules.terrain': '1.0.0',
      'com.unity.modules.terrainphysics': '1.0.0',
      'com.unity.modules.ui': '1.0.0',
      'com.unity.modules.uielements': '1.0.0',
      'com.unity.modules.xr': '1.0.0',
    },
    testables: [packageName],
  };
  writeFileSync(path.join(folder, 'Packages', 'manifest.json'), `${JSON.stringify(manifest, null, 2)}\n`);
  writeFileSync(path.join(folder, 'ProjectSettings', 'ProjectVersion.txt'), `m_EditorVersion: ${unity}\n`);
  console.log(`unity_project: ${folder}: Unity ${unity} with ${files.join(' and ')}`);
}, { help });
