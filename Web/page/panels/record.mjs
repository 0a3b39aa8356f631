import { download, find } from '../dom.mjs';
import { sentenceOf } from '../messages.mjs';
import { longestSeconds, wavBytes } from '../recorder.mjs';

const clipFormats = /** @type {const} */ (['haptic', 'ahap', 'hjif']);

/** Record, stop, and the files: what is heard, as sound and as clips, the strokes, and the scene as it is painted, with its reliefs. */
export class RecordPanel {
  #recorder;
  #haptics;
  #sceneNow;
  #reliefChanges;
  #changesBefore = 0;
  #button = find('#record');
  #time = find('#record-time');
  #files = find('#record-files');
  /** Of the last recording, once one is asked for. @type {Promise<import('../../engine/js/haptoflow.d.ts').Clip> | null} */
  #clip = null;
  /** @type {(ReturnType<import('../recorder.mjs').Recorder['stop']> & import('../table/reliefs.mjs').SceneWithReliefs) | null} */
  last = null;

  /**
   * @param {import('../recorder.mjs').Recorder} recorder @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {() => import('../table/reliefs.mjs').SceneWithReliefs} sceneNow
   * @param {() => number} reliefChanges so far
   */
  constructor(recorder, haptics, sceneNow, reliefChanges) {
    this.#recorder = recorder;
    this.#haptics = haptics;
    this.#sceneNow = sceneNow;
    this.#reliefChanges = reliefChanges;
    recorder.onLimit = () => this.#stop();
    this.#button.addEventListener('click', () => (recorder.isRunning ? this.#stop() : this.#start()));
    find('#download-wav').addEventListener('click', () => this.last && download('felt.wav', /** @type {any} */ (wavBytes(this.last.samples, this.last.rateHz)), 'audio/wav'));
    for (const format of clipFormats) find(`#download-${format}`).addEventListener('click', () => void this.#downloadClip(format));
    find('#download-csv').addEventListener('click', () => this.last?.strokes.forEach((stroke, index) => download(index === 0 ? 'stroke.csv' : `stroke-${index + 1}.csv`, stroke, 'text/csv')));
    find('#download-reliefs').addEventListener('click', () => void this.#downloadReliefs());
    find('#download-scene').addEventListener('click', () => this.last && download('scene.json', `${JSON.stringify(this.last.scene, null, 2)}\n`, 'application/json'));
  }

  async #downloadReliefs() {
    try {
      for (const [name, png] of this.last?.files ?? []) download(name, /** @type {any} */ (await png()), 'image/png');
    } catch (error) {
      find('#record-note').textContent = sentenceOf(error);
    }
  }

  async #downloadClip(/** @type {typeof clipFormats[number]} */ format) {
    if (!this.last) return;
    const { samples, rateHz, materials } = this.last;
    try {
      this.#clip ??= this.#haptics.createClip({
        // The recorder looks a few times a second only whether it is long enough.
        samples: samples.slice(0, longestSeconds * rateHz),
        rateHz,
        title: materials.join(', ') || 'nothing touched',
        description: 'recorded on the live page of HaptoFlow',
      });
      download(`felt.${format}`, (await this.#clip).files[format], 'application/json');
    } catch (error) {
      this.#clip = null;
      find('#record-note').textContent = sentenceOf(error);
    }
  }

  #start() {
    this.#recorder.start();
    this.#changesBefore = this.#reliefChanges();
    this.#files.hidden = true;
    this.#button.textContent = 'Stop';
    this.#button.classList.add('is-recording');
  }

  #stop() {
    if (!this.#recorder.isRunning) return;
    this.#clip = null;
    this.last = { ...this.#recorder.stop(), ...this.#sceneNow() };
    this.#button.textContent = 'Record';
    this.#button.classList.remove('is-recording');
    this.#time.textContent = `${this.last.seconds.toFixed(1)} s recorded`;
    this.#files.hidden = false;
    find('#download-csv').disabled = this.last.strokes.length === 0;
    find('#download-reliefs').hidden = this.last.files.size === 0;
    find('#record-note').textContent = this.#reliefChanges() === this.#changesBefore ? '' : 'A picture was laid or taken off meanwhile: before that, another relief was felt.';
  }

  frame() {
    if (this.#recorder.isRunning) this.#time.textContent = `${this.#recorder.seconds.toFixed(1)} s`;
  }
}
