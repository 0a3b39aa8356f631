import { download, find } from '../dom.mjs';
import { sentenceOf } from '../messages.mjs';

const isRecording = (/** @type {string} */ name) => /\.(csv|wav)$/i.test(name);
/** The recording first, then its sidecar and its table of motion, which are smaller. */
const byRole = (/** @type {File} */ a, /** @type {File} */ b) => Number(isRecording(b.name)) - Number(isRecording(a.name)) || b.size - a.size;

/** Dropped or chosen recordings become materials. */
export class OwnMaterialPanel {
  #haptics;
  #onMaterial;
  #area = find('#drop');
  #progress = find('#learn-progress');
  #bar = find('#learn-bar');
  #doing = find('#learn-doing');
  #result = find('#learn-result');
  #save = find('#learn-save');
  /** Of processor time for one fit. */
  secondsLimit = 20;
  /** @type {AbortController | null} */
  #abort = null;
  /** @type {import('../../engine/js/haptoflow.d.ts').LearntMaterial | null} */
  #learnt = null;

  /** @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {(name: string) => void} onMaterial @param {(files: File[], event: DragEvent) => boolean} takeOther whether dropped files are of another kind, which it then takes */
  constructor(haptics, onMaterial, takeOther) {
    this.#haptics = haptics;
    this.#onMaterial = onMaterial;
    const input = find('#recording');
    input.addEventListener('change', () => {
      void this.learn([...input.files]);
      input.value = '';
    });
    find('#learn-cancel').addEventListener('click', () => this.#abort?.abort());
    this.#save.addEventListener('click', () => this.#learnt && download(`${this.#learnt.name}.haptomaterial`, this.#learnt.material, 'application/json'));
    // Anywhere on the page, so that no drop makes the browser leave it.
    document.addEventListener('dragover', (event) => {
      event.preventDefault();
      this.#area.classList.add('is-over');
    });
    document.addEventListener('dragleave', (event) => {
      if (!event.relatedTarget) this.#area.classList.remove('is-over');
    });
    document.addEventListener('drop', (event) => {
      event.preventDefault();
      this.#area.classList.remove('is-over');
      const files = [...(event.dataTransfer?.files ?? [])];
      if (files.length > 0 && !takeOther(files, event)) void this.learn(files);
    });
  }

  /** @param {File[]} files */
  async learn(files) {
    if (this.#abort) {
      this.#result.textContent = 'One recording at a time: wait, or cancel the one that is being learnt.';
      return;
    }
    const ordered = [...files].sort(byRole);
    this.#save.hidden = true;
    if (ordered.length === 0 || !isRecording(ordered[0].name)) {
      this.#result.textContent = 'A recording is a .csv or .wav file; drop its .json beside it where it has one.';
      return;
    }
    const abort = new AbortController();
    this.#abort = abort;
    this.#progress.hidden = false;
    this.#result.textContent = '';
    try {
      const recording = await Promise.all(ordered.map(async (file) => ({ name: file.name, bytes: await file.arrayBuffer() })));
      const learnt = await this.#haptics.learn({
        recording,
        secondsLimit: this.secondsLimit,
        signal: abort.signal,
        onProgress: (share, doing) => {
          this.#bar.value = share;
          this.#doing.textContent = `${doing} (${Math.round(100 * share)} %)`;
        },
      });
      await this.#haptics.addMaterial(learnt.material);
      this.#learnt = learnt;
      this.#save.hidden = false;
      this.#result.textContent = [`“${learnt.name}” is in the palette: paint an object with it.`, ...learnt.notes].join(' ');
      this.#onMaterial(learnt.name);
    } catch (error) {
      this.#result.textContent = /** @type {any} */ (error).code === 'aborted' ? 'Cancelled.' : sentenceOf(error);
    }
    this.#abort = null;
    this.#progress.hidden = true;
  }
}
