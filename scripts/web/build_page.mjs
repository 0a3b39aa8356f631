import { cpSync, existsSync, mkdirSync, readdirSync, rmSync } from 'node:fs';
import path from 'node:path';
import { inRepository } from '../lib/process.mjs';
import { engineFolder } from './build_engine.mjs';

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
