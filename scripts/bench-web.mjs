// bench:web: measures the live page in Chromium beside the native engine into out/bench-web.json (--quick, --publish)
import { mkdirSync, readFileSync, writeFileSync } from 'node:fs';
import os from 'node:os';
import { parseArgs } from 'node:util';
import { modelLine, sha256Of, shippedModel, withMeasuredPart } from './lib/measured_part.mjs';
import { buildNative } from './lib/native_build.mjs';
import { CommandError, commandLinePath, inRepository, runMain, runOrFail } from './lib/process.mjs';
import { setUp } from './lib/setup.mjs';
import { measureTouches, webTables } from './lib/web_bench.mjs';

const report = inRepository('out', 'bench-web.json');
const documentPath = inRepository('Documentation~', 'in-the-browser.md');
const command = 'npm run bench:web -- --publish';
const full = { rounds: 5, touches: 40, seconds: 4, events: 60 };
const quick = { rounds: 2, touches: 10, seconds: 1, events: 10 };

function optionsOf(words) {
  try {
    const { values } = parseArgs({ args: words, options: { quick: { type: 'boolean', default: false }, publish: { type: 'boolean', default: false } } });
    if (values.quick && values.publish) throw new CommandError('--publish goes with a whole run: without --quick', 2);
    return values;
  } catch (error) {
    if (error instanceof CommandError) throw error;
    throw new CommandError(error.message, 2);
  }
}

/** The live page, ready to be touched. */
async function openPage(browser, address) {
  const page = await browser.newPage({ viewport: { width: 1200, height: 760 } });
  await page.goto(address);
  await page.waitForFunction(() => 'haptoflowPage' in globalThis && globalThis.haptoflowPage.haptics.context.state === 'running');
  return page;
}

async function nativeRound(only, events) {
  const file = inRepository('out', 'bench', 'beside-web.json');
  await runOrFail(commandLinePath(), ['bench', '--only', only, '--events', String(events), '--quiet', '-o', file], { quiet: true });
  return JSON.parse(readFileSync(file, 'utf8'));
}

/** What the page's own button finds: a row, and the same as JSON. */
async function deviceRow(page) {
  await page.locator('#measure').click();
  await page.waitForFunction(() => !globalThis.document.querySelector('#measure').disabled, null, { timeout: 120000 });
  return { row: await page.locator('#measure-row').textContent(), json: JSON.parse(await page.locator('#measure-json').textContent()) };
}

/** Touches through the ring and with shared memory, then segments, and in the last round the page's own button. */
async function browserRound(browser, addresses, { touches, seconds, isLast }) {
  const ring = await openPage(browser, addresses.ring);
  const throughRing = await measureTouches(ring, touches);
  await ring.close();
  const page = await openPage(browser, addresses.shared);
  const shared = await measureTouches(page, touches);
  const tiers = await page.evaluate((each) => globalThis.haptoflowPage.haptics.measure({ seconds: each }), seconds);
  const device = isLast ? await deviceRow(page) : null;
  await page.close();
  return {
    touchesMs: { shared: shared.timesMs, ring: throughRing.timesMs },
    missed: { shared: shared.missed, ring: throughRing.missed },
    browser: tiers,
    device,
  };
}

const help = `usage: npm run bench:web [-- --quick] [-- --publish]

Measures the live page in Chromium without a window, and the native engine in turns with it, into out/bench-web.json: from a
pointer event to its first sample, with shared memory and with the ring, and the time of a segment. Takes about eight minutes;
run nothing else meanwhile.

  --quick    two short rounds: a first look
  --publish  a whole run, written into Documentation~/in-the-browser.md too`;

await runMain('bench:web', async (words) => {
  const options = optionsOf(words);
  await setUp(['build', 'web', 'browser']);
  await buildNative({ targets: ['haptoflow_cli'] });
  // Imported here, since set-up may just have installed the packages that they need.
  const [{ buildEngine }, { pageFolder, stagePage }, { launchChromium }, { serveFolder }] = await Promise.all([
    import('./web/build_engine.mjs'), import('./web/build_page.mjs'), import('./web/chromium.mjs'), import('./web/static_server.mjs'),
  ]);
  await buildEngine();
  stagePage();
  mkdirSync(inRepository('out', 'bench'), { recursive: true });
  const { rounds: count, touches, seconds, events } = options.quick ? quick : full;
  const servers = { shared: await serveFolder({ folder: pageFolder() }), ring: await serveFolder({ folder: pageFolder(), isIsolated: false }) };
  const addresses = { shared: servers.shared.address, ring: servers.ring.address };
  const browser = await launchChromium(['--disable-gpu']);
  const rounds = [];
  for (let round = 1; round <= count; round += 1) {
    console.log(`bench:web: round ${round} of ${count}`);
    const isLast = round === count;
    // The native latencies take a minute, and one round of them is enough beside the browser's.
    const native = await nativeRound(isLast ? 'latency,inference' : 'inference', events);
    rounds.push({ native, ...await browserRound(browser, addresses, { touches, seconds, isLast }) });
  }
  const { device } = rounds.at(-1);
  const browserName = `Chromium ${browser.version()} without a window`;
  await browser.close();
  Object.values(servers).forEach(({ close }) => close());
  const machine = `${os.cpus()[0].model.trim()}, ${os.cpus().length} cores, load ${rounds[0].native.machine.load_average.before ?? '-'} before`;
  const sha256 = sha256Of(shippedModel);
  const tables = webTables(rounds, { machine, browserName, outputLatencyMs: device.json.outputLatencyMs, deviceRow: device.row });
  writeFileSync(report, `${JSON.stringify({ date: new Date().toISOString(), model_sha256: sha256, machine, browser: browserName, rounds }, null, 2)}\n`);
  console.log(`\n${tables}\n\nbench:web: ${report}`);
  if (options.publish) {
    writeFileSync(documentPath, withMeasuredPart(readFileSync(documentPath, 'utf8'), command, `${modelLine(sha256)}\n\n${tables}`));
    console.log(`bench:web: ${documentPath}`);
  }
}, { help });
