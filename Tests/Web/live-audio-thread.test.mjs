import assert from 'node:assert/strict';
import { test } from 'node:test';
import { setFlagsFromString } from 'node:v8';
import { runInNewContext } from 'node:vm';
import { field, fieldCount } from '../../Web/engine/js/contact-fields.mjs';
import { Core, createMemory } from '../../Web/engine/js/module.mjs';
import { makeRelief } from '../../Web/engine/js/relief.mjs';
import { engineModule, modelBytes, startOrt } from './support/engine.mjs';

// An audio worklet's globals, so that its processors run in Node.

/** @type {Map<string, any>} */
const processors = new Map();

class Processor {
  constructor() {
    /** @type {any[]} */
    this.sent = [];
    this.port = { onmessage: (/** @type {any} */ event) => event, postMessage: (/** @type {any} */ message) => void this.sent.push(message) };
  }
}

Object.assign(globalThis, {
  AudioWorkletProcessor: Processor,
  registerProcessor: (/** @type {string} */ name, /** @type {any} */ type) => processors.set(name, type),
  sampleRate: 48000,
  currentFrame: 0,
});

await import('../../Web/engine/js/worklet.mjs');

/** @param {string} name @param {object} processorOptions @returns {any} */
const makeProcessor = (name, processorOptions) => new (processors.get(name))({ processorOptions });

// Worker, page and audio thread of one engine, taking turns on one thread.

setFlagsFromString('--expose-gc');
const collectGarbage = runInNewContext('gc');
const qualities = { standard: 2, sketch: 4 };
const blockFrames = 128;

async function liveEngine(quality) {
  const memory = createMemory();
  const runtime = await startOrt();
  const worker = new Core(engineModule, { memory, mayWait: true, runtime: runtime.imports });
  runtime.attach(worker);
  const model = worker.copyIn(modelBytes);
  worker.call('hapto_model_open', model, modelBytes.length);
  worker.call('hapto_engine_create', quality, 72, 200, 1, 8);
  const voice = worker.call('hapto_voice_create', 48000);
  const page = new Core(engineModule, { memory, thread: worker.createThread(), isPage: true });
  const samples = worker.allocate(4 * 4096);
  const processor = makeProcessor('haptoflow-shared', { module: engineModule, memory, thread: worker.createThread(), voice, samples });
  const fields = page.allocate(8 * fieldCount);
  const block = new Float32Array(blockFrames);
  const inputs = [];
  const outputs = [[block]];
  return {
    worker, page, voice, processor, block,
    publish(changes) {
      page.f64.fill(0, fields >> 3, (fields >> 3) + fieldCount);
      const state = { touching: 1, labelCount: 1, weights: 1, velocity: 0.15, force: 1, effects: 1, ...changes };
      for (const [name, value] of Object.entries(state)) page.f64[(fields >> 3) + field[name]] = value;
      page.call('hapto_voice_publish', voice, fields);
    },
    play() {
      processor.process(inputs, outputs);
      return block;
    },
    generate: () => worker.call('hapto_engine_turn', 0),
    statistics: () => page.json('hapto_voice_statistics', voice),
  };
}

const loudest = (block) => block.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);

test('a published touch sounds in the next block, before the worker had a turn', async () => {
  const engine = await liveEngine(qualities.standard);
  assert.equal(loudest(engine.play()), 0);
  engine.publish({});
  assert.ok(loudest(engine.play()) > 0);
});

test('a page that no longer publishes is silent after 100 ms', async () => {
  const engine = await liveEngine(qualities.sketch);
  engine.publish({});
  for (let block = 0; block < 45; block += 1) {
    engine.generate();
    engine.play();
  }
  assert.equal(loudest(engine.play()), 0);
  assert.equal(engine.statistics().silence, 2);
  assert.equal(engine.statistics().staleStops, 1);
});

