import { Press, penForce } from './press.mjs';
import { secondsOf, strokeAt } from './preset-strokes.mjs';

// Who moves the tips: pointers, keys and preset strokes. Times are seconds on the page's clock since `epochMs`.

const keyMps = 0.12;
const keyLiftSeconds = 0.15;
const arrows = /** @type {Record<string, [number, number]>} */ ({ ArrowLeft: [-1, 0], ArrowRight: [1, 0], ArrowUp: [0, 1], ArrowDown: [0, -1] });

/** How a pen is turned that leans by these tilts towards x and y of the screen: a quaternion x, y, z, w in the scene's frame. */
export function orientationOf(/** @type {number} */ tiltXDegrees, /** @type {number} */ tiltYDegrees) {
  const towardsX = Math.tan((tiltXDegrees * Math.PI) / 180);
  const towardsZ = -Math.tan((tiltYDegrees * Math.PI) / 180);
  const lean = Math.hypot(towardsX, towardsZ);
  if (lean < 1e-9) return [0, 0, 0, 1];
  const half = Math.atan(lean) / 2;
  // The pen turns about up x lean. The frame is left-handed, so that a lean towards x is a negative turn about z.
  return [(Math.sin(half) * towardsZ) / lean, 0, (-Math.sin(half) * towardsX) / lean, Math.cos(half)];
}

/** A pointer measures its pressure if it is a pen, or a finger whose pressure is neither of the two values that stand for none. */
const hasPressure = (/** @type {PointerEvent} */ event) =>
  event.pointerType === 'pen' ? event.pressure > 0 : event.pointerType === 'touch' && event.pressure > 0 && event.pressure !== 0.5 && event.pressure !== 1;

/** @typedef {{forceNewtons: number, speedScale: number}} HandSettings */

export class Hand {
  #canvas;
  #tips;
  #placeOf;
  #settings;
  #onTouch;
  /** @type {Map<number | string, {tip: import('./tip.mjs').Tip, press: Press, pressedAt: number}>} */
  #held = new Map();
  /** @type {Set<string>} */
  #keys = new Set();
  #keyPlace = { x: -0.24, z: 0.05, liftAt: -1 };
  #isKeyPressed = false;
  /** @type {{stroke: import('./preset-strokes.mjs').PresetStroke, began: number, done: (isComplete: boolean) => void} | null} */
  #preset = null;
  /** Where pointers will be, for the picture alone. @type {Map<number, {x: number, z: number}>} */
  predicted = new Map();
  /** Milliseconds from an event's own time to its publication, newest last. @type {number[]} */
  eventDelaysMs = [];

