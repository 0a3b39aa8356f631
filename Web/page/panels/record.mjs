import { download, find } from '../dom.mjs';
import { sentenceOf } from '../messages.mjs';

/** Record, stop, and the files: what is heard, the strokes, and the scene as it is painted, with its reliefs. */
export class RecordPanel {
  #recorder;
  #sceneNow;
  #reliefChanges;
  #changesBefore = 0;
  #button = find('#record');
  #time = find('#record-time');
  #files = find('#record-files');
  /** @type {({wav: Uint8Array, seconds: number, strokes: string[]} & import('../table/reliefs.mjs').SceneWithReliefs) | null} */
  last = null;

  /**
   * @param {import('../recorder.mjs').Recorder} recorder @param {() => import('../table/reliefs.mjs').SceneWithReliefs} sceneNow
   * @param {() => number} reliefChanges so far
   */
  constructor(recorder, sceneNow, reliefChanges) {
    this.#recorder = recorder;
    this.#sceneNow = sceneNow;
    this.#reliefChanges = reliefChanges;
    recorder.onLimit = () => this.#stop();
    this.#button.addEventListener('click', () => (recorder.isRunning ? this.#stop() : this.#start()));
    find('#download-wav').addEventListener('click', () => this.last && download('felt.wav', /** @type {any} */ (this.last.wav), 'audio/wav'));
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

  #start() {
    this.#recorder.start();
    this.#changesBefore = this.#reliefChanges();
    this.#files.hidden = true;
    this.#button.textContent = 'Stop';
    this.#button.classList.add('is-recording');
  }

  #stop() {
    if (!this.#recorder.isRunning) return;
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
