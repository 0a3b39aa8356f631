// project: says without Unity whether Unity can open and play this folder: packages, references, libraries
import { existsSync, statSync } from 'node:fs';
import path from 'node:path';
import { shippedModel } from './lib/measured_part.mjs';
import { CommandError, repositoryRoot, runMain } from './lib/process.mjs';
import { complaintOfLoading, fileInPackage } from './lib/libraries.mjs';
import { runtimeLibrary } from './pack/dependency.mjs';
import { commandFor, platforms } from './pack/natives.mjs';
import { projectFilesOnDisk, rules } from './pack/rules_of_projects.mjs';

const help = `usage: npm run project [-- --help]

Says whether this folder can be opened and played as a Unity project, without Unity: it resolves the packages of
Packages/manifest.json, looks for the .meta of every file and the target of every reference, and loads this machine's native
library and ONNX Runtime. It needs Node and \`npm ci\`, no compiler and nothing else.`;

/** The package's platform for each machine with a Unity editor, by process.platform and process.arch. */
const editors = /** @type {Record<string, string>} */ ({ 'linux-x64': 'linux-x64', 'win32-x64': 'windows-x64', 'darwin-arm64': 'macos' });

const megabytes = (/** @type {string} */ file) => `${(statSync(file).size / 1e6).toFixed(1)} MB`;
const says = (/** @type {string} */ line) => console.log(`project: ${line}`);

await runMain('project', async () => {
  const files = projectFilesOnDisk();
  // The first rule that complains is enough: without a package, every reference into it is lost too.
  const complaints = Object.values(rules).map((rule) => rule(files)).find((found) => found.length > 0);
  if (complaints) throw new CommandError(complaints.join('\n'));
  const packages = Object.entries(JSON.parse(files.text('Packages/manifest.json')).dependencies);
  const fromUnity = packages.filter(([, version]) => !version.startsWith('file:'));
  says(`${files.names.length} files: packages, .meta files and references are in place; Unity downloads or has ${fromUnity.length} packages`);

  const machine = `${process.platform}-${process.arch}`;
  const platform = platforms.find(({ id }) => id === editors[machine]);
  if (!platform) throw new CommandError(`${machine}: Unity has no editor with ONNX Runtime for it; expected one of ${Object.keys(editors).join(', ')}`);
  const library = fileInPackage(platform);
  if (!existsSync(library)) throw new CommandError(`${library}: is not in git; ${commandFor(platform)} adds it`);
  says(`library: ${path.relative(repositoryRoot, library)}, ${megabytes(library)}; model ${megabytes(shippedModel)}`);

  for (const file of [library, runtimeLibrary(platform.id)]) {
    const complaint = complaintOfLoading(file);
    if (complaint !== null) throw new CommandError(`${file}: does not load here: ${complaint}`);
  }
  says('library and ONNX Runtime load here');
  says(`open this folder in Unity's Hub, then Assets/Desk, Play`);
  return 0;
}, { help, takesWords: false });
