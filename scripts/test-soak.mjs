// test:soak: the long forms of the live engine's proofs: ten minutes on each label, a million watched callbacks
import { judgeJunit, results } from './lib/judge_junit.mjs';
import { buildNative, presetFolder } from './lib/native_build.mjs';
import { runMain } from './lib/process.mjs';
import { inRepository } from './lib/repository.mjs';
import { setUp } from './lib/setup.mjs';
import { addCounts, closingLine, noCounts } from './lib/test_counts.mjs';

const proofs = [
  { program: 'realtime', filter: '*', env: { HAPTOFLOW_TEST_CALLBACKS: '1000000' }, about: 'a million callbacks, watched' },
  { program: 'capi', filter: '*ClosedLoopTest*', env: { HAPTOFLOW_TEST_LOOP_SECONDS: '600' }, about: 'ten minutes on each label' },
  { program: 'capi', filter: '*ApiStormTest*', env: { HAPTOFLOW_TEST_STORM_CALLS: '100000' }, about: '100,000 random calls a thread' },
  { program: 'engine', filter: 'LongRunTest*', env: { HAPTOFLOW_TEST_SOUNDING_SECONDS: '21600' }, about: 'a day of waveform' },
];

await runMain('test:soak', async () => {
  await setUp(['build', 'test']);
  await buildNative({ tests: true });
  let counts = noCounts;
  for (const [index, { program, filter, env, about }] of proofs.entries()) {
    console.log(`test:soak: ${about}`);
    const file = `soak-${index}.xml`;
    const executable = inRepository(presetFolder('release'), 'Tests', 'Native', program, `${program}_tests`);
    const args = [`--gtest_filter=${filter}`, `--gtest_output=xml:${results(file)}`];
    counts = addCounts(counts, await judgeJunit(file, executable, args, { env }));
  }
  console.log(`\n${closingLine(counts)}`);
  return counts.failed > 0 ? 1 : 0;
}, { takesWords: false });
