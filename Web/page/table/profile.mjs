import { find } from '../dom.mjs';
import { heightAt } from './reliefs.mjs';

const reachMetres = 0.02;
const stepMetres = 0.00025;
const steps = Math.round(reachMetres / stepMetres);
const stillMps = 0.003;
const leastRangeMetres = 0.0003;

/**
 * The heights along a stroke: those that the tip has passed, from -1, and those ahead of it if it goes straight on, up to 1. A frame
 * allocates nothing.
 */
export class StrokeHeights {
  /** The middle one is under the tip. */
  heightsMetres = new Float32Array(2 * steps + 1);
  /** @type {import('../../engine/js/haptoflow.d.ts').Relief | null} */
  #relief = null;
  #surface = -1;
  #place = [0, 0];
  /** Change of the place in the map with each metre of the way. */
  #ahead = [0, 0];

  /** Follows the contact of a frame. Returns whether there are heights. @param {import('../../engine/js/haptoflow.d.ts').SceneContact | null} contact */
  follow(contact) {
    const relief = contact?.touching ? contact.relief : null;
    if (!relief || !contact) {
      this.#relief = null;
      return false;
    }
    const velocity = /** @type {readonly number[]} */ (contact.velocityMps);
    const place = /** @type {readonly number[]} */ (contact.reliefPlace);
    const speed = Math.hypot(velocity[0], velocity[1]);
    const isNew = this.#relief !== relief || this.#surface !== contact.surfaceIndex;
    for (let side = 0; side < 2; side += 1) {
      // Maps lie along the axes of the velocity.
      if (speed > stillMps) this.#ahead[side] = velocity[side] / speed / relief.sizeMetres[side];
      else if (isNew) this.#ahead[side] = side === 0 ? 1 / relief.sizeMetres[0] : 0;
    }
    if (isNew) this.#begin(relief, contact.surfaceIndex, place);
    else this.#goTo(place);
    for (let step = 0; step <= steps; step += 1) this.heightsMetres[steps + step] = this.#height(step * stepMetres);
    return true;
  }

  #height(/** @type {number} */ metres) {
    return heightAt(/** @type {any} */ (this.#relief), this.#place[0] + metres * this.#ahead[0], this.#place[1] + metres * this.#ahead[1]);
  }

  #begin(/** @type {import('../../engine/js/haptoflow.d.ts').Relief} */ relief, /** @type {number} */ surface, /** @type {readonly number[]} */ place) {
    this.#relief = relief;
    this.#surface = surface;
    for (let side = 0; side < 2; side += 1) this.#place[side] = place[side];
    for (let step = 0; step < steps; step += 1) this.heightsMetres[step] = this.#height((step - steps) * stepMetres);
  }

  /** Takes the way to a place into what was passed, step by step. */
  #goTo(/** @type {readonly number[]} */ place) {
    const relief = /** @type {import('../../engine/js/haptoflow.d.ts').Relief} */ (this.#relief);
    const u = place[0] - this.#place[0];
    const v = place[1] - this.#place[1];
    const metres = Math.hypot(u * relief.sizeMetres[0], v * relief.sizeMetres[1]);
    const taken = Math.min(steps, Math.floor(metres / stepMetres));
    for (let step = 0; step < taken; step += 1) {
      this.heightsMetres.copyWithin(0, 1, steps);
      this.heightsMetres[steps - 1] = heightAt(relief, this.#place[0], this.#place[1]);
      this.#place[0] += (u * stepMetres) / metres;
      this.#place[1] += (v * stepMetres) / metres;
    }
    // What is further away than the picture reaches was a leap.
    if (metres > reachMetres) this.#begin(relief, this.#surface, place);
  }
}

/** Draws the heights along the stroke while the tip is on a relief. */
export class ProfileView {
  heights = new StrokeHeights();
  #canvas = find('#profile');
  #context = this.#canvas.getContext('2d');
  #colour = '';

  /** @param {import('../../engine/js/haptoflow.d.ts').SceneContact | null} contact */
  frame(contact) {
    const isShown = this.heights.follow(contact);
    if (this.#canvas.hidden !== !isShown) {
      this.#canvas.hidden = !isShown;
      this.#colour = getComputedStyle(this.#canvas).color;
    }
    if (isShown) this.#draw(/** @type {any} */ (contact).relief.depthMetres);
  }

  #draw(/** @type {number} */ depthMetres) {
    const { width, height } = this.#canvas;
    const context = this.#context;
    const { heightsMetres } = this.heights;
    const range = Math.max(leastRangeMetres, depthMetres);
    context.clearRect(0, 0, width, height);
    context.strokeStyle = this.#colour;
    context.fillStyle = this.#colour;
    context.lineWidth = 3;
    context.beginPath();
    for (let index = 0; index < heightsMetres.length; index += 1) {
      context.lineTo((index * width) / (heightsMetres.length - 1), height - 4 - (heightsMetres[index] / range) * (height - 22));
    }
    context.stroke();
    context.beginPath();
    context.arc(width / 2, height - 4 - (heightsMetres[steps] / range) * (height - 22) - 8, 7, 0, 7);
    context.fill();
  }
}
