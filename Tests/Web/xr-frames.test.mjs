import assert from 'node:assert/strict';
import { test } from 'node:test';
import { mirrorPosition, mirrorRotation, mirrorTriangle, Placement, rotate } from '../../Web/page/xr/frames.mjs';

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

test('a quarter turn to the left in the room is one to the left in the scene', () => {
  // Unity turns clockwise seen from above for a positive angle about y, WebXR against the clock.
  near(rotate([0, half, 0, half], [0, 0, -1], []), [-1, 0, 0], 'the room');
  near(rotate(mirrorRotation([0, half, 0, half], []), [0, 0, 1], []), [-1, 0, 0], 'the scene');
});

test('the front of a triangle stays where it is', () => {
  // Unity's front is where corners run clockwise: seen from above, from the left to the far corner to the right.
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