  /**
   * @param {{canvas: HTMLElement, tips: import('./tip.mjs').Tip[], epochMs: number, settings: HandSettings,
   *   placeOf: (event: {clientX: number, clientY: number}) => {x: number, z: number}, onTouch: (x: number, z: number) => void}} parts onTouch: before a pointer's tip lands
   */
  constructor({ canvas, tips, epochMs, settings, placeOf, onTouch }) {
    this.#canvas = canvas;
    this.#tips = tips;
    this.epochMs = epochMs;
    this.#settings = settings;
    this.#placeOf = placeOf;
    this.#onTouch = onTouch;
    canvas.addEventListener('pointerdown', (event) => this.#down(event));
    // Rawer events come as they are measured, where the browser has them; the others once a frame.
    canvas.addEventListener('onpointerrawupdate' in globalThis ? 'pointerrawupdate' : 'pointermove', (event) => this.#move(/** @type {PointerEvent} */ (event)));
    canvas.addEventListener('pointermove', (event) => {
      this.#predict(event);
      if (this.#held.size === 0) this.onHover(this.#placeOf(event));
    });
    canvas.addEventListener('pointerleave', () => this.onHover(null));
    for (const type of /** @type {const} */ (['pointerup', 'pointercancel', 'lostpointercapture'])) canvas.addEventListener(type, (event) => this.#release(event.pointerId));
    canvas.addEventListener('wheel', (event) => this.#wheel(event), { passive: false });
    canvas.addEventListener('keydown', (event) => this.#keyDown(event));
    canvas.addEventListener('keyup', (event) => this.#keyUp(event));
    canvas.addEventListener('blur', () => this.#dropKeys());
    canvas.addEventListener('contextmenu', (event) => event.preventDefault());
    document.addEventListener('visibilitychange', () => {
      if (document.visibilityState === 'hidden') this.releaseAll();
    });
  }

  get #now() {
    return (performance.now() - this.epochMs) / 1000;
  }

  #hold(/** @type {number | string} */ holder) {
    const before = this.#held.get(holder);
    if (before) return before;
    const tip = this.#tips.find((each) => each.holder === null);
    if (!tip) return null;
    tip.holder = holder;
    const held = { tip, press: new Press(), pressedAt: this.#now };
    held.press.begin();
    this.#held.set(holder, held);
    return held;
  }

  #release(/** @type {number | string} */ holder) {
    this.predicted.delete(/** @type {number} */ (holder));
    const held = this.#held.get(holder);
    if (!held) return;
    this.#held.delete(holder);
    held.tip.end(this.#now);
    held.tip.holder = null;
  }

  releaseAll() {
    this.stopPreset();
    this.#dropKeys();
    for (const holder of [...this.#held.keys()]) this.#release(holder);
  }

  #forceOf(/** @type {{tip: import('./tip.mjs').Tip, press: Press, pressedAt: number}} */ held, /** @type {number} */ now, /** @type {PointerEvent | null} */ event) {
    if (event && hasPressure(event)) {
      held.pressedAt = Infinity;
      return penForce(event.pressure);
    }
    // A pen at rest sends no events and keeps its force.
    if (held.pressedAt === Infinity) return held.tip.place.forceNewtons;
    const seconds = Math.max(0, now - held.pressedAt);
    held.pressedAt = now;
    return held.press.force(seconds, held.tip.speedMps, this.#settings.forceNewtons);
  }

  #orientationOf(/** @type {PointerEvent} */ event) {
    return event.pointerType === 'pen' ? orientationOf(event.tiltX, event.tiltY) : null;
  }

  #down(/** @type {PointerEvent} */ event) {
    if (event.button !== 0) return;
    const { x, z } = this.#placeOf(event);
    this.#onTouch(x, z);
    const held = this.#hold(event.pointerId);
    if (!held) return;
    try {
      this.#canvas.setPointerCapture(event.pointerId);
    } catch {
      // A pointer that is gone already.
    }
    const timeSeconds = (event.timeStamp - this.epochMs) / 1000;
    held.tip.begin({ timeSeconds, x, z, forceNewtons: this.#forceOf(held, timeSeconds, event), orientation: this.#orientationOf(event) });
    this.eventDelaysMs.push(performance.now() - event.timeStamp);
    if (this.eventDelaysMs.length > 200) this.eventDelaysMs.shift();
  }

  #move(/** @type {PointerEvent} */ event) {
    const held = this.#held.get(event.pointerId);
    if (!held) return;
    const coalesced = event.getCoalescedEvents?.() ?? [];
    const events = coalesced.length > 0 ? coalesced : [event];
    events.forEach((each, index) => {
      const timeSeconds = (each.timeStamp - this.epochMs) / 1000;
      const { x, z } = this.#placeOf(each);
      held.tip.move({ timeSeconds, x, z, forceNewtons: this.#forceOf(held, timeSeconds, each), orientation: this.#orientationOf(each) }, index === events.length - 1);
    });
  }

  #predict(/** @type {PointerEvent} */ event) {
    if (!this.#held.has(event.pointerId)) return;
    const ahead = event.getPredictedEvents?.()[0];
    if (ahead) this.predicted.set(event.pointerId, this.#placeOf(ahead));
    else this.predicted.delete(event.pointerId);
  }

  #wheel(/** @type {WheelEvent} */ event) {
    // While nothing touches, the wheel scrolls the page.
    if (this.#held.size === 0) return;
    event.preventDefault();
    this.onForceStep(event.deltaY < 0 ? 1 : -1);
  }

  /** A pointer is over the table and nothing touches; null when it leaves. @type {(place: {x: number, z: number} | null) => void} */
  onHover = () => {};

  /** Asked to press harder (1) or less (-1); the page changes its slider. @type {(direction: number) => void} */
  onForceStep = () => {};

  #keyDown(/** @type {KeyboardEvent} */ event) {
    if (event.key in arrows) this.#keys.add(event.key);
    else if (event.key === ' ') this.#isKeyPressed = true;
    else if (event.key === 'PageUp' || event.key === 'PageDown') this.onForceStep(event.key === 'PageUp' ? 1 : -1);
    else if (event.key === 'Escape') this.releaseAll();
    else return;
    event.preventDefault();
  }

  #keyUp(/** @type {KeyboardEvent} */ event) {
    this.#keys.delete(event.key);
    if (event.key === ' ') this.#isKeyPressed = false;
  }

  #dropKeys() {
    this.#keys.clear();
    this.#isKeyPressed = false;
    this.#release('keys');
  }

  /** @param {import('./preset-strokes.mjs').PresetStroke} stroke @returns {Promise<boolean>} whether it ran to its end */
  play(stroke) {
    this.stopPreset();
    return new Promise((done) => {
      this.#preset = { stroke, began: this.#now, done };
    });
  }

  stopPreset() {
    this.#endPreset(false);
  }

  #endPreset(/** @type {boolean} */ isComplete) {
    const preset = this.#preset;
    if (!preset) return;
    this.#preset = null;
    this.#release('preset');
    preset.done(isComplete);
  }

  get isPlaying() {
    return this.#preset !== null;
  }

  /** Call it at every frame. @param {number} seconds since the last frame */
  frame(seconds) {
    const now = this.#now;
    this.#framePreset(now);
    this.#frameKeys(now, Math.min(seconds, 0.1));
    for (const held of this.#held.values()) held.tip.hold(now, this.#forceOf(held, now, null));
  }

  #drive(/** @type {string} */ holder, /** @type {number} */ now, /** @type {number} */ x, /** @type {number} */ z, /** @type {number | undefined} */ newtons) {
    const isNew = !this.#held.has(holder);
    const held = this.#hold(holder);
    if (!held) return;
    const place = { timeSeconds: now, x, z, forceNewtons: newtons ?? this.#settings.forceNewtons };
    held.pressedAt = now;
    if (isNew) held.tip.begin(place);
    else held.tip.move(place);
  }

  #framePreset(/** @type {number} */ now) {
    if (!this.#preset) return;
    const { stroke, began } = this.#preset;
    const { x, z, isTouching, newtons } = strokeAt(stroke, now - began, this.#settings.speedScale);
    if (isTouching) this.#drive('preset', now, x, z, newtons);
    else this.#release('preset');
    if (now - began >= secondsOf(stroke, this.#settings.speedScale)) this.#endPreset(true);
  }

  #frameKeys(/** @type {number} */ now, /** @type {number} */ seconds) {
    const place = this.#keyPlace;
    if (this.#keys.size === 0 && !this.#isKeyPressed) {
      if (this.#held.has('keys') && now > place.liftAt) this.#release('keys');
      return;
    }
    const reach = keyMps * this.#settings.speedScale * seconds;
    for (const key of this.#keys) {
      place.x = Math.min(0.25, Math.max(-0.25, place.x + reach * arrows[key][0]));
      place.z = Math.min(0.175, Math.max(-0.175, place.z + reach * arrows[key][1]));
    }
    place.liftAt = now + keyLiftSeconds;
    // A key that rests presses harder, as a mouse does.
    if (this.#keys.size > 0 || !this.#held.has('keys')) this.#drive('keys', now, place.x, place.z, undefined);
  }

  /** Where the keys' tip is, for the picture. */
  get keyPlace() {
    return this.#keyPlace;
  }
}
