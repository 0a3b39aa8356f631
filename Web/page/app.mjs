import { HaptoFlow } from './engine/haptoflow.mjs';
import { find, make, shown, slider } from './dom.mjs';
import { Hand } from './table/hand.mjs';
import { presetStrokes } from './table/preset-strokes.mjs';
import { Tip } from './table/tip.mjs';
import { fittedTo, forgetModel, isModel, keptModel } from './model-file.mjs';
import { deviceSentences, materialWords, Messages, sentenceOf, silenceSentence } from './messages.mjs';
import { ClipPanel, isClip } from './panels/clip.mjs';
import { ComparePanel } from './panels/compare.mjs';
import { DevicePanel } from './panels/device.mjs';
import { EffectsPanel } from './panels/effects.mjs';
import { Outputs } from './panels/outputs.mjs';
import { ModelPanel } from './panels/model.mjs';
import { OwnMaterialPanel } from './panels/own-material.mjs';
import { Palette } from './panels/palette.mjs';
import { QualityPanel } from './panels/quality.mjs';
import { RecordPanel } from './panels/record.mjs';
import { isPicture, ReliefPanel } from './panels/relief.mjs';
import { Recorder } from './recorder.mjs';
import { Ears } from './ears.mjs';
import { Scope } from './scope.mjs';
import { Fills } from './table/fills.mjs';
import { ProfileView } from './table/profile.mjs';
import { reliefsOf, TableReliefs } from './table/reliefs.mjs';
import { TableView } from './table/table-view.mjs';
import { Table } from './table/table.mjs';

const updateRateHz = 120;
const tipCount = 2;
const statisticsEveryMs = 250;
const announceEveryMs = 1200;
const scopeName = 'Pictures of the signal';
const headsetName = 'Headset';
const epochMs = performance.now();

const messages = new Messages();
// From here on the page itself reports what fails, so the text for a page that does not start goes.
find('#not-started').remove();
const readJson = async (/** @type {string} */ name) => {
  const address = new URL(name, import.meta.url);
  const response = await fetch(address);
  if (!response.ok) throw new Error(`${address}: the server answers ${response.status}`);
  return response.json();
};

/** Objects that move stand still for who asked for less motion. */
function withoutMotion(/** @type {any} */ scene) {
  return { ...scene, surfaces: scene.surfaces.map((/** @type {any} */ surface) => {
    if (!surface.motion) return surface;
    const { motion, ...rest } = surface;
    return { ...rest, position: motion.keyframes[0].position };
  }) };
}

const start = {
  layer: find('#start'), text: find('#start-text'), bar: find('#start-bar'), button: find('#start-button'), back: find('#start-back'),
  progress(/** @type {number} */ share, /** @type {string} */ doing) {
    this.text.textContent = `${doing.charAt(0).toUpperCase()}${doing.slice(1)} …`;
    this.bar.value = share;
  },
  /** @param {any} error @param {(() => void) | null} [giveUp] the way back to the shipped model, where another one was given */
  fail(error, giveUp = null) {
    messages.error(error);
    this.layer.hidden = false;
    this.layer.classList.remove('is-open');
    this.bar.hidden = true;
    this.text.textContent = 'The page cannot go on.';
    this.button.textContent = 'Try again';
    this.button.hidden = false;
    this.button.addEventListener('click', () => location.reload(), { once: true });
    this.back.hidden = giveUp === null;
    if (giveUp) this.back.addEventListener('click', giveUp, { once: true });
  },
};

class Page {
  /** The engine is closed for good. */
  #isOver = false;
  #shownRingFrames = NaN;
  /** Null where the browser cannot draw it. @type {Scope | null} */
  scope = null;
  profile = new ProfileView();
  /** Lets a voice follow the page's controls. @type {(voice: import('../engine/js/haptoflow.d.ts').Voice) => void} */
  adopt;

