import assert from 'node:assert/strict';
import { test } from 'node:test';
import { isDocked, profileOf, tipForceNewtons } from '../../Web/page/xr/profiles.mjs';
import { Pulses } from '../../Web/page/xr/pulses.mjs';

const source = (...profiles) => ({ targetRayMode: 'tracked-pointer', profiles });
const pressed = (values) => ({ buttons: Array.from({ length: 7 }, (_, index) => ({ value: values[index] ?? 0, pressed: (values[index] ?? 0) > 0 })) });

test('MX Ink is known by its profile, also behind one that is not known, and its tip is the origin of its ray', () => {
  for (const profiles of [['logitech-mx-ink', 'generic-trigger'], ['logitech-mx-ink-2', 'logitech-mx-ink']]) {
    const profile = profileOf(source(...profiles));
    assert.equal(profile.name, 'MX Ink');
    assert.deepEqual(profile.tipMetres, [0, 0, 0]);
  }
});

test('controllers have a nib before them, and no measured force', () => {
  for (const name of ['meta-quest-touch-plus', 'meta-quest-touch-pro', 'valve-index', 'generic-trigger-squeeze-thumbstick']) {
    const profile = profileOf(source(name));
    assert.ok(profile.tipMetres[2] < 0);
    assert.equal(tipForceNewtons(profile, pressed({ 5: 1 }), 1), undefined);
  }
});

test('a tracked hand touches with the index finger; gaze and transient pointers touch nothing', () => {
  assert.equal(profileOf({ ...source(), hand: new Map() }).joint, 'index-finger-tip');
  assert.equal(profileOf({ targetRayMode: 'gaze', profiles: [] }), null);
  assert.equal(profileOf({ targetRayMode: 'transient-pointer', profiles: [] }), null);
});

test('the force of an MX Ink is its fifth button times the range; in the air the spring takes over', () => {
  const ink = profileOf(source('logitech-mx-ink'));
  assert.equal(tipForceNewtons(ink, pressed({ 5: 0.5 }), 3), 1.5);
  assert.equal(tipForceNewtons(ink, pressed({ 5: 0.005 }), 3), undefined);
  assert.equal(tipForceNewtons(ink, pressed({ 0: 1, 1: 1, 4: 1 }), 3), undefined);
  assert.equal(tipForceNewtons(ink, null, 3), undefined);
});

test('an MX Ink in its dock is seen by its sixth button', () => {
  const ink = profileOf(source('logitech-mx-ink'));
  assert.equal(isDocked(ink, pressed({ 6: 1 })), true);
  assert.equal(isDocked(ink, pressed({ 5: 1 })), false);
  assert.equal(isDocked(profileOf(source('meta-quest-touch-plus')), pressed({ 6: 1 })), false);
});

test('a pulse goes to the first haptic actuator, to a vibration actuator, or as a rumble', () => {
  const sent = [];
  const pulse = (name) => ({ pulse: (value, durationMs) => sent.push([name, value, durationMs]) });
  const rumble = { playEffect: (type, { duration, strongMagnitude, weakMagnitude }) => sent.push([type, duration, strongMagnitude, weakMagnitude]) };
  for (const gamepad of [{ hapticActuators: [pulse('first'), pulse('second')] }, { vibrationActuator: pulse('vibration') }, { vibrationActuator: rumble }]) {
    const pulses = new Pulses();
    pulses.attach(gamepad);
    pulses.send(0.5, 20);
  }
  assert.deepEqual(sent, [['first', 0.5, 20], ['vibration', 0.5, 20], ['dual-rumble', 20, 0.5, 0.5]]);
});

test('no gamepad, no motor and a motor that fails are borne, and another one is tried again', async () => {
  const pulses = new Pulses();
  for (const gamepad of [null, {}, { hapticActuators: [] }]) {
    pulses.attach(gamepad);
    assert.equal(pulses.isAvailable, false);
    pulses.send(1, 10);
  }
  let calls = 0;
  const failing = { hapticActuators: [{ pulse: () => Promise.reject(new Error(`${calls += 1}`)) }] };
  pulses.attach(failing);
  pulses.send(1, 10);
  await null;
  await null;
  pulses.send(1, 10);
  assert.equal(calls, 1);
  assert.equal(pulses.isAvailable, false);
  pulses.attach({ hapticActuators: [{ pulse: () => { throw new Error('gone'); } }] });
  pulses.send(1, 10);
  assert.equal(pulses.isAvailable, false);
});
