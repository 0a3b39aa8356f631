import assert from 'node:assert/strict';
import { mock, test } from 'node:test';
import { latencyHintOf } from '../../Web/engine/js/audio-context.mjs';
import { OutputWatch } from '../../Web/engine/js/output-watch.mjs';

/** A context as Chromium's: `outputs` are there; without any it fails, and then runs without an output only. */
class MadeContext extends EventTarget {
  sinkId = /** @type {any} */ ('');
  state = 'running';
  outputs = 1;
  /** Listed, though gone. */
  ghosts = 0;
  refusals = 0;
  /** How long time still passes on an output that is gone. */
  ghostSeconds = 0;
  #time = 0;
  #chosenAtMs = 0;

  get currentTime() {
    const isGhostAlive = this.ghosts > 0 && performance.now() - this.#chosenAtMs < 1000 / 20 * this.ghostSeconds;
    if (this.state === 'running' && (this.sinkId !== '' || this.outputs > 0 || isGhostAlive)) this.#time += 0.1;
    return this.#time;
  }

  unplug() {
    this.outputs = 0;
    this.dispatchEvent(new Event('error'));
    this.state = 'suspended';
  }

  async setSinkId(/** @type {any} */ id) {
    if (this.refusals > 0) {
      this.refusals -= 1;
      throw new Error('busy');
    }
    if (id === '' && this.outputs + this.ghosts === 0) throw new Error('the device is not found');
    this.sinkId = id;
    this.#chosenAtMs = performance.now();
  }

  async resume() {
    this.state = 'running';
  }
}

const { setTimeout: realTimeout } = globalThis;
/** Longer than the watch looks whether time passes, which here takes a twentieth. */
const proven = () => new Promise((resolve) => {
  realTimeout(resolve, 1700 / 20);
});
const settle = () => new Promise((resolve) => {
  setImmediate(resolve);
});

/** Runs with seconds that pass at once, and with the page's list of devices. */
async function watched(/** @type {any} */ context, /** @type {(pass: (seconds: number) => Promise<void>, states: string[], watch: OutputWatch) => Promise<void>} */ action) {
  /** @type {(() => void)[]} */
  const timers = [];
  const made = mock.method(globalThis, 'setInterval', (/** @type {() => void} */ tick) => timers.push(tick));
  const cleared = mock.method(globalThis, 'clearInterval', (/** @type {number} */ number) => {
    if (number) timers[number - 1] = () => {};
  });
  const quick = mock.method(globalThis, 'setTimeout', (/** @type {() => void} */ action, /** @type {number} */ milliseconds) => realTimeout(action, milliseconds / 20));
  const devices = mock.method(navigator, 'mediaDevices', () => ({ enumerateDevices: async () => Array.from({ length: context.outputs + context.ghosts }, () => ({ kind: 'audiooutput' })) }), { getter: true });
  try {
    /** @type {string[]} */
    const states = [];
    const watch = new OutputWatch(context, (state) => states.push(state));
    await action(async (seconds) => {
      for (let second = 0; second < seconds; second += 1) {
        timers.forEach((tick) => tick());
        await settle();
        await proven();
      }
    }, states, watch);
    watch.close();
  } finally {
    [made, cleared, quick, devices].forEach(({ mock: each }) => each.restore());
  }
}
if (!globalThis.navigator) Object.defineProperty(globalThis, 'navigator', { value: {}, configurable: true });
if (!('mediaDevices' in navigator)) Object.defineProperty(navigator, 'mediaDevices', { get: () => undefined, configurable: true });

test('a context whose output is unplugged runs without one, and takes the next; each is told once', async () => {
  const context = new MadeContext();
  await watched(context, async (pass, states, watch) => {
    context.unplug();
    context.dispatchEvent(new Event('error'));
    await settle();
    assert.deepEqual(context.sinkId, { type: 'none' });
    assert.equal(context.state, 'running');
    await pass(2);
    assert.deepEqual(states, ['lost']);
    assert.equal(watch.hasLost, true);
    context.outputs = 1;
    await pass(1);
    assert.equal(context.sinkId, '');
    assert.deepEqual(states, ['lost', 'back']);
    assert.equal(watch.hasLost, false);
    context.unplug();
    await settle();
    assert.deepEqual(states, ['lost', 'back', 'lost']);
  });
});

test('an output that is gone, but on which time passes for a while, is not taken for one that is back', async () => {
  const context = new MadeContext();
  await watched(context, async (pass, states, watch) => {
    context.ghosts = 1;
    context.ghostSeconds = 0.6;
    context.unplug();
    await pass(2);
    assert.deepEqual(states, ['lost']);
    assert.equal(watch.hasLost, true);
    assert.deepEqual(context.sinkId, { type: 'none' });
    context.ghosts = 0;
    context.outputs = 1;
    await pass(1);
    assert.deepEqual(states, ['lost', 'back']);
  });
});

test('an output that fails while it is tried is not taken for one that is back', async () => {
  const context = new MadeContext();
  await watched(context, async (pass, states, watch) => {
    context.unplug();
    context.outputs = 1;
    const choose = context.setSinkId.bind(context);
    context.setSinkId = async (id) => {
      await choose(id);
      if (id === '') context.dispatchEvent(new Event('error'));
    };
    await pass(2);
    assert.deepEqual(states, ['lost']);
    assert.equal(watch.hasLost, true);
    context.setSinkId = choose;
    await pass(1);
    assert.deepEqual(states, ['lost', 'back']);
  });
});

test('a first attempt that fails is followed by another', async () => {
  const context = new MadeContext();
  await watched(context, async (pass) => {
    context.refusals = 1;
    context.unplug();
    await settle();
    assert.equal(context.state, 'suspended');
    await pass(1);
    assert.equal(context.state, 'running');
  });
});

test('a browser that cannot choose outputs is left alone, and the page is told to reload', async () => {
  const context = new MadeContext();
  Object.defineProperty(context, 'setSinkId', { value: undefined });
  await watched(context, async (pass, states) => {
    context.unplug();
    await pass(3);
    assert.equal(context.state, 'suspended');
    assert.deepEqual(states, ['stopped']);
  });
});

test('the smallest buffer is asked for, but not on Android, whose may be no multiple of a block', () => {
  assert.equal(latencyHintOf('Mozilla/5.0 (X11; Linux x86_64) Chrome/156.0.0.0 Safari/537.36'), 0);
  assert.equal(latencyHintOf('Mozilla/5.0 (Linux; Android 14; Quest 3) OculusBrowser/40.0 VR Safari/537.36'), 'interactive');
});
