// Heights of surfaces that have gaps, joints or letters. The tables that draw them and the engine that lets them be felt read the
// same map, of the numbers in looks.json.

const texelsPerWidth = 8;
/** Letters as lines, in units of their height, x to the right and y up. @type {Record<string, number[][]>} */
const letters = {
  E: [[0.55, 1, 0, 1], [0, 1, 0, 0], [0, 0, 0.55, 0], [0, 0.5, 0.45, 0.5]],
  F: [[0.55, 1, 0, 1], [0, 1, 0, 0], [0, 0.5, 0.45, 0.5]],
  L: [[0, 1, 0, 0], [0, 0, 0.55, 0]],
};
const letterPitch = 0.85;
const letterWidth = 0.55;

/**
 * @typedef {object} ReliefLook metres all; either grooves or a word
 * @property {{every_metres: [number, number], first_metres: [number, number], width_metres: number}} [grooves] straight across x and
 *   across z of the surface, one of them at `first_metres` from its middle; 0 for none
 * @property {{text: string, height_metres: number, width_metres: number}} [word] raised, in the middle of the surface
 * @property {number} depth_metres
 * @property {number} share of the engine's full scale, which the relief may reach
 */
/** @typedef {Required<import('../../engine/js/haptoflow.d.ts').ReliefOptions> & {surfaceMetres: number, share: number}} SurfaceRelief `surfaceMetres`: the height of what is plain */

/** From 1 in a line's middle to 0 beyond half its width, with round shoulders. */
function shoulder(/** @type {number} */ distance, /** @type {number} */ width) {
  const share = Math.min(1, Math.max(0, (width / 2 - distance) / (width / 4)));
  return share * share * (3 - 2 * share);
}

function distanceToLine(/** @type {number} */ x, /** @type {number} */ z, /** @type {number[]} */ line) {
  const [ax, az, bx, bz] = line;
  const [dx, dz] = [bx - ax, bz - az];
  const share = Math.min(1, Math.max(0, ((x - ax) * dx + (z - az) * dz) / (dx * dx + dz * dz)));
  const [besideX, besideZ] = [x - ax - share * dx, z - az - share * dz];
  return Math.sqrt(besideX * besideX + besideZ * besideZ);
}

/** Lines of a word's letters, its middle at 0. */
function linesOf(/** @type {{text: string, height_metres: number}} */ { text, height_metres: height }) {
  const half = (letterPitch * (text.length - 1) + letterWidth) / 2;
  return [...text].flatMap((letter, index) => {
    const lines = letters[letter];
    if (!lines) throw new Error(`relief: no letter "${letter}"`);
    return lines.map((line) => line.map((part, at) => height * (part + (at % 2 === 0 ? letterPitch * index - half : -0.5))));
  });
}

/** Distance of a place from the nearest of lines that repeat. */
const distanceToGroove = (/** @type {number} */ x, /** @type {number} */ every, /** @type {number} */ first) =>
  (every === 0 ? Infinity : Math.abs(x - first - every * Math.round((x - first) / every)));

/** The height function of a look, the map's lengths, and the length of a texel. */
function shapeOf(/** @type {ReliefLook} */ { grooves, word, depth_metres: depth }, /** @type {[number, number]} */ surfaceSize) {
  const texelMetres = ((word ?? grooves)?.width_metres ?? NaN) / texelsPerWidth;
  if (word) {
    const lines = linesOf(word);
    const height = (/** @type {number} */ x, /** @type {number} */ z) =>
      depth * shoulder(lines.reduce((nearest, line) => Math.min(nearest, distanceToLine(x, z, line)), Infinity), word.width_metres);
    return { height, size: surfaceSize, texelMetres, surfaceMetres: 0 };
  }
  if (!grooves) throw new Error('relief: expected "grooves" or "word"');
  const { every_metres: every, first_metres: first, width_metres: width } = grooves;
  const height = (/** @type {number} */ x, /** @type {number} */ z) =>
    depth * (1 - Math.max(shoulder(distanceToGroove(x, every[0], first[0]), width), shoulder(distanceToGroove(z, every[1], first[1]), width)));
  // Where nothing changes along an axis, one texel is enough.
  return { height, size: every.map((metres) => metres || texelMetres), texelMetres, surfaceMetres: depth };
}

/**
 * The map of a look on a surface: x along its columns, -z along its rows, as the contact model's axes lie on an upper face; both are 0
 * in the surface's middle.
 * @param {ReliefLook} look @param {[number, number]} surfaceSize along x and z @param {number} tipRadiusMetres
 * @returns {SurfaceRelief}
 */
