import { tileMetres } from './fills.mjs';
import { shadingOf } from './reliefs.mjs';

const marginMetres = 0.012;
const trailLength = 40;
const spriteMarginMetres = 0.01;

/** The table from above on a canvas: x to the right, z away from the viewer. */
export class TableView {
  #canvas;
  #table;
  #looks;
  #fills;
  #context;
  /** All that rests, drawn once, below the canvas of what moves. */
  #still = document.createElement('canvas');
  /** Pictures of what moves, drawn once in the middle of a canvas of their own. @type {Map<number, HTMLCanvasElement>} */
  #sprites = new Map();
  #isStale = true;
  #scale = 1;
  /** @type {{x: number, z: number, age: number}[][]} */
  #trails = [];
  /** Index of the outlined object, -1 for none. */
  selected = -1;
  /** The relief of each surface, by the surface's name. @type {Map<string, import('./reliefs.mjs').SurfaceRelief>} */
  #reliefs = new Map();
  /** Pictures of reliefs, and what a texel of each is long. @type {WeakMap<import('./reliefs.mjs').SurfaceRelief, {picture: HTMLCanvasElement, scale: DOMMatrix}>} */
  #shadings = new WeakMap();

  /**
   * @param {HTMLCanvasElement} canvas @param {import('./table.mjs').Table} table @param {any} looks @param {import('./fills.mjs').Fills} fills
   * @param {Map<string, import('./reliefs.mjs').SurfaceRelief>} reliefs by names of surfaces
   */
  constructor(canvas, table, looks, fills, reliefs) {
    this.#reliefs = reliefs;
    this.#canvas = canvas;
    this.#table = table;
    this.#looks = looks;
    this.#fills = fills;
    this.#context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
    this.#still.className = 'still';
    this.#still.setAttribute('aria-hidden', 'true');
    canvas.before(this.#still);
    new ResizeObserver(() => this.refresh()).observe(canvas);
    matchMedia('(prefers-color-scheme: dark)').addEventListener('change', () => this.refresh());
  }

  /** Draws all anew at the next frame: a material, the size or the colours have changed. */
  refresh() {
    this.#isStale = true;
  }

  /** Shows other reliefs. @param {Map<string, import('./reliefs.mjs').SurfaceRelief>} reliefs by names of surfaces */
  setReliefs(reliefs) {
    this.#reliefs = reliefs;
    this.refresh();
  }

  #shadingOf(/** @type {import('./reliefs.mjs').SurfaceRelief} */ relief) {
    const { columns, rows, sizeMetres: [x, z] } = relief;
    const shading = this.#shadings.get(relief) ?? { picture: shadingOf(relief), scale: new DOMMatrix([x / columns, 0, 0, -z / rows, 0, 0]) };
    this.#shadings.set(relief, shading);
    return shading;
  }

