import assert from 'node:assert/strict';
import path from 'node:path';
import { test } from 'node:test';
import { learn, render } from '../../Web/engine/js/offline.mjs';
import { coreWithModel, hasCommandLine, modelBytes, native, recording, sample, samplePath, wavSamples } from './support/engine.mjs';

const core = await coreWithModel();

/** The largest difference between two renders, as a part of the peak. */
function difference(web, other) {
  assert.equal(web.length, other.length);
  let largest = 0;
  let peak = 0;
  for (let index = 0; index < web.length; index += 1) {
    largest = Math.max(largest, Math.abs(web[index] - other[index]));
    peak = Math.max(peak, Math.abs(other[index]));
  }
  assert.ok(peak > 0.01);
  return largest / peak;
}

function nativeSamples(scene, words) {
  return native(
    (folder) => ['render', samplePath(`${scene}.scene.json`), '--stroke', samplePath(`${scene}.stroke.csv`), '-o', path.join(folder, 'out.wav'), '--quiet', ...words],
    (folder) => wavSamples(path.join(folder, 'out.wav')),
  );
}

const strokeOf = (scene) => ({ scene: sample(`${scene}.scene.json`), stroke: sample(`${scene}.stroke.csv`) });

for (const [quality, rateHz] of /** @type {[string, number][]} */ ([['sketch', 48000], ['draft', 48000], ['standard', 44100]])) {
  test(`${quality} at ${rateHz} Hz gives the command line's samples within a millionth of the peak`, { skip: !hasCommandLine }, () => {
    const web = render(core, { ...strokeOf('crossing'), quality, rateHz, seed: 5, leadMs: 6 });
    const other = nativeSamples('crossing', ['--quality', quality, '--rate', String(rateHz), '--seed', '5', '--lead-ms', '6']);
    assert.ok(difference(web.samples, other) < 1e-6, `difference ${difference(web.samples, other)}`);
    assert.equal(web.tier, quality);
    assert.equal(web.rateHz, rateHz);
  });
}

test('impacts, edges, listening, compensation and delay give the command line\'s samples', { skip: !hasCommandLine }, () => {
  const effects = { texture: true, impact: true, edge: true };
  const web = render(core, { ...strokeOf('taps'), quality: 'sketch', effects, listen: true, actuator: 'voice-coil', delayMs: 20, fullScaleMps2: 100 });
  const words = ['--quality', 'sketch', '--effects', 'texture,impact,edge', '--listen', '--actuator', 'voice-coil', '--delay-ms', '20', '--full-scale', '100'];
  const found = difference(web.samples, nativeSamples('taps', words));
  // The C libraries round std::hypot of two floats, an edge's speed, differently (with WebAssembly's hypotf here too: 2.2e-7), and ears hear it ten times as loud.
  assert.ok(found < 4e-6, `difference ${found}`);
});

test('a second render of the same seed gives the same bytes, another seed others', () => {
  const options = { ...strokeOf('tracing'), quality: 'sketch' };
  const first = render(core, options);
  assert.deepEqual(render(core, options).samples, first.samples);
  assert.notDeepEqual(render(core, { ...options, seed: 2 }).samples, first.samples);
});

const refusals = [
  ['a quality that the model lacks', { quality: 'best' }, 'invalid-argument', /"best": this model has sketch, draft, standard/],
  ['a stroke without a header', { stroke: '0,0,0,0\n' }, 'input', /stroke:1: expected the header/],
  ['a scene that is no JSON', { scene: '{' }, 'input', /scene:1:2: not valid JSON/],
  ['a scene with an unknown key', { scene: { surfaces: [], colour: 1 } }, 'input', /unknown key "colour"/],
  ['an unknown material', { scene: sample('tracing.scene.json').replace(/"material": "[^"]+"/, '"material": "wodo"') }, 'input', /'wodo', which the model does not know; did you mean 'wood/],
  ['a rate out of range', { rateHz: 4000 }, 'invalid-argument', /rate/],
];
for (const [name, change, code, message] of refusals) {
  test(`${name} is refused by a message that says what is expected`, () => {
    assert.throws(() => render(core, { ...strokeOf('tracing'), quality: 'sketch', ...change }), (error) => {
      assert.equal(error.code, code);
      assert.match(error.message, message);
      return true;
    });
  });
}

const damages = [
  ['cut short', (bytes) => bytes.subarray(0, bytes.length - 1000), 'MODEL_TRUNCATED'],
  ['of no bytes', () => new Uint8Array(0), 'MODEL_TRUNCATED'],
  ['another file', () => new TextEncoder().encode('<!doctype html><title>Not found</title>'.repeat(10)), 'NOT_A_MODEL'],
  ['with a changed byte', (bytes) => Uint8Array.from(bytes, (byte, index) => (index === bytes.length - 5000 ? byte ^ 1 : byte)), 'MODEL_DAMAGED'],
];
for (const [name, damage, code] of damages) {
  test(`a model ${name} is refused as ${code}`, async () => {
    await assert.rejects(coreWithModel({ model: damage(modelBytes) }), (error) => {
      assert.equal(error.code, code);
      assert.ok(error.message.length > 20, error.message);
      return true;
    });
  });
}

const bytesOf = (text) => new TextEncoder().encode(text);

const unlearnable = [
  ['a recording without motion', bytesOf(recording(2).replaceAll(/,[^,\n]+,[^,\n]+,[^,\n]+\n/g, '\n')), 'RECORDING_UNUSABLE', /rough\.csv/],
  ['bytes that are no table', new Uint8Array(40), 'RECORDING_UNUSABLE', /rough\.csv/],
  ['a blink', bytesOf(recording(0.1)), 'RECORDING_UNUSABLE', /short|seconds| s /],
];
for (const [name, bytes, code, message] of unlearnable) {
  test(`${name}: learning says why it cannot`, () => {
    assert.throws(() => learn(core, { recording: [{ name: 'rough.csv', bytes }] }), (error) => {
      assert.equal(error.code, code);
      assert.match(error.message, message);
      return true;
    });
  });
}
