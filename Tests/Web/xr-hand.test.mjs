import assert from 'node:assert/strict';
import { test } from 'node:test';
import { Hand } from '../../Web/page/xr/hand.mjs';
import { Hands } from '../../Web/page/xr/hands.mjs';
import { Placement } from '../../Web/page/xr/frames.mjs';
import { sceneOpener } from './support/engine.mjs';

// The real contact model; a voice and motors that note what they are told.

const { open } = await sceneOpener();
const table = { surfaces: [{ name: 'table', shape: { box: { size: [1, 0.02, 1] } }, material: 'wood', stiffness: 500 }] };
const frameMs = 1000 / 72;

function voiceThatNotes() {
  const voice = {
    share: 0.4, states: [], paused: false, effects: {}, isClosed: false,
    lift: () => voice.states.push('lift'),
    publishFields: (numbers, first = 0) => voice.states.push(numbers[first] !== 0 ? 'touch' : 'air'),
    motorTap: () => ({ peak: () => voice.share, close() {} }),
    close: async () => {
      voice.isClosed = true;
    },
  };
  return voice;
}

function padThatNotes() {
  const sent = [];
  return { sent, buttons: [], hapticActuators: [{ pulse: async (value, durationMs) => sent.push([value, durationMs]) }] };
}

function handWith(scene = table) {
  const voice = voiceThatNotes();
  const contactScene = open(scene);
  const hand = new Hand({ scene: contactScene, voice });
  const pad = padThatNotes();
  hand.hold(pad);
  voice.states.length = 0;
  let frame = 0;
  const step = (position, force) => {
    frame += 1;
    hand.update((frame * frameMs) / 1000, frameMs, position, force);
  };
  return { voice, scene: contactScene, hand, pad, step };
}

const on = (x) => [x, 0.0098, 0];
const air = (x) => [x, 0.05, 0];

test('a tip in the air publishes and does not pulse; one that slides pulses in every frame with the share of its motor tap', () => {
  const { voice, hand, pad, step } = handWith();
  for (let frame = 0; frame < 5; frame += 1) step(air(0.01 * frame));
  assert.deepEqual(voice.states, Array(5).fill('air'));
  assert.equal(pad.sent.length, 0);
  for (let frame = 0; frame < 5; frame += 1) {
    voice.share = 0.1 * (frame + 1);
    step(on(0.01 * frame));
  }
  assert.equal(hand.contact.surfaceName, 'table');
  assert.deepEqual(pad.sent.map(([value]) => value), [1, 2, 3, 4, 5].map((value) => 0.1 * value));
  for (const [, durationMs] of pad.sent) assert.ok(durationMs > frameMs && durationMs < 2 * frameMs);
});

test('the wave of a touch that just ended is felt once more, then nothing', () => {
  const { pad, step } = handWith();
  step(on(0));
  step(air(0));
  step(air(0));
  step(air(0));
  assert.equal(pad.sent.length, 2);
});

test('a tip that rests does not pulse', () => {
  const { voice, pad, step } = handWith();
  voice.share = 0;
  for (let frame = 0; frame < 5; frame += 1) step(on(0));
  assert.equal(pad.sent.length, 0);
});

test('a tip that is lost lifts, and comes back as a new touch without a jump', () => {
  const { voice, hand, step } = handWith();
  for (let frame = 0; frame < 10; frame += 1) step(on(0.002 * frame));
  step(null);
  assert.equal(hand.contact, null);
  assert.equal(voice.states.at(-1), 'lift');
  step(null);
  // Half a metre away within a frame would be 36 m/s.
  step(on(0.4));
  assert.ok(Math.hypot(...hand.contact.velocityMps) < 0.01, `${hand.contact.velocityMps}`);
  assert.equal(hand.contact.approachSpeedMps, 0, 'a tip that appears within an object did not hit it');
});

test('a measured force takes the place of the spring', () => {
  const { hand, step } = handWith();
  step(on(0), 2.5);
  assert.equal(hand.contact.forceNewtons, 2.5);
  step(on(0), undefined);
  assert.ok(Math.abs(hand.contact.forceNewtons - 500 * hand.contact.penetrationMetres) < 1e-6);
});

test('a hand out of focus is silent at once, and touches anew when the focus is back', () => {
  const { voice, hand, pad, step } = handWith();
  step(on(0));
  hand.suspend();
  assert.equal(voice.paused, true);
  assert.equal(voice.states.at(-1), 'lift');
  const sent = pad.sent.length;
  for (let frame = 0; frame < 4; frame += 1) step(on(0.01 * frame));
  assert.equal(hand.contact, null);
  assert.equal(pad.sent.length, sent);
  hand.resume();
  assert.equal(voice.paused, false);
  step(on(0.2));
  assert.equal(hand.contact.surfaceName, 'table');
  assert.ok(Math.hypot(...hand.contact.velocityMps) < 0.01);
});

test('a hand without a motor touches and sounds', () => {
  const { voice, hand, pad, step } = handWith();
  hand.hold(null);
  step(on(0));
  assert.equal(voice.states.at(-1), 'touch');
  assert.equal(hand.hasMotor, false);
  assert.equal(pad.sent.length, 0);
});

