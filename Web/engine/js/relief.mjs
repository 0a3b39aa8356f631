import { HaptoFlowError } from './errors.mjs';
import { encodePng } from './png.mjs';

/** As in scene files. */
export const usualShare = 0.5;
/** The engine's limit. */
export const mostTexels = 3 * 2 ** 20;
const penTipMetres = 0.0005;

/** Heights that a tip follows; see haptoflow.d.ts. */
export class Relief {
  #destroy;

  /**
   * Use `HaptoFlow.createRelief`.
   * @param {import('./haptoflow.d.ts').ReliefOptions} options
   * @param {number} number by which states name it; the engine that plays it may have another
   * @param {(relief: Relief) => void} destroy
   */
  constructor({ columns, rows, heightsMetres, sizeMetres, depthMetres, tipRadiusMetres, isTiled }, number, destroy) {
    this.columns = columns;
    this.rows = rows;
    this.heightsMetres = heightsMetres;
    this.sizeMetres = sizeMetres;
    this.depthMetres = depthMetres;
    this.tipRadiusMetres = tipRadiusMetres;
    this.isTiled = isTiled;
    this.number = number;
    this.#destroy = destroy;
  }

  /** See haptoflow.d.ts. */
  async png() {
    const { columns, rows, heightsMetres, depthMetres } = this;
    return encodePng(columns, rows, Uint16Array.from(heightsMetres, (height) => Math.round(65535 * Math.min(1, Math.max(0, height / depthMetres)))));
  }

  destroy() {
    this.#destroy(this);
  }
}

/** What numbers of an image's kind stand for 1; 0 where they are no image's. */
function wholeOf(/** @type {unknown} */ data) {
  if (data instanceof Uint8Array || data instanceof Uint8ClampedArray) return 255;
  if (data instanceof Uint16Array) return 65535;
  return data instanceof Float32Array ? 1 : 0;
}

/**
 * @param {number} width @param {number} height @param {string} name for messages
 * @throws HaptoFlowError "input" for a size that no relief may have
 */
export function requireTexels(width, height, name) {
  if (width * height > mostTexels) {
    throw new HaptoFlowError('input', `${name}: ${width} x ${height} texels; a relief has at most ${mostTexels}, such as 2048 x 1536. Make the image smaller`);
  }
}

/**
 * @param {import('./haptoflow.d.ts').ReliefImage} image @param {string} name for messages
 * @throws HaptoFlowError "invalid-argument" or "input"
 */
export function requireImage({ width, height, data }, name) {
  if (wholeOf(data) === 0) throw new HaptoFlowError('invalid-argument', `${name}: expected width, height and data, a Uint8ClampedArray, Uint16Array or Float32Array, as decodePng gives them`);
  if (![width, height].every((count) => Number.isInteger(count) && count > 0) || data.length !== 4 * width * height) {
    throw new HaptoFlowError('invalid-argument', `${name}: ${data.length} numbers for ${width} x ${height} pixels; expected four for each: red, green, blue and opacity`);
  }
  requireTexels(width, height, name);
}

// In single precision and in the order of NativePlugin/cli/scene_reliefs.cpp, so that the heights are the same to the last bit.
const single = Math.fround;

/** Heights from black, 0, to white, 1. @param {import('./haptoflow.d.ts').ReliefImage} image */
function heightsOf({ width, height, data }) {
  const whole = wholeOf(data);
  const part = (/** @type {number} */ at) => single(data[at] / whole);
  return Float32Array.from({ length: width * height }, (_, index) => single(single(part(4 * index) + part(4 * index + 1)) + part(4 * index + 2)) / 3);
}

/** Three numbers for each texel: along the columns, along the rows, outwards. @param {import('./haptoflow.d.ts').ReliefImage} image */
function normalsOf({ width, height, data }) {
  const whole = wholeOf(data);
  const part = (/** @type {number} */ at) => 2 * single(data[at] / whole) - 1;
  const normals = new Float32Array(3 * width * height);
  for (let index = 0; index < width * height; index += 1) {
    normals[3 * index] = part(4 * index);
    // Green leads up the image, and rows lead down.
    normals[3 * index + 1] = -part(4 * index + 1);
    normals[3 * index + 2] = part(4 * index + 2);
  }
  return normals;
}

