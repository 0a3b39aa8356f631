import { find } from '../dom.mjs';
import { sentenceOf } from '../messages.mjs';

const metresPerMillimetre = 0.001;
/** Of the engine's full scale, as the table's own reliefs: what is engraved is felt beside the texture, not instead of it. */
const share = 0.1;

/** @param {{type: string, name: string}} file */
export const isPicture = ({ type, name }) => type.startsWith('image/') || /\.(png|jpe?g|webp)$/i.test(name);

/**
 * Lays what is transparent on a ground, in place.
 * @param {import('../../engine/js/haptoflow.d.ts').ReliefImage} image @param {boolean} isNormalMap whose ground is an even face; else white
 * @returns {boolean} whether something was transparent
 */
export function onGround({ data }, isNormalMap) {
  const whole = data instanceof Uint16Array ? 65535 : 255;
  const ground = isNormalMap ? [whole / 2, whole / 2, whole] : [whole, whole, whole];
  let isTransparent = false;
  for (let at = 0; at < data.length; at += 4) {
    const opacity = data[at + 3] / whole;
    if (opacity === 1) continue;
    isTransparent = true;
    for (let part = 0; part < 3; part += 1) data[at + part] = Math.round(ground[part] + opacity * (data[at + part] - ground[part]));
    data[at + 3] = whole;
  }
  return isTransparent;
}

const millimetres = (/** @type {number} */ metres) => Number((metres / metresPerMillimetre).toPrecision(3)).toLocaleString('en');

/** A picture of the visitor's as a relief of the object that was touched last. */
export class ReliefPanel {
  #parts;
  #kind = find('#relief-kind');
  #width = find('#relief-width');
  #depth = find('#relief-depth');
  #layButton = find('#relief-lay');
  #removeButton = find('#relief-remove');
  #note = find('#relief-note');
  /** @type {File | null} */
  #file = null;
  /** The object on which changes of the numbers act: the one on which the picture was laid last. */
  #object = -1;
  /** Only the newest wish is fulfilled. */
  #wishes = 0;
  /** @type {Promise<void>} */
  #working = Promise.resolve();

  /**
   * @param {{reliefs: import('../table/reliefs.mjs').TableReliefs, mostTexels: number, object: () => number, nameOf: (index: number) => string,
   *   titleOf: (index: number) => string, isFlat: (index: number) => boolean, isOn: () => boolean,
   *   decode: typeof import('../../engine/js/haptoflow.d.ts').HaptoFlow.decodeImage}} parts object: the one that was touched last
   */
  constructor(parts) {
    this.#parts = parts;
    const input = find('#relief-file');
    input.addEventListener('change', () => {
      if (input.files.length > 0) void this.take(input.files[0]);
      input.value = '';
    });
    for (const field of [this.#kind, this.#width, this.#depth]) field.addEventListener('change', () => {
      if (this.#file && this.#object >= 0 && parts.reliefs.hasPicture(parts.nameOf(this.#object))) void this.lay(this.#object);
    });
    this.#layButton.addEventListener('click', () => void this.lay(parts.object()));
    this.#removeButton.addEventListener('click', () => void this.remove(parts.object()));
    this.refresh();
  }

  /** Shows which object it is about. */
  refresh() {
    const { object, nameOf, titleOf, reliefs } = this.#parts;
    const title = titleOf(object());
    this.#layButton.textContent = `Lay it on: ${title}`;
    this.#layButton.disabled = this.#file === null;
    this.#removeButton.textContent = `Take it off: ${title}`;
    this.#removeButton.disabled = !reliefs.hasPicture(nameOf(object()));
  }

  /** Lays a picture on the object that was touched last. @param {File} file */
  take(file) {
    this.#file = file;
    return this.lay(this.#parts.object());
  }

  /** @param {number} object */
  async lay(object) {
    this.#wishes += 1;
    const wish = this.#wishes;
    // One after the other: each takes memory for a picture.
    this.#working = this.#working.then(() => (wish === this.#wishes ? this.#lay(object) : undefined));
    await this.#working;
    this.refresh();
  }

  async #lay(/** @type {number} */ object) {
    const { reliefs, mostTexels, decode, nameOf, titleOf, isFlat, isOn } = this.#parts;
    const file = /** @type {File} */ (this.#file);
    const title = titleOf(object);
    this.#note.textContent = `Reading ${file.name} …`;
    try {
      if (!isPicture(file)) throw new Error(`${file.name} is no picture: choose a PNG, JPEG or WebP file`);
      if (!isFlat(object)) throw new Error(`${title} is round, and a picture lies on flat objects: touch another one`);
      const [widthMetres, depthMetres] = [this.#metres(this.#width, 'Width'), this.#metres(this.#depth, 'Depth')];
      const isNormalMap = this.#kind.value === 'normals';
      const image = await decode(file, { mostPixels: mostTexels });
      const { width, height, fullWidth, fullHeight } = image;
      const isTransparent = onGround(image, isNormalMap);
      const acrossMetres = (widthMetres * fullHeight) / fullWidth;
      const { heightsMetres } = await reliefs.put(nameOf(object), image, { isNormalMap, sizeMetres: [widthMetres, acrossMetres], depthMetres, share });
      this.#object = object;
      const isEven = heightsMetres.every((each) => each === heightsMetres[0]);
      this.#note.textContent = [
        `“${file.name}” lies on ${title}: ${millimetres(widthMetres)} × ${millimetres(acrossMetres)} mm, ${millimetres(depthMetres)} mm deep.`,
        width < fullWidth || height < fullHeight ? `Its ${fullWidth} × ${fullHeight} pixels are more than the ${mostTexels.toLocaleString('en')} of a relief: it was made smaller, ${width} × ${height}.` : '',
        isTransparent ? `What is transparent counts as ${isNormalMap ? 'even' : 'white'}.` : '',
        isEven ? 'All of it is equally high, so nothing is felt.' : '',
        isOn() ? '' : 'Relief is switched off, under Effects.',
      ].filter((sentence) => sentence !== '').join(' ');
    } catch (error) {
      const { code, message } = /** @type {any} */ (error);
      this.#note.textContent = code ? sentenceOf(error) : `${message}.`;
    }
  }

  /** @param {HTMLInputElement} field @param {string} name */
  #metres(field, name) {
    const value = field.valueAsNumber;
    const [least, most] = [Number(field.min), Number(field.max)];
    field.setAttribute('aria-invalid', String(!(value >= least && value <= most)));
    if (!(value >= least && value <= most)) throw new Error(`${name}: write a number of millimetres from ${least} to ${most}`);
    return value * metresPerMillimetre;
  }

  /** @param {number} object */
  async remove(object) {
    const { reliefs, nameOf, titleOf } = this.#parts;
    this.#wishes += 1;
    // After what is being laid.
    this.#working = this.#working.then(() => reliefs.remove(nameOf(object)));
    await this.#working;
    this.#note.textContent = `The picture is off ${titleOf(object)}.`;
    this.refresh();
    this.#layButton.focus();
  }
}
