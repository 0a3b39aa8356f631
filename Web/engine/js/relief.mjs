import { HaptoFlowError } from './errors.mjs';

/** As in scene files. */
export const usualShare = 0.5;
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

  destroy() {
    this.#destroy(this);
  }
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
 * @param {import('./haptoflow.d.ts').ReliefOptions} options
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
