// Pictures of materials, drawn once a label: a tile that repeats every `tileMetres`.

export const tileMetres = 0.04;
const tilePixels = 256;
const metre = tilePixels / tileMetres;

/** @typedef {{colour: string, accent: string, picture: string, picture_metres: number, words: string}} Look */
/** @typedef {CanvasRenderingContext2D | OffscreenCanvasRenderingContext2D} Context */

function randomOf(/** @type {string} */ name) {
  let state = [...name].reduce((sum, letter) => Math.imul(sum, 31) + letter.charCodeAt(0), 7) >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 4294967296;
  };
}

/** Draws something at random places, and again where it crosses the tile's rim. */
function scatter(/** @type {() => number} */ random, /** @type {number} */ count, /** @type {(x: number, y: number) => void} */ draw) {
  for (let index = 0; index < count; index += 1) {
    const [x, y] = [random() * tilePixels, random() * tilePixels];
    for (const dx of [0, -tilePixels, tilePixels]) for (const dy of [0, -tilePixels, tilePixels]) draw(x + dx, y + dy);
  }
}

/** Distance between repeated lines that fits the tile. */
const pitchOf = (/** @type {Look} */ look) => tilePixels / Math.max(1, Math.round(tilePixels / (look.picture_metres * metre)));

/** @type {Record<string, (context: Context, look: Look, random: () => number) => void>} */
const painters = {
  grain(context, look, random) {
    for (let line = 0; line < 26; line += 1) {
      const y = random() * tilePixels;
      const sway = 2 + 5 * random();
      context.globalAlpha = 0.12 + 0.3 * random();
      context.lineWidth = 0.8 + 2 * random();
      for (const dy of [0, -tilePixels, tilePixels]) {
        context.beginPath();
        for (let x = 0; x <= tilePixels; x += 8) context.lineTo(x, y + dy + sway * Math.sin((2 * Math.PI * x) / tilePixels + line));
        context.stroke();
      }
    }
  },
  brushed(context, look, random) {
    for (let y = 0; y < tilePixels; y += 2) {
      context.globalAlpha = 0.3 * random();
      context.fillStyle = random() < 0.5 ? '#fff' : look.accent;
      context.fillRect(0, y, tilePixels, 2);
    }
  },
  speckle(context, look, random) {
    for (const colour of [look.accent, '#fff']) {
      context.fillStyle = colour;
      scatter(random, 260, (x, y) => {
        context.globalAlpha = 0.35;
        context.fillRect(x, y, 3, 3);
      });
    }
  },
  pores(context, look, random) {
    scatter(random, 150, (x, y) => {
      context.globalAlpha = 0.4;
      context.beginPath();
      context.ellipse(x, y, 2.2, 1.5, x, 0, 7);
      context.fill();
    });
    painters.speckle(context, look, random);
  },
  gloss() {},
  mesh(context, look) {
    const pitch = pitchOf(look);
    context.lineWidth = pitch * 0.26;
    context.globalAlpha = 0.9;
    for (let at = 0; at < tilePixels - 1; at += pitch) {
      context.strokeRect(at, -5, 1e-3, tilePixels + 10);
      context.strokeRect(-5, at, tilePixels + 10, 1e-3);
    }
  },
  dots(context, look) {
    const pitch = pitchOf(look);
    context.globalAlpha = 0.6;
    for (let x = 0; x < tilePixels; x += pitch) {
      for (let y = 0; y < tilePixels; y += pitch) {
        context.beginPath();
        context.arc(x + pitch / 2, y + pitch / 2, pitch * 0.18, 0, 7);
        context.fill();
      }
    }
  },
  pebble(context, look, random) {
    context.lineWidth = 1.4;
    scatter(random, 230, (x, y) => {
      context.globalAlpha = 0.32;
      context.beginPath();
      context.ellipse(x, y, 9, 7, x + y, 0, 7);
      context.stroke();
    });
  },
  weave(context, look) {
    const pitch = pitchOf(look);
    context.globalAlpha = 0.42;
    for (let row = 0; row * pitch < tilePixels - 1; row += 1) {
      for (let column = 0; column * pitch < tilePixels - 1; column += 1) {
        const [x, y] = [column * pitch, row * pitch];
        if ((row + column) % 2 === 0) context.fillRect(x, y + pitch * 0.12, pitch, pitch * 0.2);
        else context.fillRect(x + pitch * 0.12, y, pitch * 0.2, pitch);
      }
    }
  },
  ribs(context, look) {
    const pitch = pitchOf(look);
    for (let x = 0; x < tilePixels - 1; x += pitch) {
      context.globalAlpha = 0.75;
      context.fillStyle = look.accent;
      context.fillRect(x, 0, pitch * 0.36, tilePixels);
      context.globalAlpha = 0.16;
      context.fillStyle = '#fff';
      context.fillRect(x + pitch * 0.55, 0, pitch * 0.2, tilePixels);
    }
  },
  flutes(context, look) {
    const pitch = pitchOf(look);
    context.globalAlpha = 0.3;
    for (let x = 0; x < tilePixels - 1; x += pitch) context.fillRect(x, 0, pitch * 0.3, tilePixels);
  },
  fibres(context, look, random) {
    context.lineWidth = 1.1;
    scatter(random, 150, (x, y) => {
      context.globalAlpha = 0.4;
      const turn = ((x * 13 + y * 7) % 63) / 10;
      context.beginPath();
      context.moveTo(x, y);
      context.quadraticCurveTo(x + 9 * Math.cos(turn), y + 9 * Math.sin(turn), x + 18 * Math.cos(turn + 0.5), y + 18 * Math.sin(turn + 0.5));
      context.stroke();
    });
  },
  grit(context, look, random) {
    for (const colour of [look.accent, '#f5d9a8', '#40240c']) {
      context.fillStyle = colour;
      scatter(random, 900, (x, y) => {
        context.globalAlpha = 0.5;
        context.fillRect(x, y, 2, 2);
      });
    }
  },
  tufts(context, look, random) {
    for (const colour of [look.accent, '#fff', look.accent]) {
      context.fillStyle = colour;
      scatter(random, colour === '#fff' ? 160 : 420, (x, y) => {
        context.globalAlpha = colour === '#fff' ? 0.14 : 0.4;
        context.beginPath();
        context.ellipse(x, y, 4, 2.6, x * y, 0, 7);
        context.fill();
      });
    }
  },
};

