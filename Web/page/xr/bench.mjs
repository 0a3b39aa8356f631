import { mirrorPosition, mirrorRotation, mirrorTriangle } from './frames.mjs';

// The scene's objects for three.js, in metres; `three` is its namespace, which is loaded only in a headset.

const planeMetres = 20;
/** Enough for a headset's depths to tell two faces apart. */
const aboveMetres = 0.0002;
const emptyPose = () => ({ position: [0, 0, 0], rotation: [0, 0, 0, 1] });

/** Stretches texture coordinates from 0..1 to metres, so that every object shows a picture at its true size. */
function scaleToMetres(geometry, metresOf) {
  const { uv, normal } = geometry.attributes;
  for (let index = 0; index < uv.count; index += 1) {
    const [u, v] = metresOf(normal.getX(index), normal.getY(index), normal.getZ(index));
    uv.setXY(index, uv.getX(index) * u, uv.getY(index) * v);
  }
  return geometry;
}

/** Texture coordinates change places: the picture's lines run along the object. */
function alongTheLength(geometry) {
  const { uv } = geometry.attributes;
  for (let index = 0; index < uv.count; index += 1) uv.setXY(index, uv.getY(index), uv.getX(index));
  return geometry;
}

function boxOf(three, { size: [x, y, z] }) {
  const facing = (nx, ny) => (Math.abs(nx) > 0.5 ? [z, y] : Math.abs(ny) > 0.5 ? [x, z] : [x, y]);
  return scaleToMetres(new three.BoxGeometry(x, y, z), facing);
}

/** A face just above a box's upper one, with texture coordinates in metres, 0 in its middle: x and the scene's z. */
function shadedTop(three, { size: [x, y, z] }, material) {
  const geometry = new three.PlaneGeometry(x, z).rotateX(-Math.PI / 2);
  const { uv } = geometry.attributes;
  for (let index = 0; index < uv.count; index += 1) uv.setXY(index, (uv.getX(index) - 0.5) * x, (uv.getY(index) - 0.5) * z);
  const face = new three.Mesh(geometry, material);
  face.position.y = y / 2 + aboveMetres;
  return face;
}

function meshOf(three, { vertices, triangles }) {
  const geometry = new three.BufferGeometry();
  const corners = triangles.flatMap(mirrorTriangle).flatMap((index) => mirrorPosition(vertices[index], [0, 0, 0]));
  geometry.setAttribute('position', new three.Float32BufferAttribute(corners, 3));
  // Seen from above.
  const uv = corners.flatMap((_, at) => (at % 3 === 0 ? [corners[at], -corners[at + 2]] : []));
  geometry.setAttribute('uv', new three.Float32BufferAttribute(uv, 2));
  geometry.computeVertexNormals();
  return geometry;
}

/** A geometry of a SCENE.json shape, in the room's handedness, with texture coordinates in metres. */
export function geometryOf(three, shape) {
  if (shape.box) return boxOf(three, shape.box);
  if (shape.sphere) {
    const { radius } = shape.sphere;
    return scaleToMetres(new three.SphereGeometry(radius, 48, 32), () => [2 * Math.PI * radius, Math.PI * radius]);
  }
  if (shape.capsule) {
    const { radius, height } = shape.capsule;
    return scaleToMetres(alongTheLength(new three.CapsuleGeometry(radius, Math.max(0, height - 2 * radius), 12, 32)), () => [height, 2 * Math.PI * radius]);
  }
  if (shape.plane) return scaleToMetres(new three.PlaneGeometry(planeMetres, planeMetres).rotateX(-Math.PI / 2), () => [planeMetres, planeMetres]);
  return meshOf(three, shape.mesh);
}

/** The objects of a scene. */
export class Bench {
  #looks;
  #poses;
  #objects;
  #moving;

  /**
   * @param {object} parts
   * @param {any} parts.three
   * @param {object} parts.scene SCENE.json
   * @param {import('../../engine/js/haptoflow.d.ts').Scene} parts.poses the same surfaces, perhaps with others after them
   * @param {{material: (material: string | Record<string, number>) => any}} parts.looks
   * @param {Map<string, any>} [parts.shadings] by names of boxes: what lies over their upper faces, for texture coordinates in metres
   */
  constructor({ three, scene, poses, looks, shadings = new Map() }) {
    this.#looks = looks;
    this.#poses = poses;
    this.group = new three.Group();
    this.#objects = new Map(scene.surfaces.map((surface, index) => {
      const mesh = new three.Mesh(geometryOf(three, surface.shape), looks.material(surface.material));
      mesh.name = surface.name;
      if (shadings.has(surface.name)) mesh.add(shadedTop(three, surface.shape.box, shadings.get(surface.name)));
      this.group.add(mesh);
      return [surface.name, { mesh, index, isMoving: Boolean(surface.motion), pose: emptyPose(), mirrored: emptyPose() }];
    }));
    for (const object of this.#objects.values()) this.#place(object, 0);
    this.#moving = [...this.#objects.values()].filter(({ isMoving }) => isMoving);
  }

  #place({ mesh, index, pose, mirrored }, timeSeconds) {
    this.#poses.poseOf(index, timeSeconds, pose);
    mesh.position.fromArray(mirrorPosition(pose.position, mirrored.position));
    mesh.quaternion.fromArray(mirrorRotation(pose.rotation, mirrored.rotation));
  }

  /** Moves what moves by itself. */
  update(timeSeconds) {
    for (const object of this.#moving) this.#place(object, timeSeconds);
  }

  /** Gives a surface the look of a label. */
  paint(name, label) {
    const object = this.#objects.get(name);
    if (object) object.mesh.material = this.#looks.material(label);
  }
}
