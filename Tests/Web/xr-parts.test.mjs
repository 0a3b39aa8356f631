import assert from 'node:assert/strict';
import { test } from 'node:test';
import { mirrorPosition, mirrorRotation, mirrorTriangle, Placement, rotate } from '../../Web/page/xr/frames.mjs';
import { isDocked, profileOf, tipForceNewtons } from '../../Web/page/xr/profiles.mjs';
import { Pulses } from '../../Web/page/xr/pulses.mjs';

function near(found, expected, what = '') {
  expected.forEach((value, index) => assert.ok(Math.abs(found[index] - value) < 1e-9, `${what} ${found} and ${expected}`));
}
const half = Math.SQRT1_2;

test('what is ahead in the room is ahead in the scene, and right stays right', () => {
  near(mirrorPosition([0, 0, -1], []), [0, 0, 1]);
  near(mirrorPosition([1, 2, 3], []), [1, 2, -3]);
});

test('rotating and then mirroring is mirroring and then rotating, for every axis', () => {
  for (const rotation of [[half, 0, 0, half], [0, half, 0, half], [0, 0, half, half], [0.5, 0.5, -0.5, 0.5]]) {
    for (const vector of [[1, 0, 0], [0, 1, 0], [0, 0, 1]]) {
      const turnedThenMirrored = mirrorPosition(rotate(rotation, vector, []), []);
      const mirroredThenTurned = rotate(mirrorRotation(rotation, []), mirrorPosition(vector, []), []);
      near(mirroredThenTurned, turnedThenMirrored, `${rotation}`);
    }
  }
});

test('the front of a triangle stays where it is', () => {
  // Unity shows the side of a triangle on which its corners run clockwise: here, seen from above, left, far, right.
  const vertices = [[-1, 0, 0], [0, 0, 1], [1, 0, 0]];
  const [a, b, c] = mirrorTriangle([0, 1, 2]).map((index) => mirrorPosition(vertices[index], []));
  const [u, v] = [b, c].map((corner) => corner.map((part, axis) => part - a[axis]));
  // WebXR's front is along the right-handed cross product.
  const up = u[2] * v[0] - u[0] * v[2];
  assert.ok(up > 0, `${up}`);
});

test('the bench stands before a viewer who looks anywhere, at a height for the hands', () => {
  const placement = new Placement();
  // Looks to the left, and a little down.
  placement.before([1, 1.2, 2], [-0.1 * half, half, 0.1 * half, half].map((part) => part / Math.sqrt(1.01)));
  near(placement.position, [1 - 0.4, 0.75, 2]);
  near(placement.toScene([1 - 0.4, 0.75, 2], []), [0, 0, 0]);
  // Farther from the viewer is ahead in the scene; to the viewer's right is right.
  near(placement.toScene([1 - 0.6, 0.75, 2], []), [0, 0, 0.2]);
  near(placement.toScene([1 - 0.4, 0.75, 1.9], []), [0.1, 0, 0]);
});

test('room and scene go forth and back', () => {
  const placement = new Placement();
  placement.before([0.3, 1.7, -0.4], [0, Math.sin(0.35), 0, Math.cos(0.35)]);
  near(placement.toScene(placement.toRoom([0.1, 0.02, -0.3], []), []), [0.1, 0.02, -0.3]);
});

test('the bench is never on the floor nor above the head', () => {
  const placement = new Placement();
  placement.before([0, 0.4, 0], [0, 0, 0, 1]);
  assert.equal(placement.position[1], 0.6);
  placement.before([0, 2.1, 0], [0, 0, 0, 1]);
  assert.equal(placement.position[1], 1.05);
});

test('a viewer who looks straight down has the bench along the room', () => {
  const placement = new Placement();
  placement.before([0, 1.2, 0], [-half, 0, 0, half]);
  assert.equal(placement.yaw, 0);
});

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
