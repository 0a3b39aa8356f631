import { effectMask, field, fieldCount } from './contact-fields.mjs';
import { HaptoFlowError } from './errors.mjs';
import { usualShare } from './relief.mjs';

const tipNumbers = 7;
const readingNumbers = 9;

/** @typedef {import('./haptoflow.d.ts').SceneContact} SceneContact */

/** @returns {any} a contact to be filled at every update */
const emptyContact = () => ({
  timeSeconds: 0, touching: false, surfaceIndex: -1, surfaceName: '', penetrationMetres: 0, contactMetres: [0, 0, 0], normal: [0, 1, 0],
  velocityMps: [0, 0], forceNewtons: 0, approachSpeedMps: 0, touchCounter: 0, landingCounter: 0, edgeCounter: 0, edgeHeightMetres: 0,
  spatialScale: 1, toneDbPerOctave: 0, variation: 0, surfaceSeed: 0, placeMetres: [0, 0, 0], firstAxis: [0, 0, 0], secondAxis: [0, 0, 0],
  relief: null, reliefPlace: [0, 0], reliefShare: 0,
});

/** The command line's contact model; see haptoflow.d.ts. */
export class Scene {
  #core;
  #indices;
  #index;
  /** Tip, fields and reading, one after the other. */
  #address;
  #contact = emptyContact();
  /** @type {any[]} */
  #surfaces;
  /** By a surface's index. @type {(import('./relief.mjs').Relief | null)[]} */
  #reliefs = [];
  #updateRateHz;
  #tipRadiusMetres;
  #isClosed = false;

  /**
   * @param {import('./module.mjs').Core} core
   * @param {import('./contact-fields.mjs').LabelIndices} indices
   * @param {readonly object[]} labels
   * @param {string | object} scene
   */
  constructor(core, indices, labels, scene) {
    this.#core = core;
    this.#indices = indices;
    this.#index = core.call('hapto_scene_open', typeof scene === 'string' ? scene : JSON.stringify(scene), JSON.stringify(labels));
    this.#address = core.allocate(8 * (tipNumbers + fieldCount + readingNumbers));
    const { updateRateHz, tipRadiusMetres, surfaces } = core.json('hapto_scene_json', this.#index);
    this.#surfaces = surfaces;
    this.#updateRateHz = updateRateHz;
    this.#tipRadiusMetres = tipRadiusMetres;
  }

  get updateRateHz() {
    return this.#updateRateHz;
  }

  get tipRadiusMetres() {
    return this.#tipRadiusMetres;
  }

  get surfaces() {
    return this.#surfaces;
  }

  #requireOpen() {
    if (this.#isClosed) throw new HaptoFlowError('closed', 'the scene is closed');
  }

  #run(/** @type {import('./haptoflow.d.ts').TipSample} */ tip, /** @type {number} */ effects) {
    this.#requireOpen();
    const at = this.#address >> 3;
    const numbers = this.#core.f64;
    numbers[at] = tip.timeSeconds;
    for (let axis = 0; axis < 3; axis += 1) numbers[at + 1 + axis] = tip.positionMetres[axis];
    numbers[at + 4] = tip.forceNewtons === undefined ? 0 : 1;
    numbers[at + 5] = tip.forceNewtons ?? 0;
    numbers[at + 6] = effects;
    const fields = this.#address + 8 * tipNumbers;
    this.#core.call('hapto_scene_update', this.#index, this.#address, fields, fields + 8 * fieldCount);
    return this.#filled(this.#core.f64, at + tipNumbers);
  }

