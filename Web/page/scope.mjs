import { find } from './dom.mjs';
import { Spectrum } from './spectrum.mjs';

const fullScaleMps2 = 200;
const waveSeconds = 0.2;
const bandCount = 128;
const hopSeconds = 0.016;
const topHz = 1000;
const quietest = 1e-8;
const shownDb = 50;

/** Waveform, spectrogram and level of what is played now. */
export class Scope {
  #taps;
  #rateHz;
  #wave;
  #other;
  #waveCanvas = find('#wave');
  #spectrogramCanvas = find('#spectrogram');
  #meter = find('#level');
  #levelText = find('#level-text');
  #scaleText = find('#wave-scale');
  #peak = 1;
  #spectrum = new Spectrum(2 * bandCount);
  #bands = new Float32Array(bandCount);
  #block = new Float32Array(2 * bandCount);
  #decimated = 0;
  #sum = 0;
  #summed = 0;
  #every;
  #column = new ImageData(1, bandCount);
  #image = document.createElement('canvas');
  #fresh;
  #freshOther;
  #isStepped = matchMedia('(prefers-reduced-motion: reduce)');
  #drawnAt = 0;
  #palette = paletteOf();
  rmsMps2 = 0;
  /** Level of the brightest band of late, dB. */
  #brightestDb = -20;

