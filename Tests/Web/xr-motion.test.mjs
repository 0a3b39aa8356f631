import assert from 'node:assert/strict';
import { test } from 'node:test';
import { rotate } from '../../Web/page/xr/frames.mjs';
import { Motion } from '../../Web/page/xr/motion.mjs';
import { sceneOpener } from './support/contact.mjs';

// The contact model says where a touched point is in the room and in the surface's own frame: that gives away the pose it uses.

const { open } = await sceneOpener();
const turn = (angle, [x, y, z]) => [Math.sin(angle / 2) * x, Math.sin(angle / 2) * y, Math.sin(angle / 2) * z, Math.cos(angle / 2)];
const motions = {
  'there and back, in a loop': { loop: true, keyframes: [
    { t: 0, position: [-0.07, 0.002, 0] },
    { t: 4, position: [0.07, 0.002, 0] },
    { t: 8, position: [-0.07, 0.002, 0] },
  ] },
  'a curve that turns': { loop: false, keyframes: [
    { t: 1, position: [0.2, 0, 0] },
    { t: 1.5, position: [0.25, 0.02, 0.1], rotation: turn(1, [0, 1, 0]) },
    { t: 3, position: [0.1, 0, -0.1], rotation: turn(2.5, [0, 0.6, 0.8]) },
  ] },
  'an open loop of two keyframes, the long way of its signs': { loop: true, keyframes: [
    { t: 0, rotation: [0, 0, 0, 1] },
    { t: 2, position: [0.1, 0, 0], rotation: turn(0.8, [0, 1, 0]).map((part) => -part) },
  ] },
};

for (const [name, motion] of Object.entries(motions)) {
  test(`${name}: a moving surface is drawn where the contact model touches it`, () => {
    const surface = { name: 'mover', shape: { box: { size: [2, 0.5, 2] } }, material: 'wood', motion };
    const drawn = new Motion(surface);
    assert.equal(drawn.isMoving, true);
    let checked = 0;
    for (let seconds = 0; seconds < 20; seconds += 0.37) {
      const scene = open({ surfaces: [surface] });
      drawn.at(seconds);
      // Just below the middle of the upper face, as it is drawn.
      const [x, y, z] = rotate(drawn.rotation, [0.01, 0.2495, 0.02], []);
      const tip = [x + drawn.position[0], y + drawn.position[1], z + drawn.position[2]];
      const contact = scene.update({ timeSeconds: seconds, positionMetres: tip });
      assert.equal(contact.touching, true, `${seconds} s`);
      const there = rotate(drawn.rotation, contact.placeMetres, []).map((part, axis) => part + drawn.position[axis]);
      there.forEach((part, axis) => assert.ok(Math.abs(part - contact.contactMetres[axis]) < 1e-6, `${seconds} s: ${there} and ${contact.contactMetres}`));
      const up = rotate(drawn.rotation, [0, 1, 0], []);
      up.forEach((part, axis) => assert.ok(Math.abs(part - contact.normal[axis]) < 1e-6, `${seconds} s: ${up} and ${contact.normal}`));
      scene.close();
      checked += 1;
    }
    assert.ok(checked > 50);
  });
}

test('a surface that rests has its pose at any time, normalised', () => {
  const motion = new Motion({ position: [1, 2, 3], rotation: [0, 2, 0, 0] });
  assert.equal(motion.isMoving, false);
  motion.at(7);
  assert.deepEqual(motion.position, [1, 2, 3]);
  assert.deepEqual(motion.rotation, [0, 1, 0, 0]);
});