export function reliefOf(look, surfaceSize, tipRadiusMetres) {
  const { height, size, texelMetres, surfaceMetres } = shapeOf(look, surfaceSize);
  const [columns, rows] = size.map((metres) => Math.max(1, Math.round(metres / texelMetres)));
  const heightsMetres = new Float32Array(columns * rows);
  // The map goes on at its rims, so that its second half lies on the other side of the middle.
  const placeOf = (/** @type {number} */ index, /** @type {number} */ count, /** @type {number} */ metres) => (((index + 0.5) / count + 0.5) % 1 - 0.5) * metres;
  for (let row = 0; row < rows; row += 1) {
    const z = -placeOf(row, rows, size[1]);
    for (let column = 0; column < columns; column += 1) heightsMetres[row * columns + column] = height(placeOf(column, columns, size[0]), z);
  }
  return { columns, rows, heightsMetres, sizeMetres: [size[0], size[1]], depthMetres: look.depth_metres, tipRadiusMetres, isTiled: true, surfaceMetres, share: look.share };
}

const wrapped = (/** @type {number} */ index, /** @type {number} */ count) => ((index % count) + count) % count;

const texel = (/** @type {import('../../engine/js/haptoflow.d.ts').ReliefOptions} */ { columns, rows, heightsMetres }, /** @type {number} */ column, /** @type {number} */ row) =>
  heightsMetres[wrapped(row, rows) * columns + wrapped(column, columns)];

/** Height at a place of a tiled map, 0 to 1 over it. @param {import('../../engine/js/haptoflow.d.ts').ReliefOptions} relief @param {number} u @param {number} v */
export function heightAt(relief, u, v) {
  const x = u * relief.columns - 0.5;
  const y = v * relief.rows - 0.5;
  const left = Math.floor(x);
  const top = Math.floor(y);
  const above = texel(relief, left, top) + (x - left) * (texel(relief, left + 1, top) - texel(relief, left, top));
  const below = texel(relief, left, top + 1) + (x - left) * (texel(relief, left + 1, top + 1) - texel(relief, left, top + 1));
  return above + (y - top) * (below - above);
}

/** Light from the far left on the heights, as a picture to lay over the surface: its rows lead to negative z. */
export function shadingOf(/** @type {SurfaceRelief} */ relief) {
  const { columns, rows, sizeMetres, depthMetres, surfaceMetres } = relief;
  const canvas = document.createElement('canvas');
  Object.assign(canvas, { width: columns, height: rows });
  const context = /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  const image = context.createImageData(columns, rows);
  const at = (/** @type {number} */ column, /** @type {number} */ row) => texel(relief, column, row);
  for (let row = 0; row < rows; row += 1) {
    for (let column = 0; column < columns; column += 1) {
      const alongX = ((at(column + 1, row) - at(column - 1, row)) * columns) / (2 * sizeMetres[0]);
      const alongZ = ((at(column, row - 1) - at(column, row + 1)) * rows) / (2 * sizeMetres[1]);
      const hollow = Math.max(0, surfaceMetres - at(column, row)) / depthMetres;
      const light = 0.55 * alongX - 0.75 * alongZ - 0.45 * hollow;
      const alpha = 4 * (row * columns + column) + 3;
      image.data.fill(light > 0 ? 255 : 0, alpha - 3, alpha);
      image.data[alpha] = 255 * Math.min(0.75, Math.abs(light));
    }
  }
  context.putImageData(image, 0, 0);
  return canvas;
}

/**
 * The reliefs of a scene's surfaces, by their names.
 * @param {any} scene SCENE.json @param {any} looks looks.json
 * @returns {Map<string, SurfaceRelief>}
 */
export function reliefsOf(scene, looks) {
  /** @type {Map<string, SurfaceRelief>} */
  const made = new Map();
  /** @type {Map<string, SurfaceRelief>} */
  const found = new Map();
  for (const { name, shape } of scene.surfaces) {
    const look = looks.surfaces?.[name]?.relief;
    if (!look) continue;
    const [x, , z] = shape.box.size;
    // Surfaces that look alike share a map.
    const key = JSON.stringify([look, x, z]);
    if (!made.has(key)) made.set(key, reliefOf(look, [x, z], scene.stylus.tip_radius));
    found.set(name, /** @type {SurfaceRelief} */ (made.get(key)));
  }
  return found;
}

/** The image with its middle at the corner, which lies in the middle of a surface. @param {import('../../engine/js/haptoflow.d.ts').ReliefImage} image */
function rolled({ width, height, data }) {
  const turned = data.slice();
  const [left, top] = [Math.floor(width / 2), Math.floor(height / 2)];
  for (let row = 0; row < height; row += 1) {
    const from = 4 * width * ((row + top) % height);
    const to = 4 * width * row;
    turned.set(data.subarray(from + 4 * left, from + 4 * width), to);
    turned.set(data.subarray(from, from + 4 * left), to + 4 * (width - left));
  }
  return { width, height, data: turned };
}

/** @typedef {{scene: any, files: Map<string, () => Promise<Uint8Array>>, reliefs: Record<string, SurfaceRelief>}} SceneWithReliefs files: PNG by name; reliefs by surface */