  get #width() {
    return this.#table.size[0] + 2 * marginMetres;
  }

  get #depth() {
    return this.#table.size[1] + 2 * marginMetres;
  }

  /** @param {{clientX: number, clientY: number}} event */
  placeOf({ clientX, clientY }) {
    const { left, top, width, height } = this.#canvas.getBoundingClientRect();
    return { x: ((clientX - left) / width - 0.5) * this.#width, z: (0.5 - (clientY - top) / height) * this.#depth };
  }

  /** Where a place of the table is in the window. */
  pointOf(/** @type {number} */ x, /** @type {number} */ z) {
    const { left, top, width, height } = this.#canvas.getBoundingClientRect();
    return { clientX: left + (x / this.#width + 0.5) * width, clientY: top + (0.5 - z / this.#depth) * height };
  }

  #fit() {
    const ratio = Math.min(3, devicePixelRatio || 1);
    const { width } = this.#canvas.getBoundingClientRect();
    const pixels = Math.max(1, Math.round(width * ratio));
    const height = Math.round((pixels * this.#depth) / this.#width);
    if (this.#canvas.width !== pixels || this.#canvas.height !== height) {
      this.#canvas.width = pixels;
      this.#canvas.height = height;
    }
    this.#scale = pixels / this.#width;
  }

  #place(/** @type {CanvasRenderingContext2D} */ context) {
    context.setTransform(this.#scale, 0, 0, -this.#scale, this.#canvas.width / 2, this.#canvas.height / 2);
  }

  #outline(/** @type {CanvasRenderingContext2D} */ context, /** @type {import('./tops.mjs').Top} */ top, /** @type {number} */ more = 0) {
    context.beginPath();
    if (top.kind === 'box') {
      const corner = (this.#looks.surfaces[top.name]?.corner_metres ?? 0) + more;
      context.roundRect(-top.halfX - more, -top.halfZ - more, 2 * (top.halfX + more), 2 * (top.halfZ + more), corner);
    } else if (top.kind === 'sphere') {
      // As wide as it is where it leaves the desk.
      context.arc(0, 0, Math.sqrt(Math.max(0, top.radius ** 2 - top.position[1] ** 2)) + more, 0, 7);
    } else {
      const half = Math.sqrt(Math.max(0, top.radius ** 2 - top.position[1] ** 2)) + more;
      context.roundRect(-top.halfX - half, -half, 2 * (top.halfX + half), 2 * half, half);
    }
  }

  #shade(/** @type {CanvasRenderingContext2D} */ context, /** @type {import('./tops.mjs').Top} */ top, /** @type {string} */ picture) {
    if (top.kind === 'sphere') {
      const light = context.createRadialGradient(-0.013, 0.014, 0.002, 0, 0, 0.042);
      light.addColorStop(0, 'rgb(255 255 255 / 0.5)');
      light.addColorStop(0.5, 'rgb(255 255 255 / 0.06)');
      light.addColorStop(1, 'rgb(0 0 0 / 0.45)');
      context.fillStyle = light;
      context.fill();
    } else if (top.kind === 'capsule') {
      const light = context.createLinearGradient(0, -0.013, 0, 0.013);
      light.addColorStop(0, 'rgb(0 0 0 / 0.5)');
      light.addColorStop(0.62, 'rgb(255 255 255 / 0.6)');
      light.addColorStop(1, 'rgb(0 0 0 / 0.15)');
      context.fillStyle = light;
      context.fill();
    } else if (picture === 'gloss') {
      const light = context.createLinearGradient(-top.halfX, top.halfZ, top.halfX, -top.halfZ);
      light.addColorStop(0, 'rgb(255 255 255 / 0.55)');
      light.addColorStop(0.42, 'rgb(255 255 255 / 0.05)');
      light.addColorStop(0.46, 'rgb(255 255 255 / 0.35)');
      light.addColorStop(0.56, 'rgb(255 255 255 / 0.35)');
      light.addColorStop(0.6, 'rgb(255 255 255 / 0)');
      context.fillStyle = light;
      context.fill();
    }
  }

  #object(/** @type {CanvasRenderingContext2D} */ context, /** @type {number} */ index, /** @type {boolean} */ isSprite = false) {
    const top = this.#table.tops[index];
    const material = this.#table.materials[index];
    const isDesk = index === 0;
    const pixel = 1 / this.#scale;
    this.#place(context);
    if (!isSprite) context.translate(top.position[0], top.position[2]);
    context.transform(top.cos, -top.sin, top.sin, top.cos, 0, 0);
    this.#outline(context, top);
    const rise = top.kind === 'box' ? top.position[1] + top.halfHeight : 0.006;
    context.save();
    context.shadowColor = isDesk ? 'rgb(0 0 0 / 0.28)' : 'rgb(40 22 8 / 0.5)';
    context.shadowBlur = (isDesk ? 0.008 : 0.0015 + 0.9 * rise) * this.#scale;
    context.shadowOffsetX = (isDesk ? 0 : 0.35 * rise) * this.#scale;
    context.shadowOffsetY = (isDesk ? 0.003 : 0.5 * rise) * this.#scale;
    const pattern = /** @type {CanvasPattern} */ (context.createPattern(this.#fills.tile(material), 'repeat'));
    const tile = tileMetres / 256;
    pattern.setTransform(new DOMMatrix([tile, 0, 0, -tile, 0, 0]));
    context.fillStyle = pattern;
    context.fill();
    context.restore();
    const main = typeof material === 'string' ? material : Object.entries(material).sort((a, b) => b[1] - a[1])[0][0];
    this.#shade(context, top, this.#fills.look(main).picture);
    this.#drawRelief(context, top.name);
    if (!isDesk) {
      context.lineWidth = pixel;
      context.strokeStyle = 'rgb(255 255 255 / 0.35)';
      context.stroke();
    }
  }

  /** Fills the outline with the light and shade of its heights. */
  #drawRelief(/** @type {CanvasRenderingContext2D} */ context, /** @type {string} */ name) {
    const relief = this.#reliefs.get(name);
    if (!relief) return;
    const shading = this.#shadingOf(relief);
    const pattern = /** @type {CanvasPattern} */ (context.createPattern(shading.picture, 'repeat'));
    pattern.setTransform(shading.scale);
    context.fillStyle = pattern;
    context.fill();
  }

  #drawStill() {
    this.#still.width = this.#canvas.width;
    this.#still.height = this.#canvas.height;
    const context = /** @type {CanvasRenderingContext2D} */ (this.#still.getContext('2d'));
    this.#table.tops.forEach((top, index) => {
      if (!top.isMoving) this.#object(context, index);
      else this.#drawSprite(index);
    });
    this.#isStale = false;
  }

  #drawSprite(/** @type {number} */ index) {
    const sprite = document.createElement('canvas');
    sprite.width = this.#canvas.width;
    sprite.height = this.#canvas.height;
    this.#object(/** @type {CanvasRenderingContext2D} */ (sprite.getContext('2d')), index, true);
    this.#sprites.set(index, sprite);
  }

  #drawMoving(/** @type {CanvasRenderingContext2D} */ context, /** @type {number} */ index) {
    const { position, halfX, halfZ, radius } = this.#table.tops[index];
    const sprite = this.#sprites.get(index);
    if (!sprite) return;
    const half = Math.ceil((Math.hypot(halfX, halfZ) + radius + spriteMarginMetres) * this.#scale);
    const [left, top] = [Math.round(sprite.width / 2) - half, Math.round(sprite.height / 2) - half];
    context.drawImage(sprite, left, top, 2 * half, 2 * half, left + position[0] * this.#scale, top - position[2] * this.#scale, 2 * half, 2 * half);
  }

  /**
   * @param {number} timeSeconds
   * @param {{x: number, z: number, forceNewtons: number, isDown: boolean, lean: readonly number[] | null}[]} tips
   */
  draw(timeSeconds, tips) {
    this.#fit();
    if (this.#isStale || this.#still.width !== this.#canvas.width) this.#drawStill();
    this.#table.moveTo(timeSeconds);
    const context = this.#context;
    context.setTransform(1, 0, 0, 1, 0, 0);
    context.clearRect(0, 0, this.#canvas.width, this.#canvas.height);
    this.#table.tops.forEach((top, index) => {
      if (top.isMoving) this.#drawMoving(context, index);
    });
    if (this.selected > 0) this.#drawSelection(context);
    tips.forEach((tip, index) => this.#drawTip(context, tip, index));
  }

  #drawSelection(/** @type {CanvasRenderingContext2D} */ context) {
    const top = this.#table.tops[this.selected];
    this.#place(context);
    context.translate(top.position[0], top.position[2]);
    context.transform(top.cos, -top.sin, top.sin, top.cos, 0, 0);
    this.#outline(context, top, 0.0025);
    context.lineWidth = 0.0012;
    context.strokeStyle = '#fff';
    context.stroke();
  }

  #drawTip(/** @type {CanvasRenderingContext2D} */ context, /** @type {{x: number, z: number, forceNewtons: number, isDown: boolean, lean: readonly number[] | null}} */ tip, /** @type {number} */ index) {
    const trail = (this.#trails[index] ??= []);
    this.#place(context);
    if (tip.isDown) trail.push({ x: tip.x, z: tip.z, age: 0 });
    else trail.length = 0;
    if (trail.length > trailLength) trail.shift();
    context.lineCap = 'butt';
    for (let at = 1; at < trail.length; at += 1) {
      context.beginPath();
      context.moveTo(trail[at - 1].x, trail[at - 1].z);
      context.lineTo(trail[at].x, trail[at].z);
      const share = at / trailLength;
      for (const [width, colour] of /** @type {[number, string][]} */ ([[0.0045, `rgb(30 34 38 / ${0.22 * share})`], [0.0028, `rgb(255 255 255 / ${0.8 * share})`]])) {
        context.lineWidth = width;
        context.strokeStyle = colour;
        context.stroke();
      }
    }
    if (!tip.isDown) return;
    if (tip.lean) {
      context.beginPath();
      context.moveTo(tip.x, tip.z);
      context.lineTo(tip.x + 0.06 * tip.lean[0], tip.z + 0.06 * tip.lean[1]);
      context.lineWidth = 0.003;
      context.strokeStyle = 'rgb(20 24 28 / 0.6)';
      context.stroke();
    }
    const ring = 0.004 + 0.007 * (tip.forceNewtons / 2);
    context.beginPath();
    context.arc(tip.x, tip.z, ring, 0, 7);
    context.fillStyle = 'rgb(255 255 255 / 0.28)';
    context.fill();
    context.lineWidth = 0.0022;
    context.strokeStyle = 'rgb(30 34 38 / 0.35)';
    context.stroke();
    context.lineWidth = 0.001;
    context.strokeStyle = 'rgb(255 255 255 / 0.9)';
    context.stroke();
    context.beginPath();
    context.arc(tip.x, tip.z, 0.0026, 0, 7);
    context.fillStyle = '#0f5f5a';
    context.fill();
    context.stroke();
  }
}
