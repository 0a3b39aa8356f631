// How high a tip rests on the table's objects. Shapes are those of SCENE.json that can be seen from above: boxes turned about y,
// spheres, lying capsules turned about z by 90 degrees.

/** @typedef {{name: string, shape: any, position?: number[], rotation?: number[], motion?: any, material: any}} Surface */
/** @typedef {{name: string, kind: 'box' | 'sphere' | 'capsule', halfX: number, halfZ: number, halfHeight: number, radius: number, cos: number, sin: number, position: number[], rotation: number[], isMoving: boolean}} Top */

/** @param {Surface} surface @returns {Top} */
export function topOf({ name, shape, position = [0, 0, 0], rotation = [0, 0, 0, 1], motion = null }) {
  const [x, y, z, w] = rotation;
  const first = motion?.keyframes[0].position ?? position;
  const common = { name, position: [...first], rotation: [...rotation], isMoving: motion !== null, cos: 1, sin: 0, halfX: 0, halfZ: 0, halfHeight: 0, radius: 0 };
  if (shape.box) {
    if (x !== 0 || z !== 0) throw new Error(`${name}: a box on the table may turn about y only`);
    const [sizeX, sizeY, sizeZ] = shape.box.size;
    return { ...common, kind: 'box', halfX: sizeX / 2, halfZ: sizeZ / 2, halfHeight: sizeY / 2, cos: 1 - 2 * y * y, sin: 2 * w * y };
  }
  if (shape.sphere) return { ...common, kind: 'sphere', radius: shape.sphere.radius };
  if (shape.capsule && Math.abs(Math.abs(z) - Math.SQRT1_2) < 1e-3) {
    return { ...common, kind: 'capsule', radius: shape.capsule.radius, halfX: shape.capsule.height / 2 - shape.capsule.radius };
  }
  throw new Error(`${name}: the table shows boxes, spheres and capsules that lie along x`);
}

/**
 * Height of the centre of a sphere of radius `offset` that rests on a top at (x, z); -Infinity beside it.
 * @param {Top} top @param {number} x @param {number} z @param {number} offset
 */
export function restingHeight(top, x, z, offset) {
  const dx = x - top.position[0];
  const dz = z - top.position[2];
  if (top.kind === 'box') {
    const alongX = Math.max(0, Math.abs(top.cos * dx - top.sin * dz) - top.halfX);
    const alongZ = Math.max(0, Math.abs(top.sin * dx + top.cos * dz) - top.halfZ);
    const beyond = alongX * alongX + alongZ * alongZ;
    if (beyond > offset * offset) return -Infinity;
    return top.position[1] + top.halfHeight + Math.sqrt(offset * offset - beyond);
  }
  const beyondX = Math.max(0, Math.abs(dx) - top.halfX);
  const reach = top.radius + offset;
  const squared = reach * reach - beyondX * beyondX - dz * dz;
  return squared < 0 ? -Infinity : top.position[1] + Math.sqrt(squared);
}

/**
 * The top that a tip rests on, the highest. The last wins where two are level.
 * @param {Top[]} tops @param {number} x @param {number} z @param {number} offset
 * @returns {{index: number, height: number}} index -1 beside the table
 */
export function highestAt(tops, x, z, offset) {
  let index = -1;
  let height = -Infinity;
  for (let each = 0; each < tops.length; each += 1) {
    const found = restingHeight(tops[each], x, z, offset);
    if (found >= height && found > -Infinity) {
      index = each;
      height = found;
    }
  }
  return { index, height };
}
