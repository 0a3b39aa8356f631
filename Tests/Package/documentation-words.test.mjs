import assert from 'node:assert/strict';
import { readFileSync, readdirSync } from 'node:fs';
import test from 'node:test';
import { inRepository } from '../../scripts/lib/process.mjs';

const pages = [
  'README.md', 'Training/results/default/README.md', 'Training/results/default/label-discrimination.md', 'scripts/demo/page.html',
  'Samples~/StylusTracing/README.md', 'Samples~/TextureGallery/README.md', 'Samples~/Workshop/README.md', 'Packages/com.haptoflow.studies/Samples~/LatencyStudy/README.md', 'Packages/com.haptoflow.studies/Samples~/SimilarityStudy/README.md',
  'Samples~/HeadlessScenes/README.md', 'Samples~/DeviceCheck/README.md',
  ...readdirSync(inRepository('Documentation~')).filter((name) => name.endsWith('.md')).map((name) => `Documentation~/${name}`),
];
const read = (page) => readFileSync(inRepository(page), 'utf8');

const words = {
  GFC: /goodness of fit/i,
  LSD: /log-spectral distance/i,
  SPSI: /single-pass spectrogram inversion/i,
  DSTN: /deep spatial-temporal network/i,
  AR: /autoregressive/i,
  RMSE: /root mean square error/i,
};

/** The first line of a page that has a word, with the lines before and after it, since a sentence may span them. */
function firstPlace(text, word) {
  const lines = text.split('\n');
  const at = lines.findIndex((line) => new RegExp(`\\b${word}\\b`).test(line));
  return at < 0 ? null : lines.slice(Math.max(0, at - 1), at + 2).join(' ');
}

for (const [word, meaning] of Object.entries(words)) {
  test(`${word} is explained where it first appears on a page`, () => {
    const unexplained = pages.filter((page) => {
      const place = firstPlace(read(page), word);
      return place !== null && !meaning.test(place);
    });
    assert.deepEqual(unexplained, []);
  });
}

test('a word must be explained where it first appears, not further down', () => {
  const text = 'intro\n\nGFC is high\n\nfar away\n\nGFC, goodness of fit\n';
  assert.doesNotMatch(firstPlace(text, 'GFC'), words.GFC);
  assert.match(firstPlace('its goodness of\nfit (goodness of fit, GFC)\n', 'GFC'), words.GFC);
  assert.equal(firstPlace('ARM and MARGIN', 'AR'), null);
});

test('the paper is cited by title, authors and year: in the README, with the table, and where training is explained', () => {
  for (const page of ['README.md', 'Documentation~/accuracy-and-time.md', 'Documentation~/training.md']) {
    const text = read(page).replace(/\s+/g, ' ');
    assert.match(text, /HaptoFlow: High-Fidelity Real-Time Vibrotactile Generation via Flow Matching for Virtual Reality/, page);
    assert.match(text, /Eguchi\b.*\bHiroi\b.*\bHiraki\b/, page);
    assert.match(text, /\b2026\b/, page);
  }
});

test('no page claims what people feel, since no study has had participants yet', () => {
  const claims = pages.filter((page) => /nobody (feels|notices)|imperceptible|just.noticeable/i.test(read(page)));
  assert.deepEqual(claims, []);
});
