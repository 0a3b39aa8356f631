import { highestAt, topOf } from './tops.mjs';

const deepestMetres = 0.0008;
const softestNewtonsPerMetre = 50;
/** Height of a tip in the air above all objects. */
export const airMetres = 0.06;

/** The objects, their present materials, and where a tip is that presses on them from above. */
export class Table {
  #labels = new Map();
  /** @type {import('../../engine/js/haptoflow.d.ts').Scene | null} */
  #poses = null;
  #tip = { index: -1, positionMetres: [0, 0, 0] };

  /** @param {any} scene SCENE.json */
  constructor(scene) {
    this.scene = scene;
    this.tops = scene.surfaces.map(topOf);
    /** @type {any[]} */
    this.materials = scene.surfaces.map((/** @type {any} */ surface) => surface.material);
    this.tipRadius = scene.stylus.tip_radius;
    const [sizeX, , sizeZ] = scene.surfaces[0].shape.box.size;
    /** Of the first surface, on which all others lie. */
    this.size = [sizeX, sizeZ];
  }

  /** @param {readonly import('../../engine/js/haptoflow.d.ts').Label[]} labels */
  setLabels(labels) {
    this.#labels = new Map(labels.map((label) => [label.name, label]));
  }

  /** @param {number} index */
  stiffness(index) {
    const material = this.materials[index];
    const weights = typeof material === 'string' ? { [material]: 1 } : material;
    let sum = 0;
    let total = 0;
    for (const name in weights) {
      sum += weights[name] * (this.#labels.get(name)?.stiffnessNewtonsPerMetre ?? 1000);
      total += weights[name];
    }
    return Math.max(softestNewtonsPerMetre, sum / total);
  }

  /** What moves rests until the engine says where it is. @param {import('../../engine/js/haptoflow.d.ts').Scene} scene of the same surfaces */
  follow(scene) {
    this.#poses = scene;
  }

  /** @param {number} timeSeconds */
  moveTo(timeSeconds) {
    for (let index = 0; index < this.tops.length; index += 1) {
      if (this.tops[index].isMoving) this.#poses?.poseOf(index, timeSeconds, this.tops[index]);
    }
  }

  /** Index of the object at a place, -1 beside the table. */
  at(/** @type {number} */ x, /** @type {number} */ z) {
    return highestAt(this.tops, x, z, 1e-6).index;
  }

  /**
   * Where a tip is that presses with a force at (x, z). The same object at every call.
   * @param {number} timeSeconds @param {number} x @param {number} z @param {number} forceNewtons
   */
  pressed(timeSeconds, x, z, forceNewtons) {
    this.moveTo(timeSeconds);
    const tip = this.#tip;
    const found = highestAt(this.tops, x, z, this.tipRadius);
    tip.index = found.index;
    const depth = found.index < 0 ? 0 : Math.min(deepestMetres, forceNewtons / this.stiffness(found.index));
    const lower = found.index < 0 ? airMetres : highestAt(this.tops, x, z, this.tipRadius - depth).height;
    tip.positionMetres[0] = x;
    // Beyond a rim the smaller sphere may find a lower object only.
    tip.positionMetres[1] = Math.max(lower, found.index < 0 ? airMetres : found.height - 2 * depth);
    tip.positionMetres[2] = z;
    return tip;
  }

  /** SCENE.json with the present materials. */
  sceneNow() {
    return { ...this.scene, surfaces: this.scene.surfaces.map((/** @type {any} */ surface, /** @type {number} */ index) => ({ ...surface, material: this.materials[index] })) };
  }
}
