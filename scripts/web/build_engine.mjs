import { copyFileSync, cpSync, existsSync, mkdirSync, readdirSync, readFileSync, rmSync, statSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';
import { shippedModel } from '../lib/measured_part.mjs';
import { launchers } from '../lib/native_build.mjs';
import { CommandError, inRepository, runOrFail, succeeds } from '../lib/process.mjs';

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
