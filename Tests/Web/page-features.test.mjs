import assert from 'node:assert/strict';
import { afterEach, describe, test } from 'node:test';
import { casesOf, hasBrowser, isLong, openLivePage } from './support/browser.mjs';

// What a policy forbids or a browser lacks costs that feature and one line below the table, never the page.

/** @type {Awaited<ReturnType<typeof openLivePage>>} */
let opened;

/** Opens the page, strokes the sandpaper, and tries all that a feature may stand behind. */
async function live(options) {
  opened = await openLivePage({ ...options });
  // Taps, without which a browser refuses more.
  for (const id of ['output-vibration', 'output-rumble']) if (await opened.page.locator(`#${id}`).isEnabled()) await opened.page.locator(`#${id}`).check();
  return opened.page.evaluate(async () => {
    const { hand, scope, haptics } = globalThis.haptoflowPage;
    let loudest = 0;
    const timer = setInterval(() => {
      loudest = Math.max(loudest, scope?.rmsMps2 ?? 0);
    }, 20);
    await hand.play({ name: '', words: '', from: [-0.22, -0.112], legs: [{ to: [-0.15, -0.112], seconds: 0.4 }] });
    clearInterval(timer);
    document.getElementById('copy-row').click();
    await new Promise((resolve) => { setTimeout(resolve, 100); });
    const shown = (element) => element.checkVisibility();
    return {
      loudest,
      isOver: /cannot go on/.test(document.body.innerText),
      lines: [...document.querySelectorAll('#missing li')].filter(shown).map((line) => line.textContent),
      sharing: haptics.statistics().sharing,
      note: document.querySelector('#device-line').textContent,
      copied: document.querySelector('#measure-progress').textContent,
      rumble: !document.querySelector('#output-rumble').disabled,
      vibration: !document.querySelector('#output-vibration').disabled,
      headset: shown(document.querySelector('#enter-vr')),
    };
  });
}

/** The page lives and says these lines and no others. */
function judge(found, lines, hasMeter = true) {
  assert.equal(found.isOver, false);
  assert.ok(!hasMeter || found.loudest > 0.1, `the stroke's level is ${found.loudest}`);
  assert.deepEqual(found.lines.map((line) => line.split(':')[0]).sort(), [...lines].sort(), found.lines.join('\n'));
  for (const line of found.lines) assert.match(line, /^[A-Z][^:]+: .+\.$/);
}

const rumble = 'Rumble of a gamepad';
const vibration = 'Vibration of this phone';
const headset = 'Headset';