  /**
   * @param {HaptoFlow} haptics @param {any} scene @param {any} looks @param {TableView} view @param {Table} table @param {Fills} fills @param {Tip[]} tips
   * @param {TableReliefs} reliefs @param {string} fileName of the model that was given, or ''
   */
  constructor(haptics, scene, looks, view, table, fills, tips, reliefs, fileName) {
    this.haptics = haptics;
    this.scene = scene;
    this.looks = looks;
    this.reliefs = reliefs;
    reliefs.onChange = () => view.setReliefs(reliefs.present);
    this.view = view;
    this.table = table;
    this.tips = tips;
    this.voices = tips.map(({ voice }) => voice);
    const settings = { forceNewtons: 0.8, speedScale: 1 };
    this.hand = new Hand({
      canvas: find('#table'), tips, epochMs, settings,
      placeOf: (event) => view.placeOf(event),
      onTouch: (x, z) => this.#touched(x, z),
    });
    const force = slider('force', (value) => `${value.toFixed(1)} N`, (value) => {
      settings.forceNewtons = value;
    });
    this.hand.onForceStep = (direction) => {
      force.value += 0.1 * direction;
    };
    slider('speed', (value) => `× ${value.toFixed(1)}`, (value) => {
      settings.speedScale = value;
    });
    const gain = slider('gain', (value) => `${Math.round(value)} %`, (value) => {
      for (const voice of haptics.voices) voice.gain = value / 100;
    });
    this.#makePresets();
    this.palette = new Palette({
      haptics, fills,
      objects: scene.surfaces.map((/** @type {any} */ surface, /** @type {number} */ index) => ({ value: String(index), text: this.titleOf(index) })),
      paint: (index, material) => this.paint(index, material),
      onSelect: (index) => this.#select(index),
      restore: () => scene.surfaces.forEach((/** @type {any} */ surface, /** @type {number} */ index) => this.paint(index, surface.material)),
    });
    this.quality = new QualityPanel(haptics, messages);
    this.effects = new EffectsPanel(haptics, messages);
    this.compare = new ComparePanel({
      labels: () => haptics.labels.map(({ name }) => name),
      qualities: this.quality.tiers,
      object: () => Math.max(0, view.selected),
      title: (index) => this.titleOf(index),
      paint: (index, material) => this.paint(index, material),
      setQuality: (name) => this.quality.choose(name),
      play: () => this.#playOver(Math.max(0, view.selected)),
    });
    this.recorder = new Recorder(tips);
    this.record = new RecordPanel(this.recorder, haptics, () => this.#recorded(), () => reliefs.changes);
    this.clip = new ClipPanel(haptics, tips[0]);
    this.relief = new ReliefPanel({
      reliefs,
      mostTexels: HaptoFlow.mostTexels,
      decode: (file, options) => HaptoFlow.decodeImage(file, options),
      object: () => Math.max(0, view.selected),
      nameOf: (index) => scene.surfaces[index].name,
      titleOf: (index) => this.titleOf(index),
      isFlat: (index) => table.tops[index].kind === 'box',
      isOn: () => this.effects.isOn('relief'),
    });
    this.ownMaterial = new OwnMaterialPanel(haptics, (name) => {
      table.setLabels(haptics.labels);
      this.palette.chosen = name;
      this.palette.refresh();
      this.compare.refresh();
    }, (files, event) => this.#takeDropped(files, event));
    this.model = new ModelPanel(haptics.model, fileName, () => location.reload());
    this.outputs = new Outputs(this.voices, messages);
    this.device = new DevicePanel(haptics, this.hand, this.voices[0]);
    try {
      this.scope = new Scope(this.voices.map((voice) => voice.waveTap()));
    } catch (error) {
      messages.missing(scopeName, error);
    }
    const listen = find('#listen');
    const ears = new Ears(haptics.context, haptics.output);
    const applyListen = (/** @type {import('../engine/js/haptoflow.d.ts').Voice} */ voice) => (listen.checked ? ears.take(voice) : ears.release(voice));
    listen.addEventListener('change', () => haptics.voices.forEach(applyListen));
    this.adopt = (voice) => {
      this.effects.apply(voice);
      voice.gain = gain.value / 100;
      applyListen(voice);
    };
    this.voices.forEach(this.adopt);
    this.hand.onHover = (place) => this.#showHover(place);
    view.selected = scene.surfaces.findIndex((/** @type {any} */ surface) => surface.name === 'corduroy swatch');
    this.#select(view.selected);
    this.#listenToEngine();
    this.#offerHeadset();
    this.#deviceLine();
  }

  /** Titles name objects for people; equal ones get their number. */
  titleOf(/** @type {number} */ index) {
    const { name } = this.scene.surfaces[index];
    const title = this.looks.surfaces[name]?.title ?? name;
    const isAlone = this.scene.surfaces.filter((/** @type {any} */ other) => this.looks.surfaces[other.name]?.title === title).length === 1;
    return isAlone ? title : `${title} ${name.match(/\d+$/)?.[0] ?? ''}`.trim();
  }

  paint(/** @type {number} */ index, /** @type {any} */ material) {
    this.table.materials[index] = material;
    for (const tip of this.tips) tip.setMaterial(index, material);
    this.view.refresh();
  }

  #select(/** @type {number} */ index) {
    if (index < 0) return;
    this.view.selected = index;
    this.palette.select(index);
    this.relief.refresh();
  }

  /** Clips are shown, pictures become reliefs, of what they are dropped on, and models play. Returns whether the files were any. */
  #takeDropped(/** @type {File[]} */ files, /** @type {DragEvent} */ event) {
    const picture = files.find(isPicture);
    const clip = files.find(isClip);
    if (clip) {
      void this.clip.take(clip);
    } else if (picture) {
      if (event.target === find('#table')) {
        const { x, z } = this.view.placeOf(event);
        this.#select(this.table.at(x, z));
      }
      void this.relief.take(picture);
    } else if (files.some(({ name }) => isModel(name))) {
      this.model.take(files);
    } else {
      return false;
    }
    return true;
  }

