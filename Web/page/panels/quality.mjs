import { find, make, shown } from '../dom.mjs';
import { qualitiesOf } from '../model-file.mjs';

const words = /** @type {Record<string, string>} */ ({ sketch: 'plays without a network', auto: 'the most accurate that this device keeps up with' });

/** Qualities: what they cost now beside how accurate they are. */
export class QualityPanel {
  #haptics;
  #messages;
  #body = find('#qualities');
  #note = find('#quality-note');
  /** By tier. @type {Map<string, 'sketch' | 'draft' | 'standard'>} */
  #qualities;

  /** @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {import('../messages.mjs').Messages} messages */
  constructor(haptics, messages) {
    this.#haptics = haptics;
    this.#messages = messages;
    this.#qualities = new Map(qualitiesOf(haptics.model.tiers).map(({ quality, tier }) => [tier, quality]));
    const tiers = haptics.model.tiers.filter(({ name }) => this.#qualities.has(name)).map(({ name, accuracy }) => ({ name, accuracy }));
    this.#body.replaceChildren(...[...tiers, { name: 'auto', accuracy: /** @type {any} */ ({}) }].map(({ name, accuracy }) => {
      const quality = this.#qualityOf(name);
      const input = make('input', { type: 'radio', name: 'quality', value: name, checked: quality === haptics.quality, id: `quality-${quality}` });
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

  /** The names to choose from, as tiers are called. */
  get tiers() {
    return [...this.#qualities.keys()];
  }

  #qualityOf(/** @type {string} */ name) {
    return this.#qualities.get(name) ?? 'auto';
  }

  /** @param {string} name of a tier, or auto */
  async choose(name) {
    this.#note.textContent = `Loading ${name} …`;
    try {
      await this.#haptics.setQuality(this.#qualityOf(name));
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
      const cell = this.#body.querySelector(`[data-tier="${CSS.escape(name)}"]`);
      if (cell && runs > 0) {
        cell.textContent = `${shown(medianMs, 2)}`;
        cell.title = `median of the newest segments; 99 of 100 take at most ${shown(percentile99Ms, 2)} ms`;
      }
    }
    for (const row of this.#body.children) row.classList.toggle('is-current', row.querySelector('[data-tier]').dataset.tier === statistics.tier);
    this.#body.querySelector('[data-tier="auto"]').textContent = statistics.quality === 'auto' ? `now ${statistics.tier}` : '';
  }
}
