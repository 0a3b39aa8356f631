import { existsSync } from 'node:fs';
import { chromium } from 'playwright-core';
import { CommandError } from './process.mjs';

/** HAPTOFLOW_CHROMIUM, or where systems put it; undefined for none. */
export const chromiumPath = process.env.HAPTOFLOW_CHROMIUM ?? ['/usr/bin/chromium', '/usr/bin/chromium-browser', '/usr/bin/google-chrome'].find((file) => existsSync(file));

/** Starts Chromium without a window. Its pages may play sound at once, since nobody is there to tap. @param {readonly string[]} [more] arguments of the program */
export function launchChromium(more = []) {
  if (!chromiumPath) throw new CommandError('there is no Chromium: install the package chromium (Debian), or name one in HAPTOFLOW_CHROMIUM', 2);
  return chromium.launch({ executablePath: chromiumPath, args: ['--no-sandbox', '--autoplay-policy=no-user-gesture-required', ...more] });
}
