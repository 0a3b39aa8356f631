// test:soak: runs the live engine for long: ten minutes on each label, a million observed callbacks (--publish)
import { readFileSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import { addCounts, closingLine, judgeJunit, noCounts, results } from './lib/test_results.mjs';
import { sha256Of, shippedModel, soakTable, withMeasuredPart } from './lib/measured_part.mjs';
import { buildNative, presetFolder } from './lib/native_build.mjs';
import { inRepository, parsed, runMain } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';

const proofs = [
  { program: 'realtime', filter: '*', env: { HAPTOFLOW_TEST_CALLBACKS: '1000000' }, about: 'a million callbacks, watched' },
  { program: 'capi', filter: '*ClosedLoopTest*', env: { HAPTOFLOW_TEST_LOOP_SECONDS: '600' }, about: 'ten minutes on each label' },
  { program: 'capi', filter: '*ApiStormTest*', env: { HAPTOFLOW_TEST_STORM_CALLS: '100000' }, about: '100,000 random calls a thread' },
  { program: 'engine', filter: 'LongRunTest*', env: { HAPTOFLOW_TEST_SOUNDING_SECONDS: '21600' }, about: 'a day of waveform' },
];

const page = inRepository('Documentation~', 'not-proven.md');
const resultOf = (index) => `soak-${index}.xml`;

/** Writes the figures of this run, and the model that they belong to, into the stability page. */
function publish() {
  const ran = proofs.map(({ about }, index) => ({ about, xml: readFileSync(results(resultOf(index)), 'utf8') }));
  const machine = `${os.cpus()[0]?.model.trim() ?? 'unknown processor'}, ${os.cpus().length} cores, ${os.type()}`;
  const table = soakTable(ran, { date: new Date().toISOString().slice(0, 10), machine, modelSha256: sha256Of(shippedModel) });
  writeFileSync(page, withMeasuredPart(readFileSync(page, 'utf8'), 'npm run test:soak -- --publish', table));
  console.log(`test:soak: ${page}`);
}

await runMain('test:soak', async (words) => {
  const { publish: isPublished } = parsed(words, { publish: { type: 'boolean', default: false } }).values;
  await setUp(['build', 'test']);
  await buildNative({ tests: true });
  let counts = noCounts;
  for (const [index, { program, filter, env, about }] of proofs.entries()) {
    console.log(`test:soak: ${about}`);
    const file = resultOf(index);
    const executable = inRepository(presetFolder('release'), 'Tests', 'Native', program, `${program}_tests`);
    const args = [`--gtest_filter=${filter}`, `--gtest_output=xml:${results(file)}`];
    counts = addCounts(counts, await judgeJunit(file, executable, args, { env }));
  }
  console.log(`\n${closingLine(counts)}`);
  if (isPublished && counts.failed === 0) publish();
  return counts.failed > 0 ? 1 : 0;
});
