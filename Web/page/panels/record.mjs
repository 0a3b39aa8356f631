import { download, find } from '../dom.mjs';

/** Record, stop, and the files: what is heard, the strokes, and the scene as it is painted. */
export class RecordPanel {
  #recorder;
  #sceneNow;
  #button = find('#record');
  #time = find('#record-time');
  #files = find('#record-files');
  /** @type {{wav: Uint8Array, seconds: number, strokes: string[], scene: any} | null} */
  last = null;

  /** @param {import('../recorder.mjs').Recorder} recorder @param {() => any} sceneNow */
  constructor(recorder, sceneNow) {
    this.#recorder = recorder;
    this.#sceneNow = sceneNow;
    recorder.onLimit = () => this.#stop();
    this.#button.addEventListener('click', () => (recorder.isRunning ? this.#stop() : this.#start()));
    find('#download-wav').addEventListener('click', () => this.last && download('felt.wav', /** @type {any} */ (this.last.wav), 'audio/wav'));
    find('#download-csv').addEventListener('click', () => this.last?.strokes.forEach((stroke, index) => download(index === 0 ? 'stroke.csv' : `stroke-${index + 1}.csv`, stroke, 'text/csv')));
    find('#download-scene').addEventListener('click', () => this.last && download('scene.json', `${JSON.stringify(this.last.scene, null, 2)}\n`, 'application/json'));
  }

  #start() {
    this.#recorder.start();
    this.#files.hidden = true;
    this.#button.textContent = 'Stop';
    this.#button.classList.add('is-recording');
  }

  #stop() {
    if (!this.#recorder.isRunning) return;
    this.last = { ...this.#recorder.stop(), scene: this.#sceneNow() };
    this.#button.textContent = 'Record';
    this.#button.classList.remove('is-recording');
    this.#time.textContent = `${this.last.seconds.toFixed(1)} s recorded`;
    this.#files.hidden = false;
    find('#download-csv').disabled = this.last.strokes.length === 0;
  }

  frame() {
    if (this.#recorder.isRunning) this.#time.textContent = `${this.#recorder.seconds.toFixed(1)} s`;
  }
}