/** Each takes something away before the page's first script. @type {[string, () => void, string[], ((found: any) => void)?][]} */
const lacks = [
  ['all that may throw', () => {
    const denied = () => { throw new DOMException('denied', 'SecurityError'); };
    Navigator.prototype.getGamepads = denied;
    Navigator.prototype.vibrate = denied;
    Object.defineProperty(Navigator.prototype, 'xr', { value: { isSessionSupported: denied } });
    Clipboard.prototype.writeText = async () => denied();
    globalThis.SharedArrayBuffer = class SharedArrayBuffer { constructor() { throw new RangeError('Array buffer allocation failed'); } };
    for (const name of ['localStorage', 'sessionStorage', 'indexedDB', 'caches']) Object.defineProperty(globalThis, name, { get: denied });
  }, [rumble, vibration, headset], (found) => {
    assert.equal(found.sharing, 'ring');
    assert.match(found.copied, /did not allow copying/);
  }],
  ['gamepads that throw', () => { Navigator.prototype.getGamepads = () => { throw new DOMException('denied', 'SecurityError'); }; }, [rumble]],
  ['gamepads that are null', () => { Navigator.prototype.getGamepads = () => null; }, []],
  ['a gamepad whose motor throws', () => { Navigator.prototype.getGamepads = () => [{ id: 'made', vibrationActuator: { playEffect() { throw new TypeError('no such effect'); } } }]; }, [rumble]],
  ['a gamepad whose motor rejects', () => { Navigator.prototype.getGamepads = () => [{ id: 'made', vibrationActuator: { playEffect: async () => { throw new DOMException('no such effect', 'NotSupportedError'); } } }]; }, [rumble]],
  ['a gamepad whose motor has another interface', () => { Navigator.prototype.getGamepads = () => [{ id: 'made', vibrationActuator: {} }]; }, [rumble]],
  ['a vibration that throws', () => { Navigator.prototype.vibrate = () => { throw new DOMException('denied', 'SecurityError'); }; }, [vibration]],
  ['a vibration that is refused', () => { Navigator.prototype.vibrate = () => false; }, [vibration]],
  ['a WebXR that throws', () => { Object.defineProperty(Navigator.prototype, 'xr', { get() { throw new DOMException('denied', 'SecurityError'); } }); }, [headset]],
  ['a WebXR that throws when asked', () => { Object.defineProperty(Navigator.prototype, 'xr', { value: { isSessionSupported() { throw new DOMException('denied', 'SecurityError'); } } }); }, [headset]],
  ['a WebXR that never answers', () => { Object.defineProperty(Navigator.prototype, 'xr', { value: { isSessionSupported: () => new Promise(() => {}) } }); }, []],
  ['a WebXR of another interface', () => { Object.defineProperty(Navigator.prototype, 'xr', { value: {} }); }, [headset]],
  ['a clipboard that rejects', () => { Clipboard.prototype.writeText = async () => { throw new DOMException('denied', 'NotAllowedError'); }; }, [], (found) => assert.match(found.copied, /did not allow copying/)],
  ['no storage', () => {
    for (const name of ['localStorage', 'sessionStorage', 'indexedDB', 'caches']) Object.defineProperty(globalThis, name, { get() { throw new DOMException('denied', 'SecurityError'); } });
    Object.defineProperty(Document.prototype, 'cookie', { get() { throw new DOMException('denied', 'SecurityError'); } });
    delete Navigator.prototype.storage;
  }, []],
  ['a shared memory that is refused', () => { globalThis.SharedArrayBuffer = class SharedArrayBuffer { constructor() { throw new RangeError('Array buffer allocation failed'); } }; }, [], (found) => assert.equal(found.sharing, 'ring')],
  ['pictures that may not be read', () => { HTMLCanvasElement.prototype.toDataURL = () => { throw new DOMException('denied', 'SecurityError'); }; }, []],
  ['pictures of the signal that cannot be drawn', () => { delete globalThis.ImageData; }, ['Pictures of the signal']],
  ['no events of pointers but the plain ones', () => {
    for (const name of ['getCoalescedEvents', 'getPredictedEvents']) delete PointerEvent.prototype[name];
    Element.prototype.setPointerCapture = () => { throw new DOMException('denied', 'NotFoundError'); };
  }, []],
];

describe('the live page in a browser with', { skip: !hasBrowser }, () => {
  afterEach(() => opened?.close().finally(() => { opened = undefined; }));

  // live-page.test.mjs says so daily.
  if (isLong) test('all that it uses has nothing to say', async () => {
    judge(await live({}), []);
    assert.deepEqual(opened.complaints, []);
  });

  for (const [what, without, lines, more] of casesOf(lacks, ['all that may throw'])) {
    test(`${what} plays, and says ${lines.length === 0 ? 'no more than needed' : 'one line for each that it uses'}`, async () => {
      const found = await live({ before: without });
      judge(found, lines, !what.startsWith('pictures of the signal'));
      more?.(found);
      assert.deepEqual(opened.complaints, []);
    });
  }

  test('nothing of all that plays, and says one line for each', async () => {
    const found = await live({
      before: () => {
        for (const name of ['getGamepads', 'vibrate', 'xr', 'wakeLock', 'clipboard', 'storage', 'mediaDevices', 'serviceWorker', 'locks', 'permissions', 'userActivation']) delete Navigator.prototype[name];
        for (const name of ['localStorage', 'sessionStorage', 'indexedDB', 'caches', 'OffscreenCanvas', 'SharedArrayBuffer']) delete globalThis[name];
        delete Element.prototype.requestFullscreen;
        for (const name of ['getCoalescedEvents', 'getPredictedEvents']) delete PointerEvent.prototype[name];
      },
    });
    judge(found, [rumble, vibration, headset]);
    assert.equal(found.sharing, 'ring');
    assert.match(found.note, /^Sound goes through a ring that adds \d+ ms: this browser shares no memory/);
    assert.equal(found.rumble || found.vibration || found.headset, false);
    assert.match(found.copied, /did not allow copying/);
    assert.deepEqual(opened.complaints, []);
  });
});

test('a headset that refuses to be entered costs itself and one line, until it lets the visitor in', { skip: !hasBrowser }, async () => {
  opened = await openLivePage({
    before: () => {
      const xr = { isSessionSupported: async () => true, requestSession: async () => { throw new DOMException('no floor', 'NotSupportedError'); } };
      Object.defineProperty(Navigator.prototype, 'xr', { value: xr });
    },
  });
  try {
    const { page } = opened;
    await page.locator('#enter-vr').click();
    await page.locator('#missing li').waitFor();
    assert.match(await page.locator('#missing').innerText(), /^Headset: the browser fails at it \(no floor\)\.$/);
    assert.equal(await page.locator('#enter-vr').isEnabled(), true);
    await page.evaluate(() => { navigator.xr.requestSession = () => new Promise(() => {}); });
    await page.locator('#enter-vr').click();
    assert.equal(await page.locator('#missing').isHidden(), true);
    assert.deepEqual(opened.complaints, []);
  } finally {
    await opened.close();
  }
});

