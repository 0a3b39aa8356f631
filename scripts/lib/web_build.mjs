import { copyFileSync, cpSync, existsSync, mkdirSync, readFileSync, readdirSync, rmSync, statSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { shippedModel } from './measured_part.mjs';
import { launchers } from './native_build.mjs';
import { CommandError, inRepository, runOrFail, succeeds } from './process.mjs';
import { makeTarball } from '../pack/package_files.mjs';

/** Where the built engine goes: all that a page needs of it, in one folder. */
export const engineFolder = () => inRepository('Web', 'dist', 'engine');

const runtimeFiles = ['ort-wasm-simd-threaded.mjs', 'ort-wasm-simd-threaded.wasm'];
const runtimeFolder = () => inRepository('node_modules', 'onnxruntime-web', 'dist');

/** Debian's Emscripten finds its own JavaScript libraries by this variable only. */
function emscriptenEnvironment() {
  return existsSync('/usr/share/nodejs/acorn') ? { NODE_PATH: process.env.NODE_PATH ?? '/usr/share/nodejs' } : {};
}

/** Compiles engine.wasm with the Emscripten on PATH: Debian's 3.1.6, or a newer one. */
export async function compileEngine() {
  if (!succeeds('emcc', ['--version'])) {
    throw new CommandError('there is no Emscripten on PATH: install the package emscripten (Debian), or https://emscripten.org/docs/getting_started', 2);
  }
  const env = { ...emscriptenEnvironment(), ...launchers() };
  if (!existsSync(inRepository('build', 'web', 'build.ninja'))) {
    console.log('build: configuring build/web');
    await runOrFail('emcmake', ['cmake', '--preset', 'web'], { env, quiet: true });
  }
  console.log('build: engine.wasm in build/web');
  await runOrFail('cmake', ['--build', inRepository('build', 'web'), '-j', String(os.cpus().length), '--target', 'haptoflow_web'], { env, quiet: !process.stdout.isTTY });
}

/** Puts the engine together: scripts, engine.wasm, ONNX Runtime, the shipped model. */
export function stageEngine(folder = engineFolder()) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  const scripts = inRepository('Web', 'engine', 'js');
  for (const name of readdirSync(scripts)) copyFileSync(path.join(scripts, name), path.join(folder, name));
  copyFileSync(inRepository('build', 'web', 'engine.wasm'), path.join(folder, 'engine.wasm'));
  for (const name of runtimeFiles) copyFileSync(path.join(runtimeFolder(), name), path.join(folder, name));
  cpSync(shippedModel, path.join(folder, 'model.haptoflow'));
}

/** The version of ONNX Runtime that the scripts were written for, and the installed one, must be the same. */
export function checkRuntimeVersion() {
  const { version } = JSON.parse(readFileSync(inRepository('node_modules', 'onnxruntime-web', 'package.json'), 'utf8'));
  const script = readFileSync(inRepository('Web', 'engine', 'js', 'runtime.mjs'), 'utf8');
  const expected = script.match(/onnxRuntimeVersion = '([^']+)'/)?.[1];
  if (version !== expected) throw new CommandError(`onnxruntime-web is ${version}, and Web/engine/js/runtime.mjs is written for ${expected}: compare its inner functions, then change the number there`);
}

/** All of it. */
export async function buildEngine() {
  checkRuntimeVersion();
  await compileEngine();
  stageEngine();
  const bytes = readdirSync(engineFolder()).reduce((sum, name) => sum + statSync(path.join(engineFolder(), name)).size, 0);
  console.log(`build: Web/dist/engine (${(bytes / 2 ** 20).toFixed(1)} MiB)`);
}

/** Where the page goes: static files that work under any path, the engine in `engine` beside index.html. */
export const pageFolder = () => inRepository('Web', 'dist', 'page');

/** What is loaded only in a headset. */
const drawing = ['three.module.js', 'three.core.js'];

const isForThePage = (/** @type {string} */ file) => !file.endsWith('.md');

/** Puts the page together from Web/page and the built engine. @param {string} [folder] */
export function stagePage(folder = pageFolder()) {
  rmSync(folder, { recursive: true, force: true });
  mkdirSync(folder, { recursive: true });
  cpSync(inRepository('Web', 'page'), folder, { recursive: true, filter: isForThePage });
  for (const name of drawing) cpSync(inRepository('node_modules', 'three', 'build', name), path.join(folder, 'three', name));
  const engine = path.join(folder, 'engine');
  mkdirSync(engine);
  for (const name of readdirSync(engineFolder()).filter((file) => !file.endsWith('.d.ts'))) cpSync(path.join(engineFolder(), name), path.join(engine, name));
}

/** Whether the engine was built; its scripts are copied at every call of `stageEngine`. */
export const hasBuiltEngine = () => existsSync(path.join(engineFolder(), 'engine.wasm'));

const versionOf = (/** @type {string[]} */ ...names) => JSON.parse(readFileSync(inRepository(...names), 'utf8')).version;

/** Packs the built engine as the npm package haptoflow-web, a .tgz in the folder `destination`. */
export async function packEngine(destination = inRepository('out')) {
  const [own, root] = [versionOf('Web', 'engine', 'package.json'), versionOf('package.json')];
  if (own !== root) throw new CommandError(`Web/engine/package.json has version ${own}, package.json ${root}: make them the same`);
  const folder = inRepository('out', 'haptoflow-web');
  stageEngine(folder);
  for (const name of ['package.json', 'README.md', 'NOTICES.md']) copyFileSync(inRepository('Web', 'engine', name), path.join(folder, name));
  copyFileSync(inRepository('LICENSE'), path.join(folder, 'LICENSE'));
  return makeTarball(folder, destination);
}
