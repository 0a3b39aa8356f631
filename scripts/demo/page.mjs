import { readFileSync } from 'node:fs';
import os from 'node:os';
import { bandLane, niceCeiling, quantityLane, spectrogramLane, timeAxis, waveformLane } from './charts.mjs';
import { fullScaleMps2 } from './full_scale.mjs';
import { colourOfLabel, escapeMarkup, slug } from './labels.mjs';
import { drawScene } from './scene_drawing.mjs';
import { colourOf, spectrogram, spectrogramPng } from './spectrogram.mjs';
import { commonGain, writePcm16Wav } from './wav.mjs';

const topHz = 1000;
const dynamicRangeDb = 60;

const asset = (name) => readFileSync(new URL(name, import.meta.url), 'utf8');

/**
 * The demo's page: one self-contained HTML file.
 * @param {{model: string, renders: object[]}} report as of assembleReport
 * @param {{name, scene, contacts, samples: Float32Array, rateHz: number}[]} renders in the report's order: the crossing first,
 *   the taps last
 */
export function demoPage(report, renders) {
  const gain = commonGain(renders.map(({ samples }) => samples));
  const pictures = renders.map(({ samples, rateHz }) => spectrogram(samples, rateHz, topHz));
  const loudest = Math.max(...pictures.map(({ amplitudes }) => amplitudes.reduce((a, b) => Math.max(a, b), 0)));
  const topDb = loudest > 0 ? 5 * Math.ceil((20 * Math.log10(loudest * fullScaleMps2)) / 5) : 0;
  const range = { bottomDb: topDb - dynamicRangeDb, topDb };
  // All waveforms share one scale, so that their heights can be compared.
  const topMps2 = niceCeiling(fullScaleMps2 * Math.max(...renders.map(({ samples }) => peakOf(samples))));
  const isWhole = (index) => index === 0 || index === renders.length - 1;
  const figures = renders.map((render, index) => figureOf(render, pictures[index], { ...range, topMps2, gain }, isWhole(index)));
  const [fromAbove, fromFront] = drawScene(renders[0].scene, renders[0].contacts);
  const [crossing, ...traced] = figures;
  const taps = traced.pop();
  const content = {
    style: asset('./page.css'),
    script: asset('./player.js'),
    model: escapeMarkup(report.model),
    fromAbove,
    fromFront,
    scale: `±${topMps2} m/s²`,
    surfaces: String(renders[0].scene.surfaces.length),
    crossing,
    traced: traced.join('\n'),
    tracedCount: String(traced.length),
    taps,
    contact: contactLanes(renders[1], 'plate'),
    table: table(report),
    legend: legend(range),
    gain: `${signed((20 * Math.log10(gain)).toFixed(1))} dB`,
    fullScale: String(fullScaleMps2),
    machine: escapeMarkup(`${os.cpus()[0]?.model.trim() ?? 'unknown processor'}, ${os.cpus().length} cores`),
  };
  return asset('./page.html').replace(/\{\{(\w+)\}\}/g, (_, key) => content[key]);
}

const peakOf = (samples) => samples.reduce((peak, sample) => Math.max(peak, Math.abs(sample)), 0);

const secondsOf = ({ samples, rateHz }) => samples.length / rateHz;

/** A number with its sign, a true minus. */
const signed = (value) => `${Number(value) > 0 ? '+' : ''}${String(value).replace('-', '−')}`;

function contactLanes(render, touchText) {
  const seconds = secondsOf(render);
  const times = render.contacts.map(({ timeSeconds }) => timeSeconds);
  return [
    bandLane(render.contacts, seconds, touchText),
    quantityLane('speed', 'm/s', times, render.contacts.map(({ speedMps }) => speedMps), seconds),
    quantityLane('force', 'N', times, render.contacts.map(({ forceNewtons }) => forceNewtons), seconds),
    timeAxis(seconds),
  ].join('\n');
}

function figureOf(render, picture, { bottomDb, topDb, topMps2, gain }, isWhole) {
  const { name, samples, rateHz, report } = render;
  const seconds = secondsOf(render);
  const inMps2 = { ...picture, amplitudes: picture.amplitudes.map((amplitude) => amplitude * fullScaleMps2) };
  const lanes = [
    waveformLane(samples, fullScaleMps2, topMps2, `Waveform of ${name}`),
    spectrogramLane(spectrogramPng(inMps2, bottomDb, topDb), topHz, `Spectrogram of ${name}, 0 to ${topHz} Hz`),
    isWhole ? contactLanes(render) : timeAxis(seconds),
  ];
  const audio = `data:audio/wav;base64,${writePcm16Wav(samples, rateHz, gain).toString('base64')}`;
  const title = isWhole
    ? '<span>The whole stroke</span>'
    : `<i style="background:${colourOfLabel(name)}"></i><span>${escapeMarkup(name)} <em>${report.rms_mps2.toFixed(1)} m/s² RMS</em></span>`;
  return `<article class="render" id="${slug(name)}"><h3><button type="button" data-name="${escapeMarkup(name)}"></button>${title}
<output>${seconds.toFixed(1)} s</output></h3>
<div class="lanes" data-seconds="${seconds}">${lanes.join('\n')}<div class="playhead" aria-hidden="true"></div></div>
<audio preload="metadata" src="${audio}"></audio></article>`;
}

function table({ renders }) {
  const strongest = Math.max(...renders.map((render) => render.rms_mps2));
  const rows = renders.map((render) => {
    const share = strongest > 0 ? (100 * render.rms_mps2) / strongest : 0;
    return `<tr><th scope="row"><a href="#${slug(render.name)}">${escapeMarkup(render.name)}</a></th>
<td class="bar"><span style="width:${share.toFixed(1)}%;background:${colourOfLabel(render.name)}"></span></td><td>${render.rms_mps2.toFixed(2)}</td>
<td>${(render.peak * fullScaleMps2).toFixed(1)}</td><td>${render.segments}</td><td>${render.inference_ms.p50.toFixed(2)}</td>
<td>${render.inference_ms.p99.toFixed(2)}</td><td>${render.underruns}</td><td>${render.nonfinite}</td></tr>`;
  });
  return rows.join('\n');
}

function legend({ bottomDb, topDb }) {
  const stops = Array.from({ length: 17 }, (_, step) => `rgb(${colourOf(step / 16).join(' ')})`);
  return `<div class="legend" role="img" aria-label="Colours of the spectrograms: dark is ${bottomDb} dB, bright is ${topDb} dB, relative to 1 m/s²">
<span>${signed(bottomDb)} dB</span><i style="background:linear-gradient(to right,${stops.join(',')})"></i><span>${signed(topDb)} dB re 1 m/s²</span></div>`;
}
