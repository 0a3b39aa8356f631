import assert from 'node:assert/strict';
import test from 'node:test';
import { fullScaleMps2 } from '../../scripts/demo/full_scale.mjs';
import { demoPage } from '../../scripts/demo/page.mjs';
import { assembleReport } from '../../scripts/demo/report.mjs';
import { readContacts } from '../../scripts/demo/stroke_path.mjs';

const rateHz = 48000;

/** One second of a 100 Hz tone on a ball, touched from 0.5 s on. */
function renderOf(name, amplitude, model = 'default.haptoflow') {
  const scene = { surfaces: [{ name: 'ball', shape: { sphere: { radius: 0.1 } }, position: [0, 0, 0], material: 'wood' }] };
  const contactCsv = 't,surface,touching,vx_mps,vy_mps,force_n\n0,,0,0,0,0\n0.5,ball,1,0.3,0.4,1\n1,ball,1,0.3,0.4,1\n';
  const samples = Float32Array.from({ length: rateHz }, (_, index) => amplitude * Math.sin((2 * Math.PI * 100 * index) / rateHz));
  const report = {
    model, labels: ['wood'], wav: 'x.wav', seconds: 1, rms_mps2: (fullScaleMps2 * amplitude) / Math.SQRT2, peak: amplitude, segments: 36,
    inference_ms: { p50: 0.41, p99: 0.73 }, nonfinite: 0, underruns: 0,
  };
  return { name, scene, samples, rateHz, report, contacts: readContacts(contactCsv, 't,x,y,z\n0,0,0.2,0\n1,0,0.1,0\n', scene) };
}

const pageOf = (renders) => demoPage(assembleReport(renders), renders);
const audioOf = (page) => [...page.matchAll(/data:audio\/wav;base64,([^"]+)"/g)].map(([, text]) => Buffer.from(text, 'base64'));
const peakOf = (wav) => {
  let peak = 0;
  for (let at = 44; at < wav.length; at += 2) peak = Math.max(peak, Math.abs(wav.readInt16LE(at)));
  return peak / 32767;
};

test('the players share one gain: the loudest peaks at -1 dBFS, and a signal ten times weaker stays ten times weaker', () => {
  const [loud, quiet] = audioOf(pageOf([renderOf('crossing', 0.2), renderOf('wood', 0.02), renderOf('taps and rims', 0.01)])).map(peakOf);
  assert.ok(Math.abs(20 * Math.log10(loud) + 1) < 0.01, `${loud}`);
  assert.ok(Math.abs(loud / quiet - 10) < 0.02, `${loud / quiet}`);
});

test('the page states the gain, the model, its origin and the measured figures', () => {
  const page = pageOf([renderOf('crossing', 0.2), renderOf('wood', 0.02), renderOf('taps and rims', 0.01)]);
  assert.ok(page.includes('+13.0 dB'));
  assert.ok(page.includes('default.haptoflow') && page.includes('trained on synthetic recordings'));
  for (const figure of [(fullScaleMps2 * 0.2 / Math.SQRT2).toFixed(2), (fullScaleMps2 * 0.2).toFixed(1), '0.41', '0.73']) assert.ok(page.includes(`>${figure}<`), figure);
});

test('the page has no reference to the network and no unfilled placeholder', () => {
  const page = pageOf([renderOf('crossing', 0.2), renderOf('wood', 0.02), renderOf('taps and rims', 0.01)]);
  assert.ok(!/(?:src|href)="(?!data:|#)/.test(page));
  assert.ok(!/\{\{|undefined|NaN/.test(page.replace(/data:[^"]*/g, '')));
});

test('markup in names is escaped', () => {
  const page = pageOf([renderOf('crossing', 0.2, '<u>model'), renderOf('<script>boom', 0.02, '<u>model'), renderOf('taps and rims', 0.01, '<u>model')]);
  assert.ok(!page.includes('<script>boom') && !page.includes('<u>model'));
});

test('a page is made of silent renders, too', () => {
  const page = pageOf([renderOf('crossing', 0), renderOf('wood', 0)]);
  assert.ok(!/NaN|Infinity/.test(page.replace(/data:[^"]*/g, '')));
});

test('each player has one element that takes the keyboard focus: its button', () => {
  const page = pageOf([renderOf('crossing', 0.2), renderOf('wood', 0.02), renderOf('glass', 0.01)]);
  const articles = [...page.matchAll(/<article[\s\S]*?<\/article>/g)].map(([article]) => article);
  assert.equal(articles.length, 3);
  for (const article of articles) {
    assert.deepEqual([...article.matchAll(/<(button|a|input|select|textarea|iframe)\b|\b(tabindex|controls|contenteditable)\b/g)].map(([found]) => found), ['<button']);
  }
});

test('all waveforms have one scale, which the page states, and a weaker render is drawn lower', () => {
  const page = pageOf([renderOf('crossing', 0.19), renderOf('wood', 0.019)]);
  assert.ok(page.includes('<strong>±40 m/s²</strong>'));
  const lanes = [...page.matchAll(/<div class="lane waveform">[\s\S]*?<\/svg>/g)].map(([lane]) => lane);
  assert.equal(lanes.length, 2);
  const [loud, quiet] = lanes.map((lane) => {
    assert.ok(lane.includes('>+40<') && lane.includes('>−40<'));
    const heights = [...lane.match(/points="([^"]+)"/)[1].matchAll(/,([\d.]+)/g)].map(([, y]) => Number(y));
    return Math.max(...heights) - Math.min(...heights);
  });
  assert.ok(Math.abs(loud / quiet - 10) < 0.1, `${loud} and ${quiet}`);
});

test('each label\'s level is written beside its name', () => {
  assert.match(pageOf([renderOf('crossing', 0.2), renderOf('wood', 0.02), renderOf('taps and rims', 0.01)]), /<span>wood <em>2\.8 m\/s² RMS<\/em><\/span>/);
});