test('the worker generates, the audio thread plays it, and nothing is late at the pace of a display', async () => {
  const engine = await liveEngine(qualities.standard);
  const blocksPerState = 5;
  for (let state = 0; state < 144; state += 1) {
    engine.publish({ velocity: 0.1 + 0.08 * Math.sin(state / 10) });
    engine.generate();
    for (let block = 0; block < blocksPerState; block += 1) {
      engine.play();
      engine.generate();
    }
  }
  const found = engine.statistics();
  assert.ok(found.inferences >= 100);
  assert.equal(found.underruns, 0);
  assert.equal(found.failures, 0);
  assert.equal(found.nonFiniteSamples, 0);
});

test('the audio thread allocates nothing in ten thousand blocks', async () => {
  const engine = await liveEngine(qualities.sketch);
  const relief = makeRelief(engine.worker, { columns: 2, rows: 1, heightsMetres: Float32Array.of(0, 1e-4), sizeMetres: [0.002, 0.002], depthMetres: 1e-4 });
  const ribs = { effects: 1 + 0x200, relief, reliefShare: 0.5 };
  const samples = new SharedArrayBuffer(4 * 4800);
  const counter = new SharedArrayBuffer(4);
  engine.processor.port.onmessage({ data: { tap: { samples, counter } } });
  // Compiling what runs often allocates, once.
  for (let block = 0; block < 20000; block += 1) {
    if (block % 5 === 0 && block < 3000) engine.publish({ ...ribs, reliefPlace: block / 25 });
    engine.play();
  }
  assert.ok(engine.statistics().effects.relief.runs > 1000);
  collectGarbage();
  const memoryBefore = engine.worker.memory.buffer.byteLength;
  // Node's own work beside may allocate in some of the windows.
  const grown = Array.from({ length: 6 }, () => {
    const before = process.memoryUsage().heapUsed;
    for (let block = 0; block < 10000; block += 1) engine.play();
    return process.memoryUsage().heapUsed - before;
  });
  assert.ok(Math.min(...grown.filter((bytes) => bytes >= 0)) < 5000, `the heap grew by ${grown.join(', ')} bytes`);
  assert.equal(engine.worker.memory.buffer.byteLength, memoryBefore);
  assert.equal(new Int32Array(counter)[0], blockFrames * (20000 + 6 * 10000));
});

test('blocks of silence after a sound take no longer than others: no denormal is left in a filter', async () => {
  const engine = await liveEngine(qualities.sketch);
  const secondsOf = (blocks) => {
    const began = performance.now();
    for (let block = 0; block < blocks; block += 1) engine.play();
    return (performance.now() - began) / blocks;
  };
  for (let state = 0; state < 300; state += 1) {
    engine.publish({ effects: 7, approachSpeed: 0.3, touchCounter: 1 + Math.floor(state / 50) });
    for (let block = 0; block < 5; block += 1) engine.play();
  }
  engine.publish({ touching: 0 });
  const times = Array.from({ length: 40 }, () => secondsOf(400));
  const usual = [...times].sort((one, other) => one - other)[20];
  // Denormals take a processor ten to a hundred times as long; the machine may be busy for a while.
  assert.ok(times.filter((time) => time > 5 * usual).length <= 4, times.map((time) => (1000 * time).toFixed(1)).join(' '));
  assert.ok(usual < 0.1);
});

test('the ring plays blocks in their order and counts those that come too late', () => {
  const processor = makeProcessor('haptoflow-ring', {});
  const blocks = { onmessage: null, sent: [], postMessage(count) { this.sent.push(count); } };
  processor.port.onmessage({ data: { blocks } });
  const output = new Float32Array(blockFrames);
  const play = () => {
    output.fill(0);
    processor.process([], [[output]]);
    return output[0];
  };
  assert.equal(play(), 0);
  assert.deepEqual(processor.sent, []);
  blocks.onmessage({ data: new Float32Array(256).fill(0.5) });
  blocks.onmessage({ data: new Float32Array(256).fill(0.25) });
  assert.deepEqual([play(), play(), play(), play()], [0.5, 0.5, 0.25, 0.25]);
  assert.deepEqual(blocks.sent, [256, 512]);
  assert.equal(play(), 0);
  assert.deepEqual(processor.sent.at(-1), { late: 1 });
});
