import { colourOfLabel, escapeMarkup } from './labels.mjs';

const pictureWidth = 1000;
const pictureHeight = 100;

/** The smallest of 1, 1.2, 1.5, 2, 3, 4, 5, 6, 8 times a power of ten that is not below `value`; 1 for zero. */
export function niceCeiling(value) {
  if (!(value > 0)) return 1;
  const power = 10 ** Math.floor(Math.log10(value));
  return [1, 1.2, 1.5, 2, 3, 4, 5, 6, 8, 10].map((factor) => factor * power).find((candidate) => candidate >= value * (1 - 1e-9));
}

const shown = (value) => Number(value.toPrecision(3)).toString();

/** One lane of a figure: its content, with the axis in the margin on the left. */
function lane(name, axis, picture, className = '') {
  const ticks = axis.map(({ text, share }) => `<span style="bottom:${(100 * share).toFixed(1)}%">${escapeMarkup(text)}</span>`).join('');
  return `<div class="lane ${className}"><div class="axis"><b>${escapeMarkup(name)}</b>${ticks}</div><div class="picture">${picture}</div></div>`;
}

const svg = (label, content) =>
  `<svg viewBox="0 0 ${pictureWidth} ${pictureHeight}" preserveAspectRatio="none" role="img" aria-label="${escapeMarkup(label)}">${content}</svg>`;

/**
 * The waveform as a band between the minimum and maximum of each column.
 * @param {Float32Array} samples +-1 @param {number} fullScaleMps2 what 1 means @param {number} top of the axis in m/s^2
 */
export function waveformLane(samples, fullScaleMps2, top, label) {
  const columns = Math.min(pictureWidth, samples.length);
  const extremes = Array.from({ length: columns }, (_, column) => {
    let [lowest, highest] = [Infinity, -Infinity];
    const end = Math.floor(((column + 1) * samples.length) / columns);
    for (let index = Math.floor((column * samples.length) / columns); index < end; index += 1) {
      lowest = Math.min(lowest, samples[index]);
      highest = Math.max(highest, samples[index]);
    }
    return [lowest * fullScaleMps2, highest * fullScaleMps2];
  });
  const y = (value) => (pictureHeight * (0.5 - (0.5 * value) / top)).toFixed(2);
  const upper = extremes.map(([, highest], column) => `${column},${y(highest)}`);
  const lower = extremes.map(([lowest], column) => `${column},${y(lowest)}`).reverse();
  const content = `<line class="zero" x1="0" x2="${pictureWidth}" y1="50" y2="50"/><polygon class="wave" points="${[...upper, ...lower].join(' ')}"/>`;
  const axis = [{ text: `+${shown(top)}`, share: 1 }, { text: '0', share: 0.5 }, { text: `−${shown(top)}`, share: 0 }];
  return lane('m/s²', axis, svg(label, content), 'waveform');
}

/** The spectrogram's PNG, 0 to topHz. */
export function spectrogramLane(png, topHz, label) {
  const axis = [0, 0.5, 1].map((share) => ({ text: String(topHz * share), share }));
  const source = `data:image/png;base64,${png.toString('base64')}`;
  return lane('Hz', axis, `<img src="${source}" alt="${escapeMarkup(label)}">`, 'spectrogram');
}

/** A quantity of the contact state over time, as a line with the area below it filled. */
export function quantityLane(name, unit, times, values, seconds) {
  const top = niceCeiling(Math.max(...values));
  const points = values.map((value, index) => `${((pictureWidth * times[index]) / seconds).toFixed(1)},${(pictureHeight * (1 - value / top)).toFixed(1)}`);
  const last = ((pictureWidth * times.at(-1)) / seconds).toFixed(1);
  const content = `<polygon class="quantity" points="0,${pictureHeight} ${points.join(' ')} ${last},${pictureHeight}"/>`;
  const axis = [{ text: shown(top), share: 1 }, { text: '0', share: 0 }];
  return lane(`${name}, ${unit}`, axis, svg(`${name} in ${unit} over time, at most ${shown(Math.max(...values))}`, content), 'quantity');
}

/** Stretches of time that touch the same label: [{label, begin, end}] in seconds. `label` null is no touch. */
export function labelStretches(readings) {
  const stretches = [];
  readings.forEach(({ timeSeconds, label }, index) => {
    const end = readings[index + 1]?.timeSeconds ?? timeSeconds;
    if (stretches.at(-1)?.label === label) stretches.at(-1).end = end;
    else stretches.push({ label, begin: timeSeconds, end });
  });
  return stretches.filter((stretch) => stretch.label !== null);
}

/** The touched label over time, as coloured bands. `text`, where given, is written instead of label names. */
export function bandLane(readings, seconds, text) {
  const bands = labelStretches(readings).map(({ label, begin, end }) => {
    const place = `left:${((100 * begin) / seconds).toFixed(2)}%;width:${((100 * (end - begin)) / seconds).toFixed(2)}%`;
    return `<span style="${place};background:${text ? 'var(--soft)' : colourOfLabel(label)}" title="${escapeMarkup(text ?? label)}, ${begin.toFixed(2)} to ${end.toFixed(2)} s"><b>${escapeMarkup(text ?? label)}</b></span>`;
  });
  return lane('touches', [], bands.join(''), 'bands');
}

/** The time axis below a figure, in seconds. */
export function timeAxis(seconds) {
  const step = seconds > 7 ? 2 : 1;
  const marks = Array.from({ length: Math.floor(seconds / step) + 1 }, (_, index) => index * step);
  const ticks = marks.map((mark) => `<span style="left:${((100 * mark) / seconds).toFixed(2)}%">${mark}${mark === 0 ? ' s' : ''}</span>`);
  return `<div class="lane time"><div class="axis"></div><div class="picture">${ticks.join('')}</div></div>`;
}
