// Between the room of WebXR (right-handed, y up, -z ahead) and the scene of the engine (Unity's: left-handed, y up, z ahead).
// Vectors are anything with indices 0 to 2, rotations x, y, z, w.

/** The board behind the desk must stay within an arm's reach. */
const aheadMetres = 0.4;
const belowEyesMetres = 0.45;
const lowestMetres = 0.6;
const highestMetres = 1.05;

/** A position of one frame in the other; `into` may be `from`. */
export function mirrorPosition(from, into) {
  into[0] = from[0];
  into[1] = from[1];
  into[2] = -from[2];
  return into;
}

/** A rotation of one frame in the other; `into` may be `from`. */
export function mirrorRotation(from, into) {
  into[0] = -from[0];
  into[1] = -from[1];
  into[2] = from[2];
  into[3] = from[3];
  return into;
}

/** `vector` turned by `rotation`; `into` may be `vector`. */
export function rotate(rotation, vector, into) {
  const x = rotation[0];
  const y = rotation[1];
  const z = rotation[2];
  const w = rotation[3];
  const a = vector[0];
  const b = vector[1];
  const c = vector[2];
  const u = 2 * (y * c - z * b);
  const v = 2 * (z * a - x * c);
  const t = 2 * (x * b - y * a);
  into[0] = a + w * u + y * t - z * v;
  into[1] = b + w * v + z * u - x * t;
  into[2] = c + w * t + x * v - y * u;
  return into;
}

/** Corners of a mesh's triangles for WebXR: the front stays where it is, so that the order of corners turns round. */
export const mirrorTriangle = ([a, b, c]) => [a, c, b];

/** Where the workbench stands in the room: the scene's origin, turned about the vertical. */
export class Placement {
  /** In the room, metres. */
  position = new Float64Array([0, 0.75, -aheadMetres]);
  /** Radians about y, in the room's sense: from above, against the clock. */
  yaw = 0;
  #sine = 0;
  #cosine = 1;

  /** Stands before a viewer, at a height for the hands. `position`, `orientation`: of the head in the room. */
  before(position, orientation) {
    const ahead = rotate(orientation, [0, 0, -1], [0, 0, 0]);
    const isUpright = Math.hypot(ahead[0], ahead[2]) > 0.1;
    this.yaw = isUpright ? Math.atan2(-ahead[0], -ahead[2]) : 0;
    this.#sine = Math.sin(this.yaw);
    this.#cosine = Math.cos(this.yaw);
    this.position[0] = position[0] - aheadMetres * this.#sine;
    this.position[1] = Math.min(highestMetres, Math.max(lowestMetres, position[1] - belowEyesMetres));
    this.position[2] = position[2] - aheadMetres * this.#cosine;
  }

  /** A position in the room, in the scene's frame. */
  toScene(room, into) {
    const x = room[0] - this.position[0];
    const y = room[1] - this.position[1];
    const z = room[2] - this.position[2];
    into[0] = this.#cosine * x - this.#sine * z;
    into[1] = y;
    into[2] = -(this.#sine * x + this.#cosine * z);
    return into;
  }

  /** Converts a position in the scene's frame to the room's. */
  toRoom(scene, into) {
    const x = scene[0];
    const y = scene[1];
    const z = -scene[2];
    into[0] = this.position[0] + this.#cosine * x + this.#sine * z;
    into[1] = this.position[1] + y;
    into[2] = this.position[2] - this.#sine * x + this.#cosine * z;
    return into;
  }
}