/**
 * Integrates normals. Takes a second for 10^6 texels.
 * @param {import('./module.mjs').Core} core with a large memory
 * @param {NormalMap} map
 * @returns {Float32Array} of which the lowest is 0
 */
export function heightsOfNormals(core, { columns, rows, normals, sizeMetres: [along, across], isTiled }) {
  const from = core.copyIn(new Uint8Array(normals.buffer));
  const to = core.allocate(4 * columns * rows);
  try {
    core.call('hapto_relief_heights_of_normals', from, columns, rows, isTiled ? 1 : 0, along, across, to);
    return core.f32.slice(to >> 2, (to >> 2) + columns * rows);
  } finally {
    core.free(from);
    core.free(to);
  }
}

/** @typedef {{columns: number, rows: number, normals: Float32Array, sizeMetres: readonly [number, number], isTiled: boolean}} NormalMap */

/**
 * What is to be integrated before a relief can be made; null for one of heights.
 * @param {import('./haptoflow.d.ts').ReliefOptions | import('./haptoflow.d.ts').ReliefImageOptions} options
 * @returns {NormalMap | null}
 */
export function normalMapOf(options) {
  if (!('image' in options)) return null;
  const { image, isNormalMap = false, sizeMetres, isTiled = true } = options;
  requireImage(image, 'image');
  return isNormalMap ? { columns: image.width, rows: image.height, normals: normalsOf(image), sizeMetres, isTiled } : null;
}

/**
 * A relief of an image as one of heights.
 * @param {import('./haptoflow.d.ts').ReliefOptions | import('./haptoflow.d.ts').ReliefImageOptions} options
 * @param {Float32Array | null} integrated the heights of its normals, of which the lowest is 0
 * @returns {import('./haptoflow.d.ts').ReliefOptions}
 */
export function withHeights(options, integrated) {
  if (!('image' in options)) return options;
  const { image, isNormalMap, ...rest } = options;
  const highest = integrated?.reduce((most, height) => Math.max(most, height), 0) || 1;
  const depth = single(options.depthMetres);
  const heights = integrated ?? heightsOf(image);
  return { ...rest, columns: image.width, rows: image.height, heightsMetres: heights.map((height) => single(height / highest) * depth) };
}

/**
 * All that a relief needs, with heights of its own.
 * @param {import('./haptoflow.d.ts').ReliefOptions} options
 */
export function fullRelief({ columns, rows, heightsMetres, sizeMetres: [along, across], depthMetres, tipRadiusMetres = penTipMetres, isTiled = true }) {
  if (heightsMetres.length !== columns * rows) {
    throw new HaptoFlowError('invalid-argument', `heightsMetres has ${heightsMetres.length} numbers; expected columns by rows, ${columns} by ${rows}`);
  }
  return { columns, rows, heightsMetres: Float32Array.from(heightsMetres), sizeMetres: /** @type {[number, number]} */ ([along, across]), depthMetres, tipRadiusMetres, isTiled };
}

/**
 * Makes a relief in an instance's memory. Returns its number there.
 * @param {import('./module.mjs').Core} core
 * @param {import('./haptoflow.d.ts').ReliefOptions} options of heights
 */
export function makeRelief(core, options) {
  const { columns, rows, heightsMetres, sizeMetres: [along, across], depthMetres, tipRadiusMetres, isTiled } = fullRelief(options);
  const address = core.copyIn(new Uint8Array(heightsMetres.buffer));
  try {
    return core.call('hapto_relief_create', address, columns, rows, isTiled ? 1 : 0, along, across, depthMetres, tipRadiusMetres);
  } finally {
    core.free(address);
  }
}
