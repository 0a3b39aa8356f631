import { fillSelect, find } from '../dom.mjs';

/** A and B: two labels on one object, or two qualities, by one key. */
export class ComparePanel {
  #parts;
  #kind = find('#compare-kind');
  #selects = { a: find('#compare-a'), b: find('#compare-b') };
  #button = find('#compare-switch');
  #state = find('#compare-state');
  /** @type {'a' | 'b'} */
  side = 'a';

  /**
   * @param {{labels: () => string[], qualities: string[], object: () => number, title: (index: number) => string, paint: (index: number, material: string) => void,
   *   setQuality: (name: string) => Promise<void>, play: () => Promise<boolean>}} parts
   */
  constructor(parts) {
    this.#parts = parts;
    this.#kind.addEventListener('change', () => this.refresh());
    this.#button.addEventListener('click', () => void this.switchTo(this.side === 'a' ? 'b' : 'a'));
    find('#compare-play').addEventListener('click', () => void this.#playBoth());
    for (const side of /** @type {const} */ (['a', 'b'])) this.#selects[side].addEventListener('change', () => {
      if (side === this.side) void this.switchTo(side);
    });
    document.addEventListener('keydown', (event) => {
      const target = /** @type {HTMLElement} */ (event.target);
      if (event.key.toLowerCase() !== 'x' || event.ctrlKey || event.metaKey || event.altKey || ['INPUT', 'SELECT', 'TEXTAREA'].includes(target.tagName)) return;
      void this.switchTo(this.side === 'a' ? 'b' : 'a');
    });
    this.refresh();
  }

  refresh() {
    const isLabels = this.#kind.value === 'labels';
    const names = isLabels ? this.#parts.labels() : this.#parts.qualities;
    const options = names.map((name) => ({ value: name, text: name }));
    for (const side of /** @type {const} */ (['a', 'b'])) {
      const before = this.#selects[side].value;
      fillSelect(this.#selects[side], options);
      if (names.includes(before)) continue;
      const usual = isLabels ? { a: 'stone', b: 'sandpaper' }[side] : { a: 'sketch', b: 'standard' }[side];
      this.#selects[side].value = names.includes(usual) ? usual : (names.at({ a: 0, b: -1 }[side]) ?? '');
    }
    this.#tell('');
  }

  #tell(/** @type {string} */ text) {
    this.#button.textContent = `Switch to ${this.side === 'a' ? 'B' : 'A'}`;
    this.#state.textContent = text;
  }

  /** @param {'a' | 'b'} side */
  async switchTo(side) {
    this.side = side;
    const name = this.#selects[side].value;
    const letter = side.toUpperCase();
    if (this.#kind.value === 'labels') {
      const object = this.#parts.object();
      this.#parts.paint(object, name);
      this.#tell(`${letter}: ${name} on ${this.#parts.title(object)}`);
    } else {
      this.#tell(`${letter}: loading ${name} …`);
      await this.#parts.setQuality(name);
      this.#tell(`${letter}: ${name}`);
    }
  }

  async #playBoth() {
    for (const side of /** @type {const} */ (['a', 'b'])) {
      await this.switchTo(side);
      if (!(await this.#parts.play())) return;
    }
  }
}