/** The reliefs of a table's surfaces, drawn and felt: those of its looks, and pictures in their place. */
export class TableReliefs {
  #haptics;
  #own;
  #tipRadius;
  /** In the engine, by what is drawn. @type {Map<SurfaceRelief, import('../../engine/js/haptoflow.d.ts').Relief>} */
  #made = new Map();
  /** The relief of each surface, by the surface's name. @type {Map<string, SurfaceRelief>} */
  #pictures = new Map();
  /** @type {import('../../engine/js/haptoflow.d.ts').Scene[]} */
  #scenes = [];
  /** How often a picture was laid or taken off. */
  changes = 0;
  onChange = () => {};

  /** @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {Map<string, SurfaceRelief>} own by names of surfaces @param {number} tipRadius */
  constructor(haptics, own, tipRadius) {
    this.#haptics = haptics;
    this.#own = own;
    this.#tipRadius = tipRadius;
  }

  /** Makes those of the looks in the engine. */
  async start() {
    for (const relief of new Set(this.#own.values())) this.#made.set(relief, await this.#haptics.createRelief(relief));
  }

  /** What lies on each surface now. */
  get present() {
    return new Map([...this.#own, ...this.#pictures]);
  }

  hasPicture(/** @type {string} */ name) {
    return this.#pictures.has(name);
  }

  /** Lays them on a contact scene of the same surfaces. */
  lay = (/** @type {import('../../engine/js/haptoflow.d.ts').Scene} */ scene) => {
    for (const name of this.present.keys()) this.#layOne(scene, name);
  };

  /** Lays them on a scene, also those that come later. @param {import('../../engine/js/haptoflow.d.ts').Scene} scene */
  follow(scene) {
    this.#scenes.push(scene);
    this.lay(scene);
  }

  #layOne(/** @type {import('../../engine/js/haptoflow.d.ts').Scene} */ scene, /** @type {string} */ name) {
    const relief = this.#pictures.get(name) ?? this.#own.get(name);
    scene.setRelief(name, relief ? /** @type {any} */ (this.#made.get(relief)) : null, relief && { share: relief.share });
  }

  /**
   * Lays a picture on a surface, its middle in the surface's middle; it goes on beyond its rims.
   * @param {string} name @param {import('../../engine/js/haptoflow.d.ts').ReliefImage} image
   * @param {{isNormalMap: boolean, sizeMetres: [number, number], depthMetres: number, share: number}} options
   * @returns {Promise<SurfaceRelief>}
   */
  async put(name, image, { share, ...options }) {
    const made = await this.#haptics.createRelief({ ...options, image: rolled(image), tipRadiusMetres: this.#tipRadius });
    const { columns, rows, heightsMetres, sizeMetres, depthMetres, tipRadiusMetres, isTiled } = made;
    const relief = { columns, rows, heightsMetres, sizeMetres, depthMetres, tipRadiusMetres, isTiled, share, surfaceMetres: heightsMetres.reduce((most, height) => Math.max(most, height), 0) };
    this.#made.set(relief, made);
    this.#exchange(name, relief);
    return relief;
  }

  /** Takes the picture off; the surface then has what it had at first. @param {string} name */
  remove(name) {
    this.#exchange(name, null);
  }

  #exchange(/** @type {string} */ name, /** @type {SurfaceRelief | null} */ relief) {
    const before = this.#pictures.get(name);
    if (relief) this.#pictures.set(name, relief);
    else this.#pictures.delete(name);
    for (const scene of this.#scenes) this.#layOne(scene, name);
    // Only now, so that a tip on it goes over to the next one.
    if (before) {
      this.#made.get(before)?.destroy();
      this.#made.delete(before);
    }
    this.changes += 1;
    this.onChange();
  }

  /**
   * A scene with all of them as files, for the command line.
   * @param {any} scene SCENE.json
   * @returns {SceneWithReliefs}
   */
  withFiles(scene) {
    const { present } = this;
    /** @type {Map<SurfaceRelief, string>} */
    const names = new Map();
    for (const [surface, relief] of present) if (!names.has(relief)) names.set(relief, `relief-${surface.replaceAll(/[^a-z0-9]+/gi, '-')}.png`);
    const files = new Map([...names].map(([relief, file]) => {
      const made = this.#made.get(relief);
      return /** @type {const} */ ([file, () => /** @type {any} */ (made).png()]);
    }));
    const surfaces = scene.surfaces.map((/** @type {any} */ surface) => {
      const relief = present.get(surface.name);
      if (!relief) return surface;
      return { ...surface, relief: { image: names.get(relief), size: relief.sizeMetres, depth: relief.depthMetres, share: relief.share } };
    });
    return { scene: { ...scene, surfaces }, files, reliefs: Object.fromEntries(present) };
  }
}