  /** What a recording is rendered with: the scene of now, with the reliefs that are felt. */
  #recorded() {
    const scene = this.table.sceneNow();
    return this.effects.isOn('relief') ? this.reliefs.withFiles(scene) : { scene, files: new Map(), reliefs: {} };
  }

  #touched(/** @type {number} */ x, /** @type {number} */ z) {
    void this.haptics.resume();
    this.table.moveTo((performance.now() - epochMs) / 1000);
    const index = this.table.at(x, z);
    if (index < 0) return;
    this.#select(index);
    if (this.palette.isPainting) this.paint(index, this.palette.material);
  }

  #showHover(/** @type {{x: number, z: number} | null} */ place) {
    const index = place ? this.table.at(place.x, place.z) : -1;
    find('#reading-name').textContent = index < 0 ? 'Press and draw' : this.#nameOf(index);
    find('#reading-numbers').textContent = index < 0 ? '' : (this.looks.surfaces[this.scene.surfaces[index].name]?.words ?? '');
  }

  /** Title and material of an object. */
  #nameOf(/** @type {number} */ index) {
    return `${this.titleOf(index)} · ${materialWords(this.table.materials[index])}`;
  }

  #makePresets() {
    find('#presets').replaceChildren(...presetStrokes.map((stroke) => {
      const button = make('button', { type: 'button', className: 'stroke', textContent: stroke.name, title: stroke.words, 'aria-pressed': 'false' });
      button.addEventListener('click', () => void this.#playPreset(stroke, button));
      return button;
    }));
  }

  async #playPreset(/** @type {import('./table/preset-strokes.mjs').PresetStroke} */ stroke, /** @type {any} */ button) {
    const isStop = button.getAttribute('aria-pressed') === 'true';
    this.hand.stopPreset();
    if (isStop) return;
    void this.haptics.resume();
    button.setAttribute('aria-pressed', 'true');
    await this.hand.play(stroke);
    button.setAttribute('aria-pressed', 'false');
  }

  /** A stroke to and fro over one object. */
  #playOver(/** @type {number} */ index) {
    void this.haptics.resume();
    const { position, halfX, radius } = this.table.tops[index];
    const reach = 0.7 * Math.min(0.05, halfX + 0.6 * radius);
    const [a, b] = /** @type {[number, number][]} */ ([[position[0] - reach, position[2]], [position[0] + reach, position[2]]]);
    return this.hand.play({ name: '', words: '', from: a, legs: [{ to: b, seconds: 0.7 }, { to: a, seconds: 0.7 }, { to: b, seconds: 0.7 }] });
  }

  #listenToEngine() {
    this.haptics.addEventListener('error', ({ detail }) => {
      messages.error(detail.error);
      if (!detail.isFatal) return;
      this.#isOver = true;
      start.fail(detail.error);
    });
    this.haptics.addEventListener('recovered', () => {
      messages.clear();
      messages.show('The engine stopped and was started again. You can go on.');
    });
    this.haptics.addEventListener('silent', ({ detail: { reason } }) => {
      if (reason === 'none') messages.clear('silent');
      else if (reason !== 'context') messages.show(silenceSentence(reason), { key: 'silent' });
    });
    this.haptics.addEventListener('context', () => this.#showStart());
    this.haptics.addEventListener('device', ({ detail: { state } }) => {
      if (state === 'back') messages.clear('device');
      else messages.show(deviceSentences[state], { key: 'device' });
      this.#showStart();
    });
    start.button.addEventListener('click', () => void this.haptics.resume().then(() => this.#showStart()));
    this.#showStart();
  }

  /** Until a gesture the browser lets nothing sound. */
  #showStart() {
    // While the next output is looked for, the context stands still at times, and no tap would help.
    start.layer.hidden = this.haptics.context.state === 'running' || this.haptics.statistics().hasLostOutput;
    start.layer.classList.add('is-open');
    start.bar.hidden = true;
    start.text.textContent = 'The sound waits for a tap.';
    start.button.hidden = false;
    this.#deviceLine();
  }

  async #offerHeadset() {
    try {
      // The headset's scripts are loaded only where there may be a headset.
      const { xr } = /** @type {any} */ (navigator);
      if (!xr) messages.missing(headsetName, 'this browser has no WebXR');
      if (!(await xr?.isSessionSupported('immersive-vr'))) return;
      const { enterHeadset, headsetIsPossible } = await import('./xr/headset.mjs');
      if (!(await headsetIsPossible())) return;
      const button = find('#enter-vr');
      button.hidden = false;
      button.addEventListener('click', () => {
        this.hand.releaseAll();
        messages.found(headsetName);
        button.disabled = true;
        void this.haptics.resume();
        enterHeadset({
          haptics: this.haptics,
          scene: this.table.sceneNow(),
          looks: this.looks,
          reliefs: this.reliefs.present,
          onPaint: ({ surface, material }) => this.paint(this.scene.surfaces.findIndex((/** @type {any} */ { name }) => name === surface), material),
          onVoice: this.adopt,
          onScene: this.reliefs.lay,
          onEnd: ({ message, posesPerSecond }) => {
            button.disabled = false;
            this.device.posesPerSecond = posesPerSecond;
            if (message !== '') messages.show(message);
          },
        }).catch((/** @type {any} */ error) => {
          button.disabled = false;
          messages.missing(headsetName, error);
        });
      });
    } catch (error) {
      messages.missing(headsetName, error);
    }
  }

  #deviceLine() {
    const { sharing, sharingNote, ringFrames, sampleRateHz, baseLatencyMs, outputLatencyMs } = this.haptics.statistics();
    this.#shownRingFrames = ringFrames;
    const way = sharing === 'shared'
      ? 'Page, worker and audio thread share memory.'
      : `Sound goes through a ring that adds ${shown((1000 * ringFrames) / sampleRateHz, 0)} ms: ${sharingNote}.`;
    find('#device-line').textContent = `${way} ${sampleRateHz.toLocaleString('en')} Hz; the browser states a latency of ${shown(baseLatencyMs, 1)} ms and of ${shown(outputLatencyMs, 1)} ms for the output.`;
  }

  run() {
    let [before, polled, announced, lastName] = [performance.now(), 0, 0, ''];
    const frame = (/** @type {number} */ nowMs) => {
      if (this.#isOver) return;
      requestAnimationFrame(frame);
      this.hand.frame((nowMs - before) / 1000);
      before = nowMs;
      this.view.draw((performance.now() - epochMs) / 1000, this.tips.map(({ place, isDown, holder }) => {
        const ahead = typeof holder === 'number' ? this.hand.predicted.get(holder) : undefined;
        const lean = place.orientation ? [-2 * /** @type {number[]} */ (place.orientation)[2], 2 * /** @type {number[]} */ (place.orientation)[0]] : null;
        return { x: ahead?.x ?? place.x, z: ahead?.z ?? place.z, forceNewtons: place.forceNewtons, isDown, lean };
      }));
      this.#drawSignal(nowMs);
      this.outputs.frame(nowMs);
      this.record.frame();
      this.clip.frame();
      const name = this.#showReading();
      if (name !== '' && name !== lastName && nowMs - announced > announceEveryMs) {
        find('#announce').textContent = name;
        [lastName, announced] = [name, nowMs];
      }
      if (nowMs - polled > statisticsEveryMs) {
        polled = nowMs;
        this.#poll();
      }
    };
    requestAnimationFrame(frame);
  }

  #drawSignal(/** @type {number} */ nowMs) {
    try {
      this.scope?.frame(nowMs);
    } catch (error) {
      this.scope = null;
      messages.missing(scopeName, error);
    }
  }

  #showReading() {
    const tip = this.tips.find(({ isDown, contact }) => isDown && contact?.touching);
    this.profile.frame(tip?.contact ?? null);
    if (!tip?.contact) return '';
    const name = this.#nameOf(tip.contact.surfaceIndex);
    const heading = find('#reading-name');
    if (heading.textContent !== name) heading.textContent = name;
    find('#reading-numbers').textContent = `${Math.round(1000 * tip.speedMps)} mm/s · ${shown(tip.contact.forceNewtons, 1)} N`;
    return name;
  }

  #poll() {
    try {
      const statistics = this.haptics.statistics();
      this.quality.show(statistics);
      if (statistics.ringFrames !== this.#shownRingFrames) this.#deviceLine();
      this.effects.show(this.haptics.voices.map((voice) => voice.statistics()));
    } catch (error) {
      if (/** @type {any} */ (error).code !== 'closed') throw error;
    }
  }
}

