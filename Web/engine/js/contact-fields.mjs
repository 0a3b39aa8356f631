import { HaptoFlowError } from './errors.mjs';
import { usualShare } from './relief.mjs';

// The fields of a contact state as the module reads them (stateFrom in native/web_engine.cpp).

export const fieldCount = 37;
export const field = {
  touching: 0, touchCounter: 1, labelCount: 2, labels: 3, weights: 7, velocity: 11, force: 13, approachSpeed: 14, effects: 15,
  edgeCounter: 16, edgeHeight: 17, landingCounter: 18, spatialScale: 19, tone: 20, hasPlace: 21, surfaceSeed: 22, place: 23,
  firstAxis: 26, secondAxis: 29, variation: 32, relief: 33, reliefPlace: 34, reliefShare: 36,
};
export const maximumBlend = 4;
const effectBits = { texture: 1, impact: 2, edge: 4, relief: 0x200, nothing: 0x80000000 };
const alongX = /** @type {const} */ ([1, 0, 0]);
const alongZ = /** @type {const} */ ([0, 0, 1]);
const origin = /** @type {const} */ ([0, 0]);

/**
 * The bits of a choice of effects; what is missing sounds.
 * @param {import('./haptoflow.d.ts').EffectChoice} choice
 * @param {boolean} [usually] what a missing entry means
 */
export function effectMask({ texture, impact, edge, relief }, usually = true) {
  const mask = ((texture ?? usually) ? effectBits.texture : 0) | ((impact ?? usually) ? effectBits.impact : 0)
    | ((edge ?? usually) ? effectBits.edge : 0) | ((relief ?? usually) ? effectBits.relief : 0);
  return mask || effectBits.nothing;
}

/** Names of labels to their indices. */
export class LabelIndices {
  /** @type {Map<string, number>} */
  #indices = new Map();

  /** @param {readonly {name: string, index: number}[]} labels */
  set(labels) {
    this.#indices = new Map(labels.map(({ name, index }) => [name, index]));
  }

  /** @param {string} name */
  of(name) {
    const index = this.#indices.get(name);
    if (index === undefined) throw new HaptoFlowError('invalid-argument', `material "${name}": there is no such label; labels are ${[...this.#indices.keys()].join(', ')}`);
    return index;
  }

  /**
   * Writes a material into fields. Allocates nothing for a label.
   * @param {import('./haptoflow.d.ts').Material} material
   * @param {Float64Array} fields
   */
  write(material, fields) {
    if (typeof material === 'string') {
      fields[field.labelCount] = 1;
      fields[field.labels] = this.of(material);
      fields[field.weights] = 1;
      return;
    }
    let count = 0;
    for (const name in material) {
      if (count === maximumBlend) throw new HaptoFlowError('invalid-argument', `a material blends ${maximumBlend} labels at most`);
      fields[field.labels + count] = this.of(name);
      fields[field.weights + count] = material[name];
      count += 1;
    }
    if (count === 0) throw new HaptoFlowError('invalid-argument', 'a material needs at least one label');
    fields[field.labelCount] = count;
  }
}

const put = (/** @type {Float64Array} */ fields, /** @type {number} */ at, /** @type {ArrayLike<number>} */ values) => {
  for (let index = 0; index < values.length; index += 1) fields[at + index] = values[index];
};

/**
 * Writes all of a state but its material.
 * @param {import('./haptoflow.d.ts').ContactState} state
 * @param {number} usualEffects bits for a state without a choice of its own
 * @param {Float64Array} fields
 */
export function writeState(state, usualEffects, fields) {
  fields[field.touching] = state.touching ? 1 : 0;
  fields[field.touchCounter] = state.touchCounter ?? 0;
  fields[field.velocity] = state.velocityMps?.[0] ?? 0;
  fields[field.velocity + 1] = state.velocityMps?.[1] ?? 0;
  fields[field.force] = state.forceNewtons ?? 0;
  fields[field.approachSpeed] = state.approachSpeedMps ?? 0;
  fields[field.effects] = state.effects === undefined ? usualEffects : effectMask(state.effects);
  fields[field.edgeCounter] = state.edgeCounter ?? 0;
  fields[field.edgeHeight] = state.edgeHeightMetres ?? 0;
  fields[field.landingCounter] = state.landingCounter ?? 0;
  fields[field.spatialScale] = state.spatialScale ?? 0;
  fields[field.tone] = state.toneDbPerOctave ?? 0;
  fields[field.hasPlace] = state.placeMetres ? 1 : 0;
  fields[field.surfaceSeed] = state.surfaceSeed ?? 0;
  if (state.placeMetres) {
    put(fields, field.place, state.placeMetres);
    put(fields, field.firstAxis, state.firstAxis ?? alongX);
    put(fields, field.secondAxis, state.secondAxis ?? alongZ);
  }
  fields[field.variation] = state.variation ?? 0;
  fields[field.relief] = state.relief?.number ?? 0;
  if (state.relief) {
    put(fields, field.reliefPlace, state.reliefPlace ?? origin);
    fields[field.reliefShare] = state.reliefShare ?? usualShare;
  }
}
