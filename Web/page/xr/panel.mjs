// The panel above the board: what is felt now, and what it costs.

const pixels = { width: 1024, height: 320 };
export const panelMetres = { width: 0.44, height: 0.44 * (pixels.height / pixels.width) };

const reasons = {
  none: 'sounds',
  rest: 'silent: at rest',
  stale: 'silent: no pose',
  muted: 'silent: muted',
  paused: 'silent: out of focus',
  panic: 'silent: stopped',
  rate: 'silent: audio rate',
  closing: 'silent: closing',
  'worker-dead': 'silent: the engine failed',
  'turned-down': 'silent: turned down',
  context: 'silent: audio waits for a press',
};

const number = (value, digits) => (Number.isFinite(value) ? value.toFixed(digits) : '-');

/** What one side does, in a few words. */
export function wordsOfSide({ name, device, isTracked, isTouching, silence, hasMotor, forceNewtons }) {
  if (!device) return `${name}: nothing held`;
  if (!isTracked) return `${name}: ${device}, not tracked`;
  const feels = isTouching && silence === 'none' ? `${number(forceNewtons, 2)} N` : reasons[silence === 'none' ? 'rest' : silence] ?? silence;
  return `${name}: ${device}, ${feels}${hasMotor ? '' : ', no motor'}`;
}

/** A label, or a blend's labels with their shares. @param {string | Record<string, number>} material */
export function wordsOfMaterial(material) {
  if (typeof material === 'string') return material;
  const labels = Object.keys(material);
  return labels.length === 1 ? labels[0] : labels.map((label) => `${Math.round(100 * material[label])} % ${label}`).join(', ');
}

/** The texts of the panel. */
export function wordsOfPanel({ label, brush, quality, segmentMs, posesPerSecond, sides }) {
  return {
    title: label || 'Touch something',
    hint: brush ? `press the button on an object: it becomes ${brush}` : 'touch a swatch to take its material',
    cost: `${quality}   ${number(segmentMs, 2)} ms a segment   ${number(posesPerSecond, 0)} poses a second`,
    sides: sides.map(wordsOfSide),
  };
}

/** A canvas that shows the words, redrawn when they change. */
export class Panel {
  #context;
  #texture;
  #shown = '';

  constructor(three) {
    const canvas = document.createElement('canvas');
    canvas.width = pixels.width;
    canvas.height = pixels.height;
    this.#context = canvas.getContext('2d');
    this.#texture = new three.CanvasTexture(canvas);
    this.#texture.colorSpace = three.SRGBColorSpace;
    this.mesh = new three.Mesh(
      new three.PlaneGeometry(panelMetres.width, panelMetres.height),
      new three.MeshBasicMaterial({ map: this.#texture }),
    );
    this.show({ sides: [] });
  }

  /** @param {any} state see `wordsOfPanel` */
  show(state) {
    const words = wordsOfPanel(state);
    const all = JSON.stringify(words);
    if (all === this.#shown) return;
    this.#shown = all;
    this.#draw(words);
    this.#texture.needsUpdate = true;
  }

  #draw({ title, hint, cost, sides }) {
    const context = this.#context;
    const line = (text, y, font, colour) => {
      context.font = font;
      context.fillStyle = colour;
      context.fillText(text, 32, y, pixels.width - 64);
    };
    context.fillStyle = '#15191d';
    context.fillRect(0, 0, pixels.width, pixels.height);
    line(title, 76, '600 64px system-ui, sans-serif', '#ffffff');
    line(cost, 136, '36px system-ui, sans-serif', '#9fd3c7');
    sides.forEach((text, index) => line(text, 192 + 46 * index, '34px system-ui, sans-serif', '#d5dadf'));
    line(hint, 296, '32px system-ui, sans-serif', '#f0c987');
  }
}
