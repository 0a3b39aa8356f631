// A tile of each kind of picture that looks.json names, drawn on a canvas. Eight periods of a picture fill a tile.

export const tilePixels = 256;
export const periodsPerTile = 8;

const period = tilePixels / periodsPerTile;

/** The same numbers in every browser: a picture is no measurement, but two swatches of one label should be alike. */
function numbers(seed) {
  let state = seed >>> 0;
  return () => {
    state = (Math.imul(state, 1664525) + 1013904223) >>> 0;
    return state / 2 ** 32;
  };
}

function spots(context, random, { count, least, most, alpha }) {
  for (let index = 0; index < count; index += 1) {
    const radius = least + random() * (most - least);
    const [x, y] = [random() * tilePixels, random() * tilePixels];
    context.globalAlpha = alpha * (0.4 + 0.6 * random());
    // What leaves the tile on one side comes in on the other.
    for (const [dx, dy] of [[0, 0], [tilePixels, 0], [-tilePixels, 0], [0, tilePixels], [0, -tilePixels]]) {
      context.beginPath();
      context.arc(x + dx, y + dy, radius, 0, 2 * Math.PI);
      context.fill();
    }
  }
}

function lines(context, { step, width, alpha, isUpright = true }) {
  context.globalAlpha = alpha;
  for (let at = 0; at < tilePixels; at += step) {
    if (isUpright) context.fillRect(at, 0, width, tilePixels);
    else context.fillRect(0, at, tilePixels, width);
  }
}

function strands(context, random, { count, length, alpha, isAligned }) {
  for (let index = 0; index < count; index += 1) {
    const angle = isAligned ? (random() - 0.5) * 0.1 : random() * Math.PI;
    const [x, y] = [random() * tilePixels, random() * tilePixels];
    context.globalAlpha = alpha * random();
    context.beginPath();
    context.moveTo(x, y);
    context.lineTo(x + length * Math.cos(angle), y + length * Math.sin(angle));
    context.stroke();
  }
}

const draw = {
  grain: (context, random) => strands(context, random, { count: 220, length: 140, alpha: 0.6, isAligned: true }),
  speckle: (context, random) => spots(context, random, { count: 700, least: 1, most: 3, alpha: 0.7 }),
  pores: (context, random) => spots(context, random, { count: 160, least: 1, most: 6, alpha: 0.6 }),
  gloss: (context) => lines(context, { step: tilePixels / 2, width: tilePixels / 10, alpha: 0.18 }),
  brushed: (context, random) => strands(context, random, { count: 700, length: 200, alpha: 0.4, isAligned: true }),
  mesh: (context) => {
    lines(context, { step: period, width: period / 3, alpha: 1 });
    lines(context, { step: period, width: period / 3, alpha: 1, isUpright: false });
  },
  dots: (context) => {
    context.globalAlpha = 0.9;
    for (let at = 0; at < periodsPerTile ** 2; at += 1) {
      context.beginPath();
      context.arc((0.5 + (at % periodsPerTile)) * period, (0.5 + Math.floor(at / periodsPerTile)) * period, period / 4, 0, 2 * Math.PI);
      context.fill();
    }
  },
  pebble: (context, random) => spots(context, random, { count: 260, least: 4, most: 10, alpha: 0.35 }),
  weave: (context) => {
    context.globalAlpha = 0.8;
    for (let at = 0; at < periodsPerTile ** 2; at += 1) {
      const [x, y] = [(at % periodsPerTile) * period, Math.floor(at / periodsPerTile) * period];
      if ((at + Math.floor(at / periodsPerTile)) % 2 === 0) context.fillRect(x, y + period / 8, period, (3 * period) / 4);
    }
  },
  ribs: (context) => lines(context, { step: period, width: period / 2, alpha: 0.9 }),
  fibres: (context, random) => strands(context, random, { count: 500, length: 30, alpha: 0.8, isAligned: false }),
  flutes: (context) => lines(context, { step: period, width: period / 3, alpha: 0.5 }),
  grit: (context, random) => spots(context, random, { count: 2200, least: 0.6, most: 2, alpha: 0.9 }),
  tufts: (context, random) => spots(context, random, { count: 900, least: 2, most: 6, alpha: 0.5 }),
};

/** Fills the canvas's first tile with a look of looks.json; a picture that is not known stays plain. */
export function drawPicture(context, look) {
  context.globalAlpha = 1;
  context.fillStyle = look.colour;
  context.fillRect(0, 0, tilePixels, tilePixels);
  context.fillStyle = look.accent ?? look.colour;
  context.strokeStyle = look.accent ?? look.colour;
  context.lineWidth = 1.5;
  draw[look.picture]?.(context, numbers(7));
  context.globalAlpha = 1;
}

/** How large a tile is on an object. */
export const tileMetres = (look) => periodsPerTile * (look.picture_metres ?? 0.005);
