import { fillSelect, find, make, slider } from '../dom.mjs';

/** All labels to choose from, blends of two, and painting of objects. */
export class Palette {
  #haptics;
  #fills;
  #paint;
  #list = find('#labels');
  #words = find('#label-words');
  #second = find('#blend-label');
  #share = 0;
  #object = find('#paint-object');
  #brush = find('#brush');
  chosen = 'corduroy';

  /**
   * @param {{haptics: import('../../engine/js/haptoflow.d.ts').HaptoFlow, fills: import('../table/fills.mjs').Fills,
   *   objects: {value: string, text: string}[], paint: (index: number, material: any) => void, onSelect: (index: number) => void, restore: () => void}} parts
   */
  constructor({ haptics, fills, objects, paint, onSelect, restore }) {
    this.#haptics = haptics;
    this.#fills = fills;
    this.#paint = paint;
    fillSelect(this.#object, objects);
    this.#object.addEventListener('change', () => onSelect(Number(this.#object.value)));
    find('#paint').addEventListener('click', () => paint(Number(this.#object.value), this.material));
    find('#paint-restore').addEventListener('click', restore);
    this.#second.addEventListener('change', () => this.#describe());
    slider('blend-share', (value) => `${Math.round(value)} %`, (value) => {
      this.#share = value / 100;
      this.#describe();
    });
    if (!haptics.labels.some(({ name }) => name === this.chosen)) this.chosen = haptics.labels[0].name;
    this.refresh();
  }

  /** Shows the labels that there are now. */
  refresh() {
    const labels = this.#haptics.labels;
    this.#list.replaceChildren(...labels.map(({ name, isAdded }) => {
      const input = make('input', { type: 'radio', name: 'label', value: name, checked: name === this.chosen });
      input.addEventListener('change', () => this.choose(name));
      const swatch = make('canvas', { className: 'swatch', width: 240, height: 107, 'aria-hidden': 'true' });
      swatch.getContext('2d').drawImage(this.#fills.tile(name), 0, 0);
      return make('label', { className: isAdded ? 'chip added' : 'chip', title: this.#fills.look(name).words }, [input, swatch, make('span', { className: 'chip-name', textContent: name })]);
    }));
    fillSelect(this.#second, [{ value: '', text: 'nothing' }, ...labels.map(({ name }) => ({ value: name, text: name }))]);
    this.#describe();
  }

  /** @param {string} name */
  choose(name) {
    this.chosen = name;
    const input = this.#list.querySelector(`input[value="${CSS.escape(name)}"]`);
    if (input) input.checked = true;
    this.#describe();
  }

  select(/** @type {number} */ index) {
    this.#object.value = String(index);
  }

  get isPainting() {
    return this.#brush.checked;
  }

  /** What is painted: the chosen label, or its blend with the second one. */
  get material() {
    const second = this.#second.value;
    if (second === '' || second === this.chosen || this.#share === 0) return this.chosen;
    if (this.#share === 1) return second;
    return { [this.chosen]: 1 - this.#share, [second]: this.#share };
  }

  #describe() {
    find('#blend-share').disabled = this.#second.value === '';
    this.#words.textContent = `${this.chosen}: ${this.#fills.look(this.chosen).words}.`;
  }
}
