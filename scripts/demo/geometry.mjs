/** Geometry for the drawings of a scene: rotated outlines and positions of moving objects. Metres, Unity's frame. */

const add = (a, b) => a.map((value, axis) => value + b[axis]);
const cross = (a, b) => [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]];

/** `v` rotated by the unit quaternion [x, y, z, w]. */
export function rotate([x, y, z, w], v) {
  const twice = cross([x, y, z], v).map((value) => 2 * value);
  return add(add(v, twice.map((value) => w * value)), cross([x, y, z], twice));
}

/** Convex hull of points in a plane: its corners, counter-clockwise. */
export function convexHull(points) {
  const sorted = [...points].sort((a, b) => a[0] - b[0] || a[1] - b[1]);
  const turn = (o, a, b) => (a[0] - o[0]) * (b[1] - o[1]) - (a[1] - o[1]) * (b[0] - o[0]);
  const chain = (ordered) => {
    const hull = [];
    for (const point of ordered) {
      while (hull.length >= 2 && turn(hull.at(-2), hull.at(-1), point) <= 0) hull.pop();
      hull.push(point);
    }
    hull.pop();
    return hull;
  };
  return [...chain(sorted), ...chain(sorted.reverse())];
}

/** The pose at which a drawing shows a surface: its own, or the first keyframe of its motion. */
export function restPose(surface) {
  const pose = surface.motion?.keyframes[0] ?? surface;
  return { position: pose.position ?? [0, 0, 0], rotation: pose.rotation ?? [0, 0, 0, 1] };
}

/** Points whose convex hull in any view along a world axis is the surface's outline; null for a plane. */
function outlinePoints(surface, project) {
  const { position, rotation } = restPose(surface);
  const placed = (local) => project(add(rotate(rotation, local), position));
  const { box, sphere, capsule, plane } = surface.shape;
  if (plane) return null;
  if (box) {
    const corners = [-0.5, 0.5].flatMap((x) => [-0.5, 0.5].flatMap((y) => [-0.5, 0.5].map((z) => [x, y, z])));
    return corners.map((corner) => placed(corner.map((sign, axis) => sign * box.size[axis])));
  }
  const round = (centre, radius) =>
    Array.from({ length: 48 }, (_, step) => {
      const angle = (2 * Math.PI * step) / 48;
      return [centre[0] + radius * Math.cos(angle), centre[1] + radius * Math.sin(angle)];
    });
  if (sphere) return round(placed([0, 0, 0]), sphere.radius);
  if (capsule) {
    const reach = Math.max(0, capsule.height / 2 - capsule.radius);
    return [-reach, reach].flatMap((y) => round(placed([0, y, 0]), capsule.radius));
  }
  throw new RangeError(`surface "${surface.name}": the drawing knows box, sphere, capsule and plane`);
}

/** The surface's outline in a view, or null for a plane. `project` maps [x, y, z] to the view's two axes. */
export function outline(surface, project) {
  const points = outlinePoints(surface, project);
  return points && convexHull(points);
}

/** Position of a moving surface at a time, interpolated as the engine does it: a cubic with continuous velocity. */
export function positionAt(surface, timeSeconds) {
  const keyframes = surface.motion?.keyframes;
  if (!keyframes) return restPose(surface).position;
  const first = keyframes[0];
  const last = keyframes.at(-1);
  const span = last.t - first.t;
  let time = timeSeconds;
  if (surface.motion.loop) time = first.t + ((((time - first.t) % span) + span) % span);
  if (time <= first.t) return first.position;
  if (time >= last.t) return last.position;
  const index = keyframes.findIndex((keyframe) => keyframe.t > time) - 1;
  const [from, to] = [keyframes[index], keyframes[index + 1]];
  const duration = to.t - from.t;
  const share = (time - from.t) / duration;
  const slopes = [index, index + 1].map((place) => velocityAt(keyframes, place, surface.motion.loop));
  return from.position.map((value, axis) => {
    const [s, s2, s3] = [share, share ** 2, share ** 3];
    return (
      (2 * s3 - 3 * s2 + 1) * value + (s3 - 2 * s2 + s) * duration * slopes[0][axis] +
      (3 * s2 - 2 * s3) * to.position[axis] + (s3 - s2) * duration * slopes[1][axis]
    );
  });
}

/** Velocity at a keyframe: the mean between its neighbours. The first and last keyframe of a closed loop are the same. */
function velocityAt(keyframes, index, loop) {
  const end = keyframes.length - 1;
  const chord = (from, to, wrap = 0) =>
    keyframes[to].position.map((value, axis) => (value - keyframes[from].position[axis]) / (keyframes[to].t - keyframes[from].t + wrap));
  if (index > 0 && index < end) return chord(index - 1, index + 1);
  const closed = loop && end > 1 && keyframes[0].position.every((value, axis) => value === keyframes[end].position[axis]);
  if (closed) return chord(end - 1, 1, keyframes[end].t - keyframes[0].t);
  return index === 0 ? chord(0, 1) : chord(end - 1, end);
}