/** @type {{name: string, bytes: Uint8Array} | null} */
let given = null;
try {
  const [plainScene, looks] = await Promise.all([readJson('table/workbench.json'), readJson('table/looks.json')]);
  const movingScene = matchMedia('(prefers-reduced-motion: reduce)').matches ? withoutMotion(plainScene) : plainScene;
  const table = new Table(movingScene);
  const fills = new Fills(looks.labels);
  const ownReliefs = reliefsOf(movingScene, looks);
  const view = new TableView(find('#table'), table, looks, fills, ownReliefs);
  // The table is there before the engine is.
  view.draw(0, []);
  given = await keptModel();
  const haptics = await HaptoFlow.create({ updateRateHz, model: given?.bytes, onProgress: (share, doing) => start.progress(share, doing) });
  table.setLabels(haptics.labels);
  const { scene, lacking } = fittedTo(movingScene, haptics.labels);
  table.materials = scene.surfaces.map((/** @type {any} */ surface) => surface.material);
  view.refresh();
  const reliefs = new TableReliefs(haptics, ownReliefs, table.tipRadius);
  await reliefs.start();
  const tips = [];
  for (let index = 0; index < tipCount; index += 1) {
    const contactScene = haptics.loadScene(scene);
    reliefs.follow(contactScene);
    tips.push(new Tip(table, await haptics.openVoice(), contactScene));
    table.follow(contactScene);
  }
  const page = new Page(haptics, scene, looks, view, table, fills, tips, reliefs, given?.name ?? '');
  page.run();
  if (lacking.length > 0) messages.show(`This model has no ${lacking.join(', ')}: these objects are of other materials.`);
  // For tests and for the curious at the console.
  Object.assign(globalThis, { haptoflowPage: page });
} catch (error) {
  if (given) Object.assign(/** @type {object} */ (error), { message: `${given.name}: ${/** @type {Error} */ (error).message}` });
  start.fail(error, given && (() => void forgetModel().then(() => location.reload())));
  console.warn(sentenceOf(error));
}
