import { find, make, shown } from '../dom.mjs';

const words = /** @type {Record<string, string>} */ ({ sketch: 'plays without a network', auto: 'the most accurate that this device keeps up with' });

/** Qualities: what they cost now beside how accurate they are. */
export class QualityPanel {
  #haptics;
  #messages;
  #body = find('#qualities');
  #note = find('#quality-note');

  /** @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {import('../messages.mjs').Messages} messages */
  constructor(haptics, messages) {
    this.#haptics = haptics;
    this.#messages = messages;
    const tiers = haptics.model.tiers.map(({ name, accuracy }) => ({ name, accuracy }));
    this.#body.replaceChildren(...[...tiers, { name: 'auto', accuracy: /** @type {any} */ ({}) }].map(({ name, accuracy }) => {
      const input = make('input', { type: 'radio', name: 'quality', value: name, checked: name === haptics.quality, id: `quality-${name}` });
      input.addEventListener('change', () => void this.choose(name));
      const number = (/** @type {string} */ key, /** @type {number} */ digits) => shown(/** @type {any} */ (accuracy)[key], digits);
      return make('tr', {}, [
        make('th', { scope: 'row' }, [make('label', { title: words[name] ?? '' }, [input, name])]),
        make('td', { textContent: name === 'auto' ? '' : number('lsd_db', 2) }),
        make('td', { textContent: name === 'auto' ? '' : number('level_error_db', 2) }),
        make('td', { className: 'milliseconds', 'data-tier': name, textContent: name === 'auto' ? '' : '–' }),
      ]);
    }));
  }

  /** @param {string} name */
  async choose(name) {
    this.#note.textContent = `Loading ${name} …`;
    try {
      await this.#haptics.setQuality(/** @type {any} */ (name));
      this.#note.textContent = '';
    } catch (error) {
      this.#note.textContent = '';
      this.#messages.error(error);
    }
    find(`#quality-${this.#haptics.quality}`).checked = true;
  }

  /** @param {import('../../engine/js/haptoflow.d.ts').Statistics} statistics */
  show(statistics) {
    for (const { name, runs, medianMs, percentile99Ms } of statistics.tiers ?? []) {
      const cell = this.#body.querySelector(`[data-tier="${name}"]`);
      if (cell && runs > 0) {
        cell.textContent = `${shown(medianMs, 2)}`;
        cell.title = `median of the newest segments; 99 of 100 take at most ${shown(percentile99Ms, 2)} ms`;
      }
    }
    for (const row of this.#body.children) row.classList.toggle('is-current', row.querySelector('[data-tier]').dataset.tier === statistics.tier);
    this.#body.querySelector('[data-tier="auto"]').textContent = statistics.quality === 'auto' ? `now ${statistics.tier}` : '';
  }
}
