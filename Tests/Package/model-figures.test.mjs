// Published figures and pictures belong to the shipped model. Mend a failure by measuring or drawing again, not by editing.
import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import path from 'node:path';
import test from 'node:test';
import { modelLine, sha256Of, shippedModel } from '../../scripts/lib/measured_part.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { modelOfPage } from './support/model_of_page.mjs';

const shipped = sha256Of(shippedModel);
/** What takes hours, still measured with the model before, as its pages say; and scenes, whose look does not depend on it. */
const before = '5ebff5cf2c2ae70618a48d0527bc0df47dd47c7331535699c7bc40feeb7b624f';
const ofTheModelBefore = [
  'Documentation~/images/effect-exposure-guard.png',
  'Documentation~/images/few-shot.png',
  'Documentation~/images/headset.png',
  'Documentation~/images/output-controller-waveform.png',
  'Samples~/StylusTracing/StylusTracing.png',
  'Samples~/Workshop/Workshop.png',
  'Training/haptoflow_paper/results/few-shot.json',
  'Training/haptoflow_paper/results/few-shot.md',
];
const modelOf = (file) => (ofTheModelBefore.includes(file) ? before : shipped);
const sha = (digit) => digit.repeat(64);

/** The model that each kind of file names: a line of a page, a key of results, a text chunk of a PNG; null where it names none. */
const modelIn = {
  '.md': (bytes) => modelOfPage(bytes.toString('utf8')),
  '.json': (bytes) => JSON.parse(bytes.toString('utf8')).model_sha256,
  '.png': (bytes) => bytes.toString('latin1').match(/tEXtModel-SHA-256\0([0-9a-f]{64})/)?.[1] ?? null,
};

/** Pages with measured figures and their results, and the command that measures them. */
const measured = {
  'Documentation~/accuracy-and-time.md': 'npm run evaluate, and the tables by hand',
  'Documentation~/not-proven.md': 'npm run test:soak -- --publish',
  'Training/results/benchmarks.md': 'npm run bench -- --publish, and by hand the figures of Documentation~/live-engine.md',
  'Training/results/delay-budget.md': 'haptoflow-training study budget --page',
  'Training/results/device-loudness.md': '/usr/bin/python3 scripts/pack/device_levels.py',
  'Training/results/effects.md': '/usr/bin/python3 scripts/pack/pictures.py',
  'Training/haptoflow_paper/results/accuracy-and-time.md': 'npm run evaluate',
  'Training/haptoflow_paper/results/few-shot.md': 'haptoflow-paper few-shot --page',
  'Training/haptoflow_paper/results/place.md': 'haptoflow-paper place --page',
  'Training/results/README.md': 'npm run evaluate, haptoflow-benchmark discriminate, and the words by hand',
  'Training/haptoflow_paper/results/accuracy-time.json': 'npm run evaluate',
  'Training/haptoflow_paper/results/few-shot.json': 'haptoflow-paper few-shot',
  'Training/results/label-discrimination.json': 'haptoflow-benchmark discriminate',
};

/**
 * Of models that are not in the repository, a file of the published sizes with random weights and a distilled one; what a model and
 * the one before it sounded like; and what effects do, which hardly depends on the model: scripts/pack/pictures.py of ca588762 drew it.
 */
const ofOtherModels = ['before-after.png', 'published-costs.png', 'distilled-spectra.png', 'effect-impact.png', 'effect-edge.png', 'effect-delay.png', 'features-of-the-wave.png'];
const pictures = ['Documentation~/images', 'Samples~/StylusTracing', 'Samples~/TextureGallery', 'Samples~/Workshop', 'Training/results', 'Training/haptoflow_paper/results']
  .flatMap((folder) => readdirSync(inRepository(...folder.split('/'))).map((name) => `${folder}/${name}`))
  .filter((file) => file.endsWith('.png') && !ofOtherModels.includes(path.basename(file)));

for (const file of pictures) measured[file] = 'as Documentation~/accuracy-and-time.md says';

for (const [file, command] of Object.entries(measured)) {
  test(`${file} was made with the shipped model`, () => {
    assert.equal(modelIn[path.extname(file)](readFileSync(inRepository(file))), modelOf(file), `make it again: ${command}`);
  });
}

test('a page names one model in one line, none without such a line, and two are an error', () => {
  assert.equal(modelOfPage(`# Page\n\n${modelLine(sha('c'))}\n`), sha('c'));
  assert.equal(modelOfPage('Model: some other\n'), null);
  assert.throws(() => modelOfPage(`${modelLine(sha('c'))}\n\n${modelLine(sha('d'))}\n`), RangeError);
});
