import { distribution } from '../../Web/engine/js/distribution.mjs';

// Writes the results of `npm run bench:web` as Markdown tables.

/** @typedef {{tier: string, hotMs: import('../../Web/engine/js/haptoflow.d.ts').Distribution, pacedMs: import('../../Web/engine/js/haptoflow.d.ts').Distribution}} BrowserTier */
/** @typedef {{touchesMs: {shared: number[], ring: number[]}, missed: {shared: number, ring: number}, browser: BrowserTier[], native: any}} Round native: a report of `haptoflow bench` */

const ms = (value) => value.toFixed(2);

/** Ratios of each round, and their middle: `middle (least to most)`. */
export function spread(ratios) {
  const { minimum, median, worst } = distribution(ratios);
  return `${median.toFixed(1)} (${minimum.toFixed(1)} to ${worst.toFixed(1)})`;
}

function touchRow(name, times, missed) {
  const { count, median, percentile99, worst } = distribution(times);
  return `| ${name} | ${count} | ${missed} | ${median.toFixed(1)} | ${percentile99.toFixed(1)} | ${worst.toFixed(1)} |`;
}

function nativeRow(rounds) {
  const { block_frames: frames, p50, p99, worst, count, missed } = rounds.at(-1).native.onset_ms;
  return `| the native engine: from publishing a touch-down, blocks of ${frames} frames | ${count} | ${missed} | ${p50.toFixed(1)} | ${p99.toFixed(1)} | ${worst.toFixed(1)} |`;
}

function tierRow(rounds, tier) {
  const cells = ['hot', 'paced'].flatMap((pace) => {
    const browser = rounds.map((round) => round.browser.find((each) => each.tier === tier)[`${pace}Ms`].median);
    const native = rounds.map((round) => (pace === 'hot' ? round.native.inference_ms[tier] : round.native.inference_ms[tier].paced).p50);
    return [ms(distribution(browser).median), ms(distribution(native).median), spread(browser.map((time, round) => time / native[round]))];
  });
  return `| ${tier} | ${cells.join(' | ')} |`;
}

/** Above the rows of *Measure this device* (Web/page/panels/device.mjs). */
const deviceHeader = [
  '| browser | cores | memory | ms for a segment: hot / paced (99th percentile of paced) | latency that the browser states: base + output, ms | touch to first sample rendered (99th percentile), ms | pointer event to engine (99th percentile), ms | poses per second in the headset | date |',
  '|---|---|---|---|---|---|---|---|---|',
];

/**
 * @param {Round[]} rounds
 * @param {{machine: string, browserName: string, outputLatencyMs: number, deviceRow: string}} where
 */
export function webTables(rounds, { machine, browserName, outputLatencyMs, deviceRow }) {
  const all = (way) => rounds.flatMap(({ touchesMs }) => touchesMs[way]);
  const missed = (way) => rounds.reduce((sum, round) => sum + round.missed[way], 0);
  return [
    `${machine}; ${browserName}; ${rounds.length} rounds, in each the browser and the native engine in turns.`,
    '',
    '| from a touch to its first sample, ms | touches | without sound | median | 99th percentile | worst |',
    '|---|---|---|---|---|---|',
    touchRow('pointer event to its sample rendered, shared memory', all('shared'), missed('shared')),
    touchRow('pointer event to its sample rendered, ring', all('ring'), missed('ring')),
    nativeRow(rounds),
    '',
    `To be heard, a sample takes the output's latency in addition; the browser states ${outputLatencyMs.toFixed(1)} ms for it. The goal is 15 ms at the 99th percentile with shared memory.`,
    '',
    '| one segment, ms (medians) | browser, hot | native, hot | ratio: middle (least to most of the rounds) | browser, paced | native, paced | ratio |',
    '|---|---|---|---|---|---|---|',
    ...rounds[0].browser.map(({ tier }) => tierRow(rounds, tier)),
    '',
    'The goal is at most 3 times the native time.',
    '',
    'The row of *Measure this device* on the same machine:',
    '',
    ...deviceHeader,
    deviceRow,
  ].join('\n');
}
