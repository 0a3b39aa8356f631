import { drawPicture, tileMetres, tilePixels } from './pictures.mjs';

// Materials of labels for three.js, by looks.json.

const plain = { colour: '#7a7a7a' };
const captionPixels = 56;

function canvasOf(width, height) {
  const canvas = document.createElement('canvas');
  canvas.width = width;
  canvas.height = height;
  return canvas;
}

/** Makes each material once. */
export class Looks {
  #three;
  #looks;
  /** @type {Map<string, any>} */
  #materials = new Map();

  /** @param {any} three @param {{labels: Record<string, any>}} looks */
  constructor(three, looks) {
    this.#three = three;
    this.#looks = looks.labels;
  }

  #look(label) {
    return this.#looks[label] ?? plain;
  }

  #texture(canvas) {
    const texture = new this.#three.CanvasTexture(canvas);
    texture.colorSpace = this.#three.SRGBColorSpace;
    texture.anisotropy = 4;
    return texture;
  }

  /** For texture coordinates in metres. */
  material(label) {
    const known = this.#materials.get(label);
    if (known) return known;
    const look = this.#look(label);
    const canvas = canvasOf(tilePixels, tilePixels);
    drawPicture(canvas.getContext('2d'), look);
    const map = this.#texture(canvas);
    map.wrapS = this.#three.RepeatWrapping;
    map.wrapT = this.#three.RepeatWrapping;
    map.repeat.setScalar(1 / tileMetres(look));
    const made = new this.#three.MeshLambertMaterial({ map });
    this.#materials.set(label, made);
    return made;
  }

  /** A picture with the label's name below it, for texture coordinates from 0 to 1. */
  caption(label, aspect) {
    const canvas = canvasOf(tilePixels, Math.round(tilePixels / aspect));
    const context = canvas.getContext('2d');
    drawPicture(context, this.#look(label));
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
