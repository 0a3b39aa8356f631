import { spawnSync } from 'node:child_process';
import { existsSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { pageFolder, stagePage } from '../../../scripts/web/build.mjs';
import { engineFolder, repository } from './places.mjs';
import { startProgram } from './programs.mjs';
import { serve } from './server.mjs';
import { startSoundServer } from './sound-server.mjs';

// Browsers that the tests cannot drive. Each opens pages/check.html, which checks by itself and posts a report.

const limitSeconds = 90;
/** Below /usr/lib, in a folder named by the machine. */
const webkit = (existsSync('/usr/lib') ? readdirSync('/usr/lib') : []).map((name) => `/usr/lib/${name}/webkit2gtk-4.1/MiniBrowser`).find((file) => existsSync(file));
const hasProgram = (/** @type {string} */ name) => spawnSync('sh', ['-c', `command -v ${name}`]).status === 0;

/** Firefox may play sound without a gesture, and during a test it neither sends data nor updates itself. */
const firefoxPreferences = {
  'media.autoplay.default': 0,
  'media.autoplay.blocking_policy': 0,
  'datareporting.policy.dataSubmissionEnabled': false,
  'app.update.enabled': false,
};

/** @type {Record<string, {isThere: boolean, words: (address: string, home: string) => string[], environment: Record<string, string>}>} */
export const browsers = {
  Firefox: {
    isThere: hasProgram('firefox-esr'),
    words: (address, home) => {
      const lines = Object.entries(firefoxPreferences).map(([name, value]) => `user_pref("${name}", ${value});`);
      writeFileSync(path.join(home, 'user.js'), lines.join('\n'));
      return ['firefox-esr', '--headless', '--no-remote', '--profile', home, address];
    },
    environment: {},
  },
  WebKit: {
    isThere: webkit !== undefined && hasProgram('xvfb-run'),
    words: (address) => ['xvfb-run', '-a', /** @type {string} */ (webkit), '--autoplay-policy=allow', address],
    // Its sandbox asks for what containers lack; shared memory is on in Safari, and behind this switch here.
    environment: { WEBKIT_DISABLE_SANDBOX_THIS_IS_DANGEROUS: '1', JSC_useSharedArrayBuffer: '1' },
  },
};

/**
 * What a browser finds.
 * @param {string} name of `browsers`
 * @param {{task: object, isolated?: boolean}} options task: what it renders
 * @returns {Promise<any>} see pages/check.mjs
 */
export async function reportOf(name, { task, isolated = true }) {
  stagePage();
  const { words, environment } = browsers[name];
  /** @type {(report: any) => void} */
  let take = () => {};
  const reported = new Promise((resolve) => {
    take = resolve;
  });
  const server = await serve({
    folders: { engine: engineFolder, somewhere: pageFolder(), pages: path.join(repository, 'Tests', 'Web', 'pages') },
    isolated,
    answers: {
      '/task.json': () => JSON.stringify(task),
      '/report': (body) => {
        take(JSON.parse(body));
        return '{}';
      },
    },
  });
  const sound = await startSoundServer();
  const program = startProgram((home) => words(`${server.address}/pages/check.html`, home), { environment: { ...environment, ...sound.environment } });
  const late = new Promise((resolve, reject) => {
    setTimeout(() => reject(new Error(`${name} sent no report within ${limitSeconds} s`)), 1000 * limitSeconds).unref();
  });
  try {
    return await Promise.race([reported, late]);
  } finally {
    await program.end();
    await sound.close();
    await server.close();
  }
}
