import { materialWords } from '../messages.mjs';
import { airMetres } from './table.mjs';

// One tip: places and forces go in, contact states go to its voice, and rows to a recording.

const approachSeconds = 0.03;
const approachMps = 0.15;
const holdAfterSeconds = 0.02;
const airSeconds = 0.1;

/** @typedef {{timeSeconds: number, x: number, z: number, forceNewtons: number, orientation?: number[] | null}} TipPlace */

export class Tip {
  #table;
  #scene;
  #last = -Infinity;
  /** @type {TipPlace} */
  place = { timeSeconds: 0, x: 0, z: 0, forceNewtons: 0, orientation: null };
  isDown = false;
  /** The stroke that is being recorded; null while none is. @type {import('../recorder.mjs').StrokeRow[] | null} */
  rows = null;
  /** Materials that it has touched since somebody emptied this. @type {Set<string>} */
  touched = new Set();
  /** @type {import('../../engine/js/haptoflow.d.ts').SceneContact | null} */
  contact = null;
  /** Who holds the tip: a pointer's number, "keys" or "preset". @type {number | string | null} */
  holder = null;

  /** @param {import('./table.mjs').Table} table @param {import('../../engine/js/haptoflow.d.ts').Voice} voice @param {import('../../engine/js/haptoflow.d.ts').Scene} scene */
  constructor(table, voice, scene) {
    this.#table = table;
    this.voice = voice;
    this.#scene = scene;
  }

  #put(/** @type {number} */ timeSeconds, /** @type {readonly number[]} */ position, /** @type {number} */ forceNewtons, /** @type {number[] | null} */ orientation, /** @type {boolean} */ publishes) {
    this.#last = Math.max(this.#last, timeSeconds);
    const sample = { timeSeconds: this.#last, positionMetres: /** @type {[number, number, number]} */ (position), forceNewtons };
    this.contact = publishes ? this.#scene.publish(this.voice, sample) : this.#scene.update(sample);
    if (publishes && this.contact.touching && this.contact.material !== undefined) this.touched.add(materialWords(this.contact.material));
    this.rows?.push({ ...sample, positionMetres: [...position], orientation });
  }

  /** Speed along the surface, of the newest contact. */
  get speedMps() {
    return this.contact?.touching ? Math.hypot(...(this.contact.velocityMps ?? [0, 0])) : 0;
  }

  /** Lands at a place, from above. @param {TipPlace} place */
  begin(place) {
    const { timeSeconds, x, z, orientation = null } = place;
    if (this.isDown) this.end(timeSeconds);
    this.isDown = true;
    const { positionMetres } = this.#table.pressed(timeSeconds, x, z, place.forceNewtons);
    const landing = positionMetres[1];
    if (this.#last < timeSeconds - airSeconds) this.#put(timeSeconds - airSeconds, [x, airMetres, z], 0, orientation, false);
    for (const before of [2, 1]) {
      const seconds = (before * approachSeconds) / 2;
      if (this.#last < timeSeconds - seconds) this.#put(timeSeconds - seconds, [x, landing + seconds * approachMps + this.#table.tipRadius, z], 0, orientation, false);
    }
    this.move(place, true);
  }

  /** @param {TipPlace} place @param {boolean} publishes false for places that a newer one follows at once */
  move(place, publishes = true) {
    if (!this.isDown || (place.timeSeconds <= this.#last && !publishes)) return;
    const { timeSeconds, x, z, forceNewtons, orientation = null } = place;
    Object.assign(this.place, { timeSeconds, x, z, forceNewtons, orientation });
    const { index, positionMetres } = this.#table.pressed(timeSeconds, x, z, forceNewtons);
    this.#put(timeSeconds, positionMetres, index < 0 ? 0 : forceNewtons, orientation, publishes);
  }

  /** Publishes a tip that no event has moved for a while: what it touches may move. @param {number} timeSeconds @param {number} forceNewtons */
  hold(timeSeconds, forceNewtons) {
    if (this.isDown && timeSeconds > this.#last + holdAfterSeconds) this.move({ ...this.place, timeSeconds, forceNewtons });
  }

  /** @param {number} timeSeconds */
  end(timeSeconds) {
    if (!this.isDown) return;
    this.isDown = false;
    this.#put(timeSeconds, [this.place.x, airMetres, this.place.z], 0, this.place.orientation ?? null, true);
    this.voice.lift();
  }

  /** Another material for a surface. */
  setMaterial(/** @type {number} */ surface, /** @type {any} */ material) {
    this.#scene.setSurface(surface, { material });
  }
}
