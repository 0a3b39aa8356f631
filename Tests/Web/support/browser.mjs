import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { chromium } from 'playwright-core';
import { chromiumPath } from '../../../scripts/web/chromium.mjs';
import { engineFolder } from './places.mjs';
import { serve } from './server.mjs';

const here = path.dirname(fileURLToPath(import.meta.url));

/** False skips the tests that need a browser. */
export const hasBrowser = chromiumPath !== undefined;

/** Whether this is the long form, `./run test --all`. */
export const isLong = process.env.HAPTOFLOW_LONG_TESTS === '1';

/** The rows of a table of cases that run: all in the long form, by default those of these names. */
export const casesOf = (/** @type {any[][]} */ rows, /** @type {string[]} */ daily) => (isLong ? rows : rows.filter(([name]) => daily.includes(name)));

/**
 * A page in Chromium with the engine beside it.
 * @param {{isolated?: boolean, needsGesture?: boolean, engine?: string, name?: string, folders?: Record<string, string>, viewport?: {width: number, height: number}}} [options]
 *   engine: the folder of its files; name: of the page in Tests/Web/pages; folders: what it needs besides
 */
export async function openPage({ isolated = true, needsGesture = false, engine = engineFolder, name = 'live', folders = {}, viewport } = {}) {
  const server = await serve({ folders: { engine, pages: path.join(here, '..', 'pages'), ...folders }, isolated });
  const args = ['--no-sandbox', ...(needsGesture ? [] : ['--autoplay-policy=no-user-gesture-required'])];
  const browser = await chromium.launch({ executablePath: chromiumPath, args });
  const context = await browser.newContext({ viewport });
  const page = await context.newPage();
  /** @type {string[]} */
  const complaints = [];
  page.on('pageerror', (error) => complaints.push(error.message));
  page.on('console', (message) => {
    if (message.type() === 'error') complaints.push(message.text());
  });
  await page.goto(`${server.address}/pages/${name}.html`);
  await page.waitForFunction(() => 'HaptoFlow' in globalThis);
  return {
    page, context, server, complaints,
    close: async () => {
      await browser.close();
      await server.close();
    },
  };
}
