import { find, make } from '../dom.mjs';
import { sentenceOf } from '../messages.mjs';

/** What the library reads at most, and a byte by which it sees that there is more. */
const mostBytes = 2 ** 24 + 1;
/** For the last transient's end, and for what the sound lags behind. */
const tailSeconds = 0.2;
/** Longer than statistics need without shared memory. */
const lookEveryMs = 400;
/** Reasons for which the engine has ended a clip. */
const endings = /** @type {Record<string, string>} */ ({ muted: 'the sound is muted', paused: 'the sound is paused', panic: 'it was silenced' });

/** @param {{name: string}} file */
export const isClip = ({ name }) => /\.(haptic|ahap|hjif)$/i.test(name);

const counted = (/** @type {number} */ count, /** @type {string} */ noun) => `${count.toLocaleString('en')} ${noun}${count === 1 ? '' : 's'}`;

/** A file's clip in a sentence. @param {string} name @param {import('../../engine/js/haptoflow.d.ts').Clip} clip */
export function clipSentence(name, { seconds, amplitudePoints, frequencyPoints, transients, title, editor, omitted }) {
  const origin = [title, editor && `by ${editor}`].filter(Boolean).join(', ');
  return [
    `“${name}”${origin ? ` (${origin})` : ''}: ${seconds.toFixed(1)} s, ${counted(amplitudePoints, 'point')} of amplitude, ${frequencyPoints === 0 ? 'no frequency, so 160 Hz' : `${frequencyPoints.toLocaleString('en')} of frequency`}, ${counted(transients.length, 'transient')}.`,
    omitted ? `Left out: ${omitted}.` : '',
  ].filter((sentence) => sentence !== '').join(' ');
}

/** An author's clip, played beside the texture under the first tip, and its curves. */
export class ClipPanel {
  #haptics;
  #tip;
  #play = find('#clip-play');
  #loop = find('#clip-loop');
  #note = find('#clip-note');
  #shown = find('#clip-shown');
  /** @type {[any, any]} */
  #canvases = [find('#clip-amplitude'), find('#clip-frequency')];
  /** @type {import('../../engine/js/haptoflow.d.ts').Clip | null} */
  clip = null;
  #isPlaying = false;
  /** When it began to sound; NaN while it loads. */
  #beganMs = NaN;
  /** When the engine was last asked whether it still plays, and how many blocks it had played then. */
  #lookedMs = 0;
  #runs = -1;
  /** Only the newest file is read. */
  #wishes = 0;
  /** The curves without the place of now, drawn once for each width. @type {HTMLCanvasElement[]} */
  #pictures = [];