/** Look of a label that none was drawn for: learnt materials. */
const plainLook = { colour: '#7a86a8', accent: '#56628a', picture: 'dots', picture_metres: 0.005, words: 'a material of your own' };

export class Fills {
  #looks;
  /** @type {Map<string, HTMLCanvasElement>} */
  #tiles = new Map();

  /** @param {Record<string, Look>} looks */
  constructor(looks) {
    this.#looks = looks;
  }

  /** @param {string} label @returns {Look} */
  look(label) {
    return this.#looks[label] ?? plainLook;
  }

  #draw(/** @type {Context} */ context, /** @type {string} */ label) {
    const look = this.look(label);
    context.fillStyle = look.colour;
    context.fillRect(0, 0, tilePixels, tilePixels);
    context.fillStyle = look.accent;
    context.strokeStyle = look.accent;
    painters[look.picture]?.(context, look, randomOf(label));
    context.globalAlpha = 1;
  }

  /** The tile of a label or a blend. @param {any} material */
  tile(material) {
    const key = typeof material === 'string' ? material : JSON.stringify(material);
    let tile = this.#tiles.get(key);
    if (!tile) {
      tile = document.createElement('canvas');
      tile.width = tilePixels;
      tile.height = tilePixels;
      const context = /** @type {CanvasRenderingContext2D} */ (tile.getContext('2d'));
      const weights = typeof material === 'string' ? { [material]: 1 } : material;
      let total = 0;
      for (const [name, weight] of Object.entries(weights)) {
        if (weight <= 0) continue;
        total += weight;
        const alone = typeof material === 'string' ? null : this.tile(name);
        context.globalAlpha = weight / total;
        if (alone) context.drawImage(alone, 0, 0);
        else this.#draw(context, name);
      }
      this.#tiles.set(key, tile);
    }
    return tile;
  }
}