  /** @returns {SceneContact} */
  #filled(/** @type {Float64Array} */ numbers, /** @type {number} */ at) {
    const contact = this.#contact;
    const reading = at + fieldCount;
    const copy = (/** @type {number[]} */ target, /** @type {number} */ from) => {
      for (let index = 0; index < target.length; index += 1) target[index] = numbers[from + index];
    };
    contact.touching = numbers[at + field.touching] !== 0;
    contact.touchCounter = numbers[at + field.touchCounter];
    copy(contact.velocityMps, at + field.velocity);
    contact.forceNewtons = numbers[at + field.force];
    contact.approachSpeedMps = numbers[at + field.approachSpeed];
    contact.edgeCounter = numbers[at + field.edgeCounter];
    contact.edgeHeightMetres = numbers[at + field.edgeHeight];
    contact.landingCounter = numbers[at + field.landingCounter];
    contact.spatialScale = numbers[at + field.spatialScale];
    contact.toneDbPerOctave = numbers[at + field.tone];
    contact.surfaceSeed = numbers[at + field.surfaceSeed];
    copy(contact.placeMetres, at + field.place);
    copy(contact.firstAxis, at + field.firstAxis);
    copy(contact.secondAxis, at + field.secondAxis);
    contact.variation = numbers[at + field.variation];
    contact.relief = numbers[at + field.relief] === 0 ? null : this.#reliefs[numbers[reading + 1]];
    copy(contact.reliefPlace, at + field.reliefPlace);
    contact.reliefShare = numbers[at + field.reliefShare];
    contact.timeSeconds = numbers[reading];
    contact.surfaceIndex = numbers[reading + 1];
    contact.surfaceName = this.#surfaces[contact.surfaceIndex]?.name ?? '';
    contact.material = this.#surfaces[contact.surfaceIndex]?.material;
    contact.penetrationMetres = numbers[reading + 2];
    copy(contact.contactMetres, reading + 3);
    copy(contact.normal, reading + 6);
    return contact;
  }

  /** @param {import('./haptoflow.d.ts').TipSample} tip */
  update(tip) {
    return this.#run(tip, effectMask({}));
  }

  /**
   * @param {import('./voice.mjs').Voice} voice
   * @param {import('./haptoflow.d.ts').TipSample} tip
   */
  publish(voice, tip) {
    const contact = this.#run(tip, effectMask(voice.effects));
    voice.publishFields(this.#core.f64, (this.#address >> 3) + tipNumbers);
    return contact;
  }

  #surfaceOf(/** @type {number | string} */ surface) {
    this.#requireOpen();
    const found = this.#surfaces.find(({ index, name }) => index === surface || name === surface);
    if (!found) throw new HaptoFlowError('invalid-argument', `the scene has no surface ${JSON.stringify(surface)}`);
    return found;
  }

  /**
   * @param {number | string} surface
   * @param {import('./relief.mjs').Relief | null} relief
   * @param {{share?: number}} [options]
   */
  setRelief(surface, relief, { share = usualShare } = {}) {
    const { index } = this.#surfaceOf(surface);
    const [along, across] = relief?.sizeMetres ?? [1, 1];
    this.#core.call('hapto_scene_set_relief', this.#index, index, relief?.number ?? 0, along, across, share);
    this.#reliefs[index] = relief;
  }

  /**
   * @param {number | string} surface
   * @param {{material?: import('./haptoflow.d.ts').Material, spatialScale?: number, toneDbPerOctave?: number, variation?: number}} change
   */
  setSurface(surface, { material, spatialScale = NaN, toneDbPerOctave = NaN, variation = NaN }) {
    const found = this.#surfaceOf(surface);
    const fields = new Float64Array(fieldCount);
    if (material !== undefined) this.#indices.write(material, fields);
    const core = this.#core;
    const address = core.allocate(8 * 11);
    try {
      core.f64.set([spatialScale, toneDbPerOctave, variation], address >> 3);
      core.f64.set(fields.subarray(field.labels, field.labels + 8), (address >> 3) + 3);
      core.call('hapto_scene_set_surface', this.#index, found.index, address, fields[field.labelCount], address + 24, address + 56);
    } finally {
      core.free(address);
    }
    if (material !== undefined) found.material = material;
  }

  /**
   * @param {number} surface
   * @param {number} timeSeconds
   * @param {import('./haptoflow.d.ts').Pose} into
   */
  poseOf(surface, timeSeconds, into) {
    this.#requireOpen();
    this.#core.call('hapto_scene_pose', this.#index, surface, timeSeconds, this.#address);
    const numbers = this.#core.f64;
    const at = this.#address >> 3;
    for (let part = 0; part < 3; part += 1) into.position[part] = numbers[at + part];
    for (let part = 0; part < 4; part += 1) into.rotation[part] = numbers[at + 3 + part];
    return into;
  }

  reset() {
    this.#requireOpen();
    this.#core.call('hapto_scene_reset', this.#index);
  }

  close() {
    if (this.#isClosed) return;
    this.#isClosed = true;
    this.#core.call('hapto_scene_close', this.#index);
    this.#core.free(this.#address);
  }
}
