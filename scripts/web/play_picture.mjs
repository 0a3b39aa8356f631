// Draws Documentation~/images/play.png: the live page in Chromium, during a stroke. Run it after `npm run build:web`.
import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { inRepository } from '../lib/repository.mjs';
import { pageFolder, stagePage } from './build_page.mjs';
import { serveFolder } from './static_server.mjs';

const executablePath = process.env.HAPTOFLOW_CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/google-chrome'].find((file) => existsSync(file));

stagePage();
const { address, close } = await serveFolder({ folder: pageFolder() });
const browser = await chromium.launch({ executablePath, args: ['--no-sandbox', '--disable-gpu', '--autoplay-policy=no-user-gesture-required'] });
const page = await browser.newPage({ viewport: { width: 1360, height: 850 } });
await page.goto(address);
await page.waitForFunction(() => 'haptoflowPage' in globalThis);
await page.getByRole('button', { name: 'Along the front' }).click();
// Over the jute.
await page.waitForTimeout(1600);
await page.screenshot({ path: inRepository('Documentation~', 'images', 'play.png') });
await browser.close();
close();