  /** @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} haptics @param {import('../table/tip.mjs').Tip} tip */
  constructor(haptics, tip) {
    this.#haptics = haptics;
    this.#tip = tip;
    const input = find('#clip-file');
    input.addEventListener('change', () => {
      if (input.files.length > 0) void this.take(input.files[0]);
      input.value = '';
    });
    this.#play.addEventListener('click', () => (this.#isPlaying ? this.stop() : void this.play()));
    this.#loop.addEventListener('change', () => this.#isPlaying && void this.play());
    // A fault and a hidden page end it.
    haptics.addEventListener('error', () => this.#end());
    document.addEventListener('visibilitychange', () => document.visibilityState === 'hidden' && this.#end());
  }

  /** @param {File} file */
  async take(file) {
    this.#wishes += 1;
    const wish = this.#wishes;
    this.#note.textContent = `Reading ${file.name} …`;
    try {
      const clip = await this.#haptics.readClip(await file.slice(0, mostBytes).text());
      if (wish !== this.#wishes) return;
      const wasPlaying = this.#isPlaying;
      if (this.clip) this.#haptics.forgetClip(this.clip);
      this.clip = clip;
      this.#note.textContent = clipSentence(file.name, clip);
      this.#pictures = [];
      this.#shown.hidden = false;
      this.#describe();
      if (wasPlaying) await this.play();
    } catch (error) {
      if (wish === this.#wishes) this.#note.textContent = `${file.name}: ${sentenceOf(error)}`;
    }
  }

  async play() {
    const { clip } = this;
    if (!clip) return;
    this.#isPlaying = true;
    this.#beganMs = NaN;
    this.#play.textContent = 'Stop';
    try {
      await this.#haptics.resume();
      // A voice needs states; one that has had none for a while would end the clip at once.
      this.#keepAlive();
      await this.#tip.voice.playClip(clip, { isLoop: this.#loop.checked });
      if (this.clip === clip && this.#isPlaying) this.#beganMs = performance.now();
    } catch (error) {
      this.#end();
      this.#note.textContent = sentenceOf(error);
    }
  }

  stop() {
    this.#tip.voice.stopClip();
    this.#end();
  }

  #end() {
    this.#isPlaying = false;
    this.#play.textContent = 'Play';
  }

  #keepAlive() {
    if (!this.#tip.isDown) this.#tip.voice.lift();
  }

  frame() {
    if (!this.clip) return;
    if (this.#isPlaying) this.#follow();
    this.#draw();
  }

  #follow() {
    this.#keepAlive();
    const now = performance.now();
    const { seconds } = /** @type {import('../../engine/js/haptoflow.d.ts').Clip} */ (this.clip);
    if (!this.#loop.checked && now > this.#beganMs + 1000 * (seconds + tailSeconds)) this.#end();
    else if (now > Math.max(this.#beganMs, this.#lookedMs) + lookEveryMs) this.#look(now);
  }

  /** Whether the engine still plays it. */
  #look(/** @type {number} */ now) {
    const { voice } = this.#tip;
    const { silence, effects } = voice.statistics();
    const hasRun = effects?.clip.runs !== this.#runs;
    this.#lookedMs = now;
    this.#runs = effects?.clip.runs ?? -1;
    if (hasRun || silence === 'context') return;
    const why = endings[silence];
    // The page stood still for longer than a voice goes without states.
    if (!why && this.#loop.checked && this.clip?.seconds !== 0) {
      void this.play();
      return;
    }
    this.#end();
    this.#note.textContent = `The clip has ended: ${why ?? 'the page was too busy for it'}.`;
  }

  /** Where it plays now, 0 to 1; -1 while it does not. */
  get #place() {
    const { seconds } = /** @type {any} */ (this.clip);
    const at = (performance.now() - this.#beganMs) / 1000;
    if (!this.#isPlaying || !(at >= 0) || seconds === 0) return -1;
    return this.#loop.checked ? (at / seconds) % 1 : Math.min(1, at / seconds);
  }

  #describe() {
    const { largestAmplitude, frequencyHz, frequencyPoints, transients, seconds } = /** @type {import('../../engine/js/haptoflow.d.ts').Clip} */ (this.clip);
    const range = frequencyHz.reduce(([least, most], hz) => [Math.min(least, hz), Math.max(most, hz)], [Infinity, 0]).map(Math.round);
    const words = frequencyPoints === 0 ? 'left to the device' : `${range[0]} to ${range[1]} Hz`;
    find('#clip-range').textContent = words;
    this.#canvases[0].setAttribute('aria-label', `Amplitude over ${seconds.toFixed(1)} seconds, ${Math.round(100 * largestAmplitude)} % of the range at most, with ${counted(transients.length, 'transient')}`);
    this.#canvases[1].setAttribute('aria-label', `Frequency over the same time: ${words}`);
  }

  #draw() {
    const place = this.#place;
    this.#canvases.forEach((canvas, row) => {
      const ratio = Math.min(2, devicePixelRatio || 1);
      const { width, height } = canvas.getBoundingClientRect();
      const [w, h] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
      if (this.#pictures[row]?.width !== w || this.#pictures[row].height !== h) this.#pictures[row] = this.#pictureOf(canvas, row, w, h);
      else if (place < 0 && canvas.dataset.isAtRest === 'yes') return;
      canvas.dataset.isAtRest = place < 0 ? 'yes' : 'no';
      Object.assign(canvas, { width: w, height: h });
      const context = canvas.getContext('2d');
      context.drawImage(this.#pictures[row], 0, 0);
      context.fillStyle = getComputedStyle(canvas).color;
      if (place >= 0) context.fillRect(Math.round(place * (w - 2 * ratio)), 0, 2 * ratio, h);
    });
  }

  /** The largest value of each column, since a long clip has more points than columns. */
  #pictureOf(/** @type {HTMLCanvasElement} */ canvas, /** @type {number} */ row, /** @type {number} */ width, /** @type {number} */ height) {
    canvas.dataset.isAtRest = 'no';
    const { amplitude, frequencyHz, transients, seconds } = /** @type {import('../../engine/js/haptoflow.d.ts').Clip} */ (this.clip);
    const values = row === 0 ? amplitude : frequencyHz;
    const top = row === 0 ? 1 : Math.max(400, values.reduce((most, hz) => Math.max(most, hz), 0));
    const picture = make('canvas', { width, height });
    const context = picture.getContext('2d');
    const heightOf = (/** @type {number} */ value) => height - 2 - (value / top) * (height - 4);
    context.strokeStyle = getComputedStyle(canvas).color;
    context.fillStyle = context.strokeStyle;
    context.lineWidth = Math.max(1.2, devicePixelRatio);
    context.beginPath();
    for (let x = 0; x < width; x += 1) {
      const from = Math.floor((x * (values.length - 1)) / width);
      const to = Math.max(from + 1, Math.ceil(((x + 1) * (values.length - 1)) / width));
      let most = 0;
      for (let index = from; index < to; index += 1) most = Math.max(most, values[index]);
      context.lineTo(x, heightOf(most));
    }
    context.stroke();
    if (row > 0) return picture;
    context.globalAlpha = 0.5;
    for (const { timeSeconds, amplitude: share } of transients) {
      const x = seconds > 0 ? (timeSeconds / seconds) * width : 0;
      context.fillRect(x, heightOf(share), context.lineWidth, height - heightOf(share));
    }
    return picture;
  }
}