  /** @param {import('../engine/js/haptoflow.d.ts').WaveTap[]} taps */
  constructor(taps) {
    this.#taps = taps;
    this.#rateHz = taps[0].sampleRateHz;
    const frames = Math.round(waveSeconds * this.#rateHz);
    [this.#wave, this.#other, this.#fresh, this.#freshOther] = [frames, frames, this.#rateHz, this.#rateHz].map((length) => new Float32Array(length));
    this.#every = Math.max(1, Math.round(this.#rateHz / (2 * topHz)));
  }

  /** @param {number} nowMs */
  frame(nowMs) {
    this.#analyse();
    // Without motion the pictures change a few times a second.
    if (nowMs - this.#drawnAt < (this.#isStepped.matches ? 400 : 30)) return;
    this.#drawnAt = nowMs;
    this.#latest();
    this.#drawWave();
    this.#drawLevel();
    this.#drawSpectrogram();
  }

  #latest() {
    this.#wave.fill(0);
    for (const tap of this.#taps) {
      tap.latest(this.#other);
      for (let index = 0; index < this.#wave.length; index += 1) this.#wave[index] += this.#other[index];
    }
    let sum = 0;
    const from = Math.floor(this.#wave.length * 0.75);
    for (let index = from; index < this.#wave.length; index += 1) sum += this.#wave[index] ** 2;
    this.rmsMps2 = fullScaleMps2 * Math.sqrt(sum / (this.#wave.length - from));
  }

  /** New samples at twice `topHz`, and a column of the spectrogram each `hopSeconds`. */
  #analyse() {
    const [first, second] = this.#taps;
    const count = first.read(this.#fresh);
    this.#freshOther.fill(0, 0, count);
    second?.read(count === this.#freshOther.length ? this.#freshOther : this.#freshOther.subarray(0, count));
    for (let index = 0; index < count; index += 1) {
      this.#sum += this.#fresh[index] + this.#freshOther[index];
      this.#summed += 1;
      if (this.#summed < this.#every) continue;
      this.#block[this.#decimated] = (fullScaleMps2 * this.#sum) / this.#every;
      this.#decimated += 1;
      this.#sum = 0;
      this.#summed = 0;
      if (this.#decimated < this.#block.length) continue;
      this.#spectrum.power(this.#block, this.#bands);
      this.#putColumn();
      const hop = Math.round(hopSeconds * 2 * topHz);
      this.#block.copyWithin(0, hop);
      this.#decimated -= hop;
    }
  }

  #putColumn() {
    const { width } = this.#spectrogramCanvas.getBoundingClientRect();
    const columns = Math.max(120, Math.round(width / 2));
    if (this.#image.width !== columns || this.#image.height !== bandCount) Object.assign(this.#image, { width: columns, height: bandCount });
    const context = /** @type {CanvasRenderingContext2D} */ (this.#image.getContext('2d'));
    context.globalCompositeOperation = 'copy';
    context.drawImage(this.#image, -1, 0);
    context.globalCompositeOperation = 'source-over';
    const decibels = (/** @type {number} */ power) => 10 * Math.log10(power + quietest);
    this.#brightestDb = Math.max(-25, this.#brightestDb - 0.02, decibels(Math.max(...this.#bands)));
    for (let band = 0; band < bandCount; band += 1) {
      const share = Math.min(1, Math.max(0, 1 + (decibels(this.#bands[band]) - this.#brightestDb) / shownDb));
      const colour = Math.round(share * 255);
      this.#column.data.set(this.#palette.subarray(4 * colour, 4 * colour + 4), 4 * (bandCount - 1 - band));
    }
    context.putImageData(this.#column, columns - 1, 0);
  }

  #fit(/** @type {HTMLCanvasElement} */ canvas) {
    const ratio = Math.min(2, devicePixelRatio || 1);
    const { width, height } = canvas.getBoundingClientRect();
    const [w, h] = [Math.max(1, Math.round(width * ratio)), Math.max(1, Math.round(height * ratio))];
    if (canvas.width !== w) canvas.width = w;
    if (canvas.height !== h) canvas.height = h;
    return /** @type {CanvasRenderingContext2D} */ (canvas.getContext('2d'));
  }

  #drawWave() {
    const canvas = this.#waveCanvas;
    const context = this.#fit(canvas);
    const { width, height } = canvas;
    let peak = 0;
    for (const sample of this.#wave) peak = Math.max(peak, Math.abs(sample));
    peak *= fullScaleMps2;
    this.#peak = Math.max(peak, 0.5, this.#peak * 0.97);
    // Steps of the scale, so that its number can be read.
    const scale = [1, 2, 5, 10, 20, 50, 100, 200].find((step) => step >= this.#peak) ?? 200;
    this.#scaleText.textContent = `±${scale} m/s²`;
    const style = getComputedStyle(canvas);
    context.clearRect(0, 0, width, height);
    context.strokeStyle = style.borderTopColor;
    context.lineWidth = 1;
    context.beginPath();
    context.moveTo(0, height / 2);
    context.lineTo(width, height / 2);
    context.stroke();
    context.strokeStyle = style.color;
    context.lineWidth = Math.max(1.2, devicePixelRatio);
    context.lineJoin = 'round';
    context.beginPath();
    for (let x = 0; x < width; x += 1) {
      const from = Math.floor((x * this.#wave.length) / width);
      const to = Math.max(from + 1, Math.floor(((x + 1) * this.#wave.length) / width));
      let [low, high] = [Infinity, -Infinity];
      for (let index = from; index < to; index += 1) {
        low = Math.min(low, this.#wave[index]);
        high = Math.max(high, this.#wave[index]);
      }
      const y = (/** @type {number} */ value) => height / 2 - (value * fullScaleMps2 * (height / 2 - 3)) / scale;
      context.lineTo(x, y(high));
      if (low !== high) context.lineTo(x, y(low));
    }
    context.stroke();
  }

  #drawLevel() {
    const share = this.rmsMps2 < 1e-3 ? 0 : Math.min(1, Math.max(0, (20 * Math.log10(this.rmsMps2) + 40) / 66));
    this.#meter.value = share;
    this.#levelText.textContent = this.rmsMps2 < 1e-3 ? 'silent' : `${this.rmsMps2.toFixed(2)} m/s²`;
  }

  #drawSpectrogram() {
    const context = this.#fit(this.#spectrogramCanvas);
    context.imageSmoothingEnabled = false;
    context.drawImage(this.#image, 0, 0, this.#spectrogramCanvas.width, this.#spectrogramCanvas.height);
  }
}

/** 256 colours from nothing to warm light, of one hue after the other, also readable without colour. */
function paletteOf() {
  const stops = [[0, 16, 34, 40, 0], [0.3, 22, 78, 84, 220], [0.6, 58, 150, 134, 255], [0.82, 214, 190, 104, 255], [1, 255, 246, 220, 255]];
  const palette = new Uint8ClampedArray(1024);
  for (let index = 0; index < 256; index += 1) {
    const share = index / 255;
    const at = Math.max(1, stops.findIndex(([begin]) => begin >= share));
    const [a, b] = [stops[at - 1], stops[at]];
    const mix = (share - a[0]) / (b[0] - a[0]);
    for (let part = 0; part < 4; part += 1) palette[4 * index + part] = a[part + 1] + mix * (b[part + 1] - a[part + 1]);
  }
  return palette;
}
