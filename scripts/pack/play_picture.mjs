// Draws Documentation~/images/play.png: the live page in Chromium, during a stroke, stamped with the model. Run it after
// `npm run build:web`.
import { inRepository, runOrFail } from '../lib/process.mjs';
import { drawingModules, pythonOrFail } from '../lib/setup.mjs';
import { pageFolder, stagePage } from '../lib/web_build.mjs';
import { launchChromium } from '../lib/chromium.mjs';
import { serveFolder } from '../lib/static_server.mjs';

stagePage();
const { address, close } = await serveFolder({ folder: pageFolder() });
const browser = await launchChromium(['--disable-gpu']);
const page = await browser.newPage({ viewport: { width: 1200, height: 760 } });
await page.goto(address);
await page.waitForFunction(() => 'haptoflowPage' in globalThis);
await page.getByRole('button', { name: 'Along the front' }).click();
// Over the jute.
await page.waitForTimeout(1600);
const picture = inRepository('Documentation~', 'images', 'play.png');
await page.screenshot({ path: picture });
await browser.close();
close();
await runOrFail(pythonOrFail(drawingModules), [inRepository('scripts', 'pack', 'renders.py'), '--palette', picture]);
