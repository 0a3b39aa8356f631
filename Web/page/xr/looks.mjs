import { Fills, tileMetres } from '../table/fills.mjs';
import { shadingOf } from '../table/reliefs.mjs';

// Materials of labels for three.js, with the pictures of the table.

const widthPixels = 256;
const captionPixels = 56;

/** Makes each material once. */
export class Looks {
  #three;
  #fills;
  /** @type {Map<string, any>} */
  #materials = new Map();

  /** @param {any} three @param {{labels: Record<string, any>}} looks */
  constructor(three, looks) {
    this.#three = three;
    this.#fills = new Fills(looks.labels);
  }

  #texture(canvas) {
    const texture = new this.#three.CanvasTexture(canvas);
    texture.colorSpace = this.#three.SRGBColorSpace;
    texture.anisotropy = 4;
    return texture;
  }

  /** Of a label or a blend, for texture coordinates in metres. @param {string | Record<string, number>} material */
  material(material) {
    const key = JSON.stringify(material);
    const known = this.#materials.get(key);
    if (known) return known;
    const map = this.#texture(this.#fills.tile(material));
    map.wrapS = this.#three.RepeatWrapping;
    map.wrapT = this.#three.RepeatWrapping;
    map.repeat.setScalar(1 / tileMetres);
    const made = new this.#three.MeshLambertMaterial({ map });
    this.#materials.set(key, made);
    return made;
  }

  /** The light and shade of a relief, for texture coordinates in metres. @param {import('../table/reliefs.mjs').SurfaceRelief} relief */
  shading(relief) {
    const map = this.#texture(shadingOf(relief));
    map.wrapS = this.#three.RepeatWrapping;
    map.wrapT = this.#three.RepeatWrapping;
    map.repeat.set(1 / relief.sizeMetres[0], 1 / relief.sizeMetres[1]);
    return new this.#three.MeshBasicMaterial({ map, transparent: true, depthWrite: false });
  }

  /** A picture with the label's name below it, for texture coordinates from 0 to 1. */
  caption(label, aspect) {
    const canvas = document.createElement('canvas');
    canvas.width = widthPixels;
    canvas.height = Math.round(widthPixels / aspect);
    const context = canvas.getContext('2d');
    context.drawImage(this.#fills.tile(label), 0, 0);
    const top = canvas.height - captionPixels;
    context.fillStyle = '#15191d';
    context.fillRect(0, top, canvas.width, captionPixels);
    context.fillStyle = '#ffffff';
    context.textAlign = 'center';
    context.textBaseline = 'middle';
    let size = 38;
    do {
      context.font = `600 ${size}px system-ui, sans-serif`;
      size -= 2;
    } while (context.measureText(label).width > canvas.width - 16 && size > 16);
    context.fillText(label, canvas.width / 2, top + captionPixels / 2 + 2);
    return new this.#three.MeshBasicMaterial({ map: this.#texture(canvas) });
  }
}
