import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { runOrFail } from '../lib/process.mjs';
import { commandLinePath, inRepository } from '../lib/repository.mjs';
import { slug } from './labels.mjs';
import { readContacts } from './stroke_path.mjs';

const samples = inRepository('Samples~', 'HeadlessScenes');

export const tracedLabels = ['wood', 'metal mesh', 'corduroy', 'sandpaper', 'glass', 'rubber', 'jute', 'stone'];

export const tapsName = 'taps and rims';

/** The renders of the demo: the crossing scene, the traced plate once for each label, and the taps with all effects. */
export function plannedRenders() {
  const crossing = { name: 'crossing', scene: readScene('crossing'), stroke: path.join(samples, 'crossing.stroke.csv') };
  const plate = readScene('tracing');
  const traced = tracedLabels.map((label) => ({
    name: label,
    scene: withMaterial(plate, label),
    stroke: path.join(samples, 'tracing.stroke.csv'),
  }));
  const taps = {
    name: tapsName, scene: readScene('taps'), stroke: path.join(samples, 'taps.stroke.csv'), effects: 'texture,impact,edge',
  };
  return [crossing, ...traced, taps];
}

/** A copy of the scene in which every surface has the given label. */
export const withMaterial = (scene, label) => ({
  ...scene,
  surfaces: scene.surfaces.map((surface) => ({ ...surface, material: label })),
});

const readScene = (name) => JSON.parse(readFileSync(path.join(samples, `${name}.scene.json`), 'utf8'));

/**
 * Renders one stroke with the command line and writes its files to `folder`.
 * @returns {Promise<{name, scene, report, wavPath, contacts}>}
 */
export async function render({ name, scene, stroke, effects }, folder) {
  mkdirSync(path.join(folder, 'scenes'), { recursive: true });
  const file = slug(name);
  const scenePath = path.join(folder, 'scenes', `${file}.scene.json`);
  const wavPath = path.join(folder, `${file}.wav`);
  const reportPath = path.join(folder, `${file}.report.json`);
  writeFileSync(scenePath, `${JSON.stringify(scene, null, 2)}\n`);
  const program = commandLinePath();
  const asked = effects ? ['--effects', effects] : [];
  await runOrFail(program, ['render', scenePath, '--stroke', stroke, '-o', wavPath, '--report', reportPath, '--seed', '1', ...asked], { quiet: true });
  const contactCsv = await runOrFail(program, ['contact', scenePath, '--stroke', stroke], { quiet: true });
  const report = { ...JSON.parse(readFileSync(reportPath, 'utf8')), wav: path.basename(wavPath) };
  return { name, scene, report, wavPath, contacts: readContacts(contactCsv, readFileSync(stroke, 'utf8'), scene) };
}