const everything = ['accelerometer', 'autoplay', 'camera', 'clipboard-read', 'clipboard-write', 'cross-origin-isolated', 'display-capture', 'encrypted-media',
  'fullscreen', 'gamepad', 'geolocation', 'gyroscope', 'idle-detection', 'magnetometer', 'microphone', 'midi', 'payment', 'picture-in-picture', 'screen-wake-lock',
  'serial', 'speaker-selection', 'storage-access', 'sync-xhr', 'unload', 'usb', 'web-share', 'window-management', 'xr-spatial-tracking'];
/** What Documentation~/in-the-browser.md says that a policy must allow. */
const leastContentPolicy = "default-src 'self'; script-src 'self' 'wasm-unsafe-eval'; worker-src 'self' blob:";
const policy = (names) => names.map((name) => `${name}=()`).join(', ');

describe('the live page under a policy', { skip: !hasBrowser }, () => {
  afterEach(() => opened?.close().finally(() => { opened = undefined; }));

  /** @type {[string, string[], ((found: any) => void)?][]} */
  const forbidden = [
    ['gamepad', [rumble], (found) => assert.match(found.lines[0], /Permissions-Policy/)],
    ['xr-spatial-tracking', [headset], (found) => assert.match(found.lines[0], /Permissions-Policy/)],
    ['clipboard-write', [], (found) => assert.match(found.copied, /did not allow copying/)],
    ['cross-origin-isolated', [], (found) => assert.equal(found.sharing, 'ring')],
  ];
  for (const [name, lines, more] of casesOf(forbidden, [])) {
    test(`that forbids ${name} by the server's header plays`, async () => {
      const found = await live({ headers: { 'Permissions-Policy': policy([name]) } });
      judge(found, lines);
      more?.(found);
    });
  }

  test('that forbids all that the page does not need by the server\'s headers plays, and says one line for each that it uses', async () => {
    const found = await live({ headers: { 'Permissions-Policy': policy(everything), 'Content-Security-Policy': leastContentPolicy } });
    judge(found, [rumble, headset]);
    assert.match(found.copied, /did not allow copying/);
    assert.match(found.lines[0], /Permissions-Policy/);
  });

  const crossOrigin = { 'Cross-Origin-Resource-Policy': 'cross-origin' };
  const none = everything.map((name) => `${name} 'none'`).join('; ');
  /** @type {[string, string, Record<string, string>, string[]][]} */
  const frames = [
    ['a frame that allows nothing by name', '', crossOrigin, [headset]],
    ['a frame that forbids the gamepad', 'allow="gamepad \'none\'; xr-spatial-tracking; clipboard-write"', crossOrigin, [rumble]],
    ['a frame that forbids all', `allow="${none}"`, crossOrigin, [rumble, headset]],
    ['a sandboxed frame with an origin of its own', 'sandbox="allow-scripts allow-same-origin" allow="autoplay"', crossOrigin, [headset]],
    ['a sandboxed frame without an origin', 'sandbox="allow-scripts" allow="autoplay"', { ...crossOrigin, 'Access-Control-Allow-Origin': '*' }, [headset]],
  ];
  for (const [what, frame, headers, lines] of casesOf(frames, ['a sandboxed frame without an origin'])) {
    test(`of ${what} plays`, async () => {
      const found = await live({ frame, headers });
      judge(found, lines);
      assert.equal(found.sharing, 'ring');
    });
  }

  if (isLong) test('that forbids pictures from data plays', async () => {
    judge(await live({ headers: { 'Content-Security-Policy': leastContentPolicy } }), []);
    // The icon alone.
    assert.ok(opened.complaints.every((text) => /image 'data:,'/.test(text)), opened.complaints.join('\n'));
  });

  test('that forbids WebAssembly says so, with the remedy', async () => {
    opened = await openLivePage({ waits: false, headers: { 'Content-Security-Policy': "default-src 'self'" } });
    await opened.page.waitForFunction(() => document.querySelector('#message')?.dataset.kind === 'error', null, { timeout: 20000 });
    assert.match(await opened.page.locator('#message-text').innerText(), /WebAssembly.*'wasm-unsafe-eval'/s);
  });
});
