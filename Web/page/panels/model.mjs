import { find } from '../dom.mjs';
import { forgetModel, isModel, keepModel } from '../model-file.mjs';

/** Which model plays, another one by a file, and the way back. */
export class ModelPanel {
  #note = find('#model-note');

  /**
   * @param {{name: string, statement: string, labels: readonly unknown[]}} model the one that plays
   * @param {string} fileName of a model that the user gave; empty for the shipped one
   * @param {() => void} restart starts the page again, with the model that is then kept
   */
  constructor(model, fileName, restart) {
    this.restart = restart;
    const of = fileName === '' ? 'The shipped model' : `${fileName}: ${model.name}`;
    find('#model-line').textContent = `${of}, ${model.labels.length} materials, ${model.statement}.`;
    const back = find('#model-back');
    back.hidden = fileName === '';
    back.addEventListener('click', () => void forgetModel().then(restart));
    const input = find('#model-file');
    input.addEventListener('change', () => void this.take([...input.files]));
  }

  /** Takes the model among files. Returns whether there is one. @param {File[]} files */
  take(files) {
    const file = files.find(({ name }) => isModel(name));
    if (file) void this.#begin(file);
    else if (files.length > 0) this.#note.textContent = 'A model is a .haptoflow file.';
    return file !== undefined;
  }

  async #begin(/** @type {File} */ file) {
    this.#note.textContent = `Keeping ${file.name} (${(file.size / 1e6).toFixed(1)} MB) …`;
    try {
      await keepModel(file);
      this.restart();
    } catch (error) {
      const { message } = /** @type {Error} */ (error);
      this.#note.textContent = `${message}${/[.!?]$/.test(message) ? '' : '.'}`;
    }
  }
}
