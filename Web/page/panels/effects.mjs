import { find, make, shown } from '../dom.mjs';

const effects = /** @type {const} */ ([
  ['texture', 'the material while the tip slides'],
  ['impact', 'the knock of a landing'],
  ['edge', 'the tick of a rim'],
  ['relief', 'gaps, grout and letters of the surface'],
]);

/** Effects: on or off, how often they ran, and what they cost. */
export class EffectsPanel {
  #haptics;
  #messages;
  #body = find('#effects');
  #choice = { texture: true, impact: true, edge: true, relief: true };

  /** @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {import('../messages.mjs').Messages} messages */
  constructor(haptics, messages) {
    this.#haptics = haptics;
    this.#messages = messages;
    this.#body.replaceChildren(...effects.map(([name, words]) => {
      const input = make('input', { type: 'checkbox', checked: true, id: `effect-${name}` });
      input.addEventListener('change', () => {
        this.#choice[name] = input.checked;
        haptics.voices.forEach((voice) => this.apply(voice));
      });
      return make('tr', {}, [
        make('th', { scope: 'row' }, [make('label', { title: words }, [input, name])]),
        make('td', { 'data-runs': name, textContent: '0' }),
        make('td', { 'data-cost': name, textContent: '–' }),
      ]);
    }));
    const button = find('#measure-effects');
    button.addEventListener('click', () => void this.measure(button));
  }

  /** @param {import('../../engine/js/haptoflow.d.ts').Voice} voice */
  apply(voice) {
    voice.effects = { ...this.#choice };
  }

  isOn(/** @type {'texture' | 'impact' | 'edge' | 'relief'} */ effect) {
    return this.#choice[effect];
  }

  async measure(/** @type {any} */ button) {
    button.disabled = true;
    button.textContent = 'Measuring …';
    try {
      for (const { effect, microsecondsPerBlock } of await this.#haptics.measureEffects()) {
        const cell = this.#body.querySelector(`[data-cost="${effect}"]`);
        if (cell) cell.textContent = shown(microsecondsPerBlock, 2);
      }
    } catch (error) {
      this.#messages.error(error);
    }
    button.disabled = false;
    button.textContent = 'Measure again';
  }

  /** @param {readonly import('../../engine/js/haptoflow.d.ts').VoiceStatistics[]} statistics */
  show(statistics) {
    for (const [name] of effects) {
      const runs = statistics.reduce((sum, { effects: found }) => sum + (found?.[name]?.runs ?? 0), 0);
      this.#body.querySelector(`[data-runs="${name}"]`).textContent = runs.toLocaleString('en');
    }
  }
}
