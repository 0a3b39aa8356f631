import assert from 'node:assert/strict';
import { spawnSync } from 'node:child_process';
import { existsSync, readdirSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { test } from 'node:test';
import { render } from '../../Web/engine/js/offline.mjs';
import { pageFolder, stagePage } from '../../scripts/lib/web_build.mjs';
import { coreWithModel, engineFolder, repository, sample } from './support/engine.mjs';
import { hasSoundServer, startProgram, startSoundServer } from './support/programs.mjs';
import { serve } from './support/server.mjs';

// Browsers that the tests cannot drive. Each opens support/check.html, which checks by itself and posts a report.

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
const browsers = {
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
 * @returns {Promise<any>} see support/check.mjs
 */
async function reportOf(name, { task, isolated = true }) {
  stagePage();
  const { words, environment } = browsers[name];
  /** @type {(report: any) => void} */
  let take = () => {};
  const reported = new Promise((resolve) => {
    take = resolve;
  });
  const server = await serve({
    folders: { engine: engineFolder, somewhere: pageFolder(), pages: path.join(repository, 'Tests', 'Web', 'support') },
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

const task = { scene: sample('tracing.scene.json'), stroke: sample('tracing.stroke.csv') };
const loudest = (/** @type {ArrayLike<number>} */ wave) => Array.from(wave).reduce((most, each) => Math.max(most, Math.abs(each)), 0);

for (const [name, { isThere }] of Object.entries(browsers)) {
  for (const isolated of [true, false]) {
    test(`${name}, ${isolated ? 'with' : 'without'} shared memory: the samples, live sound, silence, recovery and the live page`, { skip: !isThere || !hasSoundServer, timeout: 150000 }, async () => {
      const { failures, userAgent, rendered, slid, drawn } = await reportOf(name, { task, isolated });
      console.log(`# ${userAgent}: ${JSON.stringify(slid?.engine)} ${JSON.stringify({ ...slid?.voice, effects: undefined })}`);
      assert.deepEqual(failures, []);
      const core = await coreWithModel();
      for (const quality of ['sketch', 'draft', 'standard']) {
        const { samples } = render(core, { ...task, quality });
        assert.equal(rendered[quality].length, samples.length);
        const difference = loudest(samples.map((expected, index) => rendered[quality][index] - expected));
        assert.ok(difference <= 1e-6 * loudest(samples), `${quality}: ${difference} of ${loudest(samples)}`);
      }
      assert.equal(slid.engine.sharing, isolated ? 'shared' : 'ring');
      assert.equal(slid.state, 'running');
      assert.ok(slid.peak > 1e-4 && slid.motor > 0.05, `${slid.peak}, ${slid.motor}`);
      assert.equal(slid.quiet, 0);
      assert.equal(slid.voice.underruns + slid.voice.failures + slid.voice.nonFiniteSamples, 0);
      assert.ok(slid.voice.renderedFrames > 48000);
      assert.deepEqual(slid.events.map((/** @type {string} */ event) => event.split(' ')[0]), ['error', 'recovered']);
      assert.ok(slid.again > 1e-4, `${slid.again}`);
      assert.ok(drawn.isComplete && drawn.start);
      for (const surface of ['sandpaper sheet', 'jute mat']) assert.ok(drawn.heard.includes(surface), `${drawn.heard}`);
      assert.ok(drawn.rmsMps2 > 0.1, `${drawn.rmsMps2}`);
      assert.deepEqual(drawn.complaints, []);
      assert.equal(drawn.error, '');
    });
  }
}
