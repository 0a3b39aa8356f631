// project: says whether Unity can open and play this folder, without Unity: packages, .meta files, library, a stroke
import { existsSync, readFileSync, readdirSync, statSync } from 'node:fs';
import path from 'node:path';
import { CommandError, runMain } from './lib/process.mjs';
import { inRepository, repositoryRoot } from './lib/repository.mjs';
import { dependencyName } from './pack/dependency.mjs';
import { packageName } from './pack/layout.mjs';
import { commandFor, platforms, pluginsFolder } from './pack/natives.mjs';
import { PackageFiles } from './pack/package_files.mjs';
import { checkGuids, checkMetasAreThere, checkMetasAreWanted } from './pack/rules/metas.mjs';
import { resolvePackages } from './project/packages.mjs';

const help = `usage: npm run project [-- --help]

Says whether this folder can be opened and played as a Unity project, without Unity: it resolves the packages of
Packages/manifest.json, looks for the .meta of every file, loads this machine's native library and the model, and plays a
stroke over the model's first label, two seconds long. It needs Node and \`npm ci\`, no compiler and nothing else.`;

/** ONNX Runtime for the editors' machines, by process.platform and process.arch; "id" is that of the native library. */
const editors = /** @type {Record<string, {id: string, runtime: string}>} */ ({
  'linux-x64': { id: 'linux-x64', runtime: 'Linux/x64/libonnxruntime.so' },
  'win32-x64': { id: 'windows-x64', runtime: 'Windows/x64/onnxruntime.dll' },
  'darwin-arm64': { id: 'macos', runtime: 'macOS/arm64/libonnxruntime.dylib' },
});

const megabytes = (/** @type {string} */ file) => `${(statSync(file).size / 1e6).toFixed(1)} MB`;
const says = (/** @type {string} */ line) => console.log(`project: ${line}`);

/** The files below a folder as Unity sees them, under the folder's name in the project; of the contents the .meta files alone are read. */
function filesOf(/** @type {string} */ folder, /** @type {string} */ mount) {
  const contents = /** @type {[string, Buffer | string][]} */ ([]);
  for (const entry of readdirSync(folder, { withFileTypes: true })) {
    const [file, name] = [path.join(folder, entry.name), `${mount}/${entry.name}`];
    if (entry.isDirectory()) contents.push(...filesOf(file, name));
    else contents.push([name, name.endsWith('.meta') ? readFileSync(file) : '']);
  }
  return contents;
}

function checkMetas(/** @type {{name: string, folder: string, place: string}[]} */ packages) {
  const roots = [{ folder: inRepository('Assets'), mount: 'Assets' }, ...packages.map(({ name, folder }) => ({ folder, mount: `Packages/${name}` }))];
  const files = new PackageFiles(new Map(roots.flatMap(({ folder, mount }) => filesOf(folder, mount))));
  // Unity gives the roots themselves no .meta.
  const isRoot = (/** @type {string} */ complaint) => ['Packages', ...roots.map(({ mount }) => mount)].some((root) => complaint.startsWith(`${root}:`));
  const complaints = [checkMetasAreThere, checkMetasAreWanted, checkGuids].flatMap((rule) => rule(files)).filter((complaint) => !isRoot(complaint));
  if (complaints.length > 0) throw new CommandError(complaints.join('\n'));
  return files.names.filter((name) => name.endsWith('.meta')).length;
}

await runMain('project', async () => {
  const packages = resolvePackages(repositoryRoot);
  const local = /** @type {{name: string, version: string, folder: string, place: string}[]} */ (packages.filter(({ folder }) => folder !== null));
  says(`packages: ${local.map(({ name, version }) => `${name} ${version}`).join(', ')}; ${packages.length - local.length} more from Unity`);
  says(`.meta files: ${checkMetas(local)}, each with its file and a GUID of its own`);

  const machine = `${process.platform}-${process.arch}`;
  const editor = editors[machine];
  if (!editor) throw new CommandError(`${machine}: Unity has no editor with ONNX Runtime for it; expected one of ${Object.keys(editors).join(', ')}`);
  const platform = platforms.find(({ id }) => id === editor.id);
  const folderOf = (/** @type {string} */ name) => local.find((each) => each.name === name)?.folder ?? '';
  const library = path.join(folderOf(packageName), pluginsFolder, platform.place);
  if (!existsSync(library)) throw new CommandError(`${library}: is not in git; ${commandFor(platform)} adds it`);
  const runtime = path.join(folderOf(dependencyName), 'Plugins', editor.runtime);
  const model = path.join(folderOf(packageName), 'Runtime', 'Models', 'default.haptoflow');
  says(`library: ${path.relative(repositoryRoot, library)}, ${megabytes(library)}; model ${megabytes(model)}`);

  // Imported here: npm ci brings what it needs, and without that the lines above say so.
  const { playStroke } = await import('./project/play_stroke.mjs');
  const played = await playStroke({ library, runtime, model });
  if (played.disagreeing.length > 0) {
    throw new CommandError(`${library}: is of another interface than haptoflow.h (${played.disagreeing.join(', ')}): \`npm run natives\` builds it anew`);
  }
  if (played.inferences === 0 || !(played.levelMps2 > 0.01)) {
    throw new CommandError(`a stroke over ${played.label} was silent: ${played.levelMps2} m/s² RMS, ${played.inferences} segments by the network`);
  }
  if (played.peak > 1 || played.restPeak > 0) throw new CommandError(`a stroke over ${played.label} reached ${played.peak} of full scale and ${played.restPeak} at rest`);
  says(`played a stroke over ${played.label}: ${played.levelMps2.toFixed(2)} m/s² RMS, ${played.inferences} segments by the network, silent after it`);
  says(`open this folder in Unity's Hub, then Assets/Desk, Play`);
  return 0;
}, { help, takesWords: false });