test('only distinct poses count', () => {
  const { hand, step } = handWith();
  for (const x of [0, 0, 0.1, 0.1, 0.2]) step(air(x));
  assert.equal(hand.poses, 3);
});

test('a closed hand has closed its voice and its scene', async () => {
  const { voice, scene, hand } = handWith();
  await hand.close();
  assert.equal(voice.isClosed, true);
  assert.throws(() => scene.reset(), /closed/);
});

/** Two hands, and a frame that gives poses by source. */
function session() {
  const [left, right] = [handWith(), handWith()];
  const placement = new Placement();
  const hands = new Hands({ left: left.hand, right: right.hand, placement, newtonsAtFullPressure: 2 });
  const poses = new Map();
  const frame = { getPose: (space) => poses.get(space) ?? null, getJointPose: (space) => poses.get(space) ?? null };
  let time = 0;
  const source = (handedness, extra = {}) => ({
    handedness, targetRayMode: 'tracked-pointer', profiles: ['logitech-mx-ink'], targetRaySpace: {}, gamepad: padThatNotes(), ...extra,
  });
  const put = (space, place, pose = {}) => {
    const [x, y, z] = placement.toRoom(place, []);
    poses.set(space, { emulatedPosition: false, transform: { position: { x, y, z }, orientation: { x: 0, y: 0, z: 0, w: 1 } }, ...pose });
  };
  const step = () => {
    time += frameMs / 1000;
    hands.update(frame, {}, time, frameMs);
  };
  return { left, right, hands, poses, source, put, step };
}

test('two hands touch at once, each with its own contact and motor', () => {
  const { left, right, hands, source, put, step } = session();
  const sources = [source('left'), source('right')];
  hands.bind(sources);
  for (let frame = 0; frame < 4; frame += 1) {
    put(sources[0].targetRaySpace, on(-0.2 - 0.01 * frame));
    put(sources[1].targetRaySpace, on(0.2 + 0.002 * frame));
    step();
  }
  assert.ok(Math.hypot(...left.hand.contact.velocityMps) > 3 * Math.hypot(...right.hand.contact.velocityMps));
  assert.equal(sources[0].gamepad.sent.length, 4);
  assert.equal(sources[1].gamepad.sent.length, 4);
});

test('a source that vanishes in mid-stroke lifts, one that appears touches, and the other hand goes on', () => {
  const { left, right, hands, source, put, step } = session();
  const sources = [source('left'), source('right')];
  for (const each of sources) put(each.targetRaySpace, on(0));
  hands.bind(sources);
  step();
  hands.bind([sources[0]]);
  assert.equal(right.hand.contact, null);
  step();
  assert.equal(right.hand.contact, null);
  assert.notEqual(left.hand.contact, null);
  const other = source('right', { profiles: ['meta-quest-touch-plus'] });
  put(other.targetRaySpace, [0, 0.0098, -0.06]);
  hands.bind([sources[0], other]);
  step();
  assert.notEqual(right.hand.contact, null);
  assert.equal(left.voice.states.filter((state) => state === 'lift').length, 0, 'the left hand never lifted');
});

test('a guessed position, no pose and a pen in its dock do not touch', () => {
  const { right, hands, poses, source, put, step } = session();
  const pen = source('right');
  hands.bind([pen]);
  const isTouching = () => {
    step();
    return right.hand.contact !== null;
  };
  put(pen.targetRaySpace, on(0));
  assert.equal(isTouching(), true);
  put(pen.targetRaySpace, on(0), { emulatedPosition: true });
  assert.equal(isTouching(), false);
  put(pen.targetRaySpace, on(0));
  assert.equal(isTouching(), true);
  poses.delete(pen.targetRaySpace);
  assert.equal(isTouching(), false);
  put(pen.targetRaySpace, on(0));
  pen.gamepad.buttons[6] = { value: 1, pressed: true };
  assert.equal(isTouching(), false);
});

test('a source that never measures its position is taken as it is', () => {
  const { right, hands, source, put, step } = session();
  const pen = source('right');
  hands.bind([pen]);
  put(pen.targetRaySpace, on(0), { emulatedPosition: true });
  step();
  assert.notEqual(right.hand.contact, null);
});

test('the tip of an MX Ink presses with its force, a finger touches with its joint', () => {
  const { right, hands, source, put, step } = session();
  const pen = source('right');
  pen.gamepad.buttons[5] = { value: 0.25, pressed: true };
  put(pen.targetRaySpace, on(0));
  hands.bind([pen]);
  step();
  assert.equal(right.hand.contact.forceNewtons, 0.5);
  const joint = {};
  const finger = source('right', { profiles: ['generic-hand'], gamepad: null, hand: new Map([['index-finger-tip', joint]]) });
  put(joint, on(0));
  hands.bind([finger]);
  step();
  assert.notEqual(right.hand.contact, null);
  assert.equal(right.hand.hasMotor, false);
});

test('a source of neither hand takes the right, or what is free', () => {
  const { hands, source } = session();
  const [left, right] = hands.sides;
  const pen = source('none');
  hands.bind([pen]);
  assert.equal(right.source, pen);
  const other = source('right');
  hands.bind([other, pen]);
  assert.equal(right.source, other);
  assert.equal(left.source, pen);
});
