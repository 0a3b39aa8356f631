// project: says without Unity whether Unity can open and play this folder: packages, references, library, a stroke
import { existsSync, statSync } from 'node:fs';
import path from 'node:path';
import { CommandError, runMain } from './lib/process.mjs';
import { inRepository, repositoryRoot } from './lib/repository.mjs';
import { dependencyName } from './pack/dependency.mjs';
import { packageName } from './pack/layout.mjs';
import { commandFor, platforms, pluginsFolder } from './pack/natives.mjs';
import { projectFilesOnDisk } from './project/project_files.mjs';
import { rules } from './project/rules.mjs';

const help = `usage: npm run project [-- --help]

Says whether this folder can be opened and played as a Unity project, without Unity: it resolves the packages of
Packages/manifest.json, looks for the .meta of every file and the target of every reference, loads this machine's native
library and the model, and plays a stroke over the model's first label, two seconds long. It needs Node and \`npm ci\`, no
compiler and nothing else.`;

/** ONNX Runtime for the editors' machines, by process.platform and process.arch; "id" is that of the native library. */
const editors = /** @type {Record<string, {id: string, runtime: string}>} */ ({
  'linux-x64': { id: 'linux-x64', runtime: 'Linux/x64/libonnxruntime.so' },
  'win32-x64': { id: 'windows-x64', runtime: 'Windows/x64/onnxruntime.dll' },
  'darwin-arm64': { id: 'macos', runtime: 'macOS/arm64/libonnxruntime.dylib' },
});

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
  const editor = editors[machine];
  if (!editor) throw new CommandError(`${machine}: Unity has no editor with ONNX Runtime for it; expected one of ${Object.keys(editors).join(', ')}`);
  const platform = platforms.find(({ id }) => id === editor.id);
  const inPackage = (/** @type {string[]} */ ...parts) => inRepository('Packages', packageName, ...parts);
  const library = inPackage(pluginsFolder, platform.place);
  if (!existsSync(library)) throw new CommandError(`${library}: is not in git; ${commandFor(platform)} adds it`);
  const runtime = inRepository('node_modules', dependencyName, 'Plugins', editor.runtime);
  const model = inPackage('Runtime', 'Models', 'default.haptoflow');
  says(`library: ${path.relative(repositoryRoot, library)}, ${megabytes(library)}; model ${megabytes(model)}`);

  // Imported here: npm ci brings what it needs, and without that the lines above say so.
  const { playStroke } = await import('./project/play_stroke.mjs');
  const played = await playStroke({ library, runtime, model });
  if (played.inferences === 0 || !(played.levelMps2 > 0.01)) {
    throw new CommandError(`a stroke over ${played.label} was silent: ${played.levelMps2} m/s² RMS, ${played.inferences} segments by the network`);
  }
  if (played.peak > 1 || played.restPeak > 0) throw new CommandError(`a stroke over ${played.label} reached ${played.peak} of full scale and ${played.restPeak} at rest`);
  says(`played a stroke over ${played.label}: ${played.levelMps2.toFixed(2)} m/s² RMS, ${played.inferences} segments by the network, silent after it`);
  says(`open this folder in Unity's Hub, then Assets/Desk, Play`);
  return 0;
}, { help, takesWords: false });
