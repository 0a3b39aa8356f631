import { strokeOfPaint, withBoard } from './board.mjs';
import { Placement } from './frames.mjs';
import { Hand } from './hand.mjs';
import { Hands } from './hands.mjs';
import { Report } from './report.mjs';
import { Stage } from './stage.mjs';

// One stay in the headset: what happens in each frame, and at each event of the session.

const usualFrameMs = 1000 / 72;

const reasonsOfEnd = {
  left: '',
  'graphics-lost': 'The graphics were lost: enter again.',
  failed: 'The headset view failed: ',
};

async function openHand(haptics, scene) {
  const voice = await haptics.openVoice();
  try {
    return new Hand({ scene: haptics.loadScene(scene), voice });
  } catch (error) {
    await voice.close();
    throw error;
  }
}

/** See `enterHeadset`. */
export class Visit {
  placement = new Placement();
  /** "left", "graphics-lost" or "failed" after the end. */
  reason = 'left';
  #message = '';
  #haptics;
  #session;
  #hands;
  #stage;
  #labels;
  #objectCount;
  #onEnd;
  #onPaint;
  #space = null;
  #isPlaced = false;
  #beganMs = -1;
  #lastMs = -1;
  #frameMs = usualFrameMs;
  #report;
  /** What was touched last: a label, or labels with weights. */
  #material = '';
  #brush = '';
  /** Resolves when all is closed. */
  ended;

  /** @param {any} parts see `enterHeadset`; `three` is the namespace, `session` is running */
  static async begin({ haptics, scene, looks, reliefs, three, session, newtonsAtFullPressure, onEnd, onPaint, onVoice, onScene }) {
    const labels = haptics.labels.map(({ name }) => name);
    const board = withBoard(scene, labels);
    const opened = [];
    let stage = null;
    let hasEnded = false;
    session.addEventListener('end', () => {
      hasEnded = true;
    }, { once: true });
    try {
      for (let side = 0; side < 2; side += 1) opened.push(await openHand(haptics, board.scene));
      for (const hand of opened) {
        onVoice(hand.voice);
        onScene(hand.scene);
      }
      stage = new Stage({ three, scene, poses: opened[0].scene, looks, reliefs, labels });
      await stage.renderer.xr.setSession(session);
      if (hasEnded) throw new Error('the headset was left while it loaded');
      const [left, right] = opened;
      const { objectCount } = board;
      return new Visit({ haptics, session, stage, left, right, newtonsAtFullPressure, labels, objectCount, onEnd, onPaint });
    } catch (error) {
      stage?.close();
      await Promise.all(opened.map((hand) => hand.close()));
      throw error;
    }
  }

  constructor({ haptics, session, stage, left, right, newtonsAtFullPressure, labels, objectCount, onEnd, onPaint }) {
    this.#haptics = haptics;
    this.#session = session;
    this.#stage = stage;
    this.#report = new Report({ haptics, panel: stage.panel });
    stage.place(this.placement);
    this.#hands = new Hands({ left, right, placement: this.placement, newtonsAtFullPressure });
    this.#labels = labels;
    this.#objectCount = objectCount;
    this.#onEnd = onEnd;
    this.#onPaint = onPaint;
    this.ended = new Promise((resolve) => {
      session.addEventListener('end', () => resolve(this.#close()), { once: true });
    });
    session.addEventListener('inputsourceschange', this.#bind);
    session.addEventListener('visibilitychange', this.#look);
    session.addEventListener('selectstart', this.#press);
    stage.renderer.domElement.addEventListener('webglcontextlost', this.#onGraphicsLost);
    this.#space = stage.renderer.xr.getReferenceSpace();
    this.#space.addEventListener('reset', this.#onReset);
    this.#bind();
    this.#look();
    stage.renderer.setAnimationLoop(this.#onFrame);
  }

  get session() {
    return this.#session;
  }

  /** Frames and distinct poses of the busier hand, per second, over the last second; NaN before. */
  rates() {
    return this.#report.rates();
  }

  /** Leaves the headset. */
  async end() {
    await this.#session.end().catch(() => {});
    await this.ended;
  }

  #bind = () => this.#hands.bind(this.#session.inputSources);

  #look = () => {
    this.#hands.isSuspended = (this.#session.visibilityState ?? 'visible') !== 'visible';
  };

  #onReset = () => {
    this.#hands.lift();
    this.#isPlaced = false;
  };

  #onGraphicsLost = (event) => {
    event.preventDefault();
    this.#leave('graphics-lost', '');
  };

  #press = ({ inputSource }) => {
    // A press is what a suspended audio context waits for.
    if (this.#haptics.context.state !== 'running') this.#haptics.resume().catch(() => {});
    const hand = this.#hands.sideOf(inputSource)?.hand;
    const paint = hand ? strokeOfPaint(hand.contact, this.#brush, this.#objectCount) : null;
    if (!paint) return;
    for (const side of this.#hands.sides) side.hand.scene.setSurface(paint.surface, { material: paint.material });
    this.#stage.paint(paint.surface, paint.material);
    this.#onPaint(paint);
  };

  #onFrame = (timeMs, frame) => {
    if (!frame || this.reason !== 'left') return;
    try {
      this.#live(timeMs, frame);
    } catch (error) {
      this.#leave('failed', error.message);
    }
  };

  #live(timeMs, frame) {
    if (this.#beganMs < 0) this.#beganMs = timeMs;
    // A frame that comes twice, or with the clock set back, has nothing new.
    if (timeMs > this.#lastMs) {
      if (this.#lastMs >= 0) this.#frameMs += 0.1 * (timeMs - this.#lastMs - this.#frameMs);
      this.#lastMs = timeMs;
    }
    const timeSeconds = (this.#lastMs - this.#beganMs) / 1000;
    if (!this.#isPlaced) this.#place(frame);
    this.#hands.update(frame, this.#space, timeSeconds, this.#frameMs);
    this.#takeMaterials();
    this.#report.update(timeMs, this.#hands.sides, this.#material, this.#brush);
    this.#stage.render(timeSeconds, this.#hands.sides);
  }

  #place(frame) {
    const pose = frame.getViewerPose(this.#space);
    if (!pose) return;
    const { position, orientation } = pose.transform;
    this.placement.before([position.x, position.y, position.z], [orientation.x, orientation.y, orientation.z, orientation.w]);
    this.#stage.place(this.placement);
    this.#isPlaced = true;
  }

  #takeMaterials() {
    for (const { hand } of this.#hands.sides) {
      if (hand.contact === null) continue;
      const { surfaceIndex, material } = hand.contact;
      this.#material = material;
      if (surfaceIndex >= this.#objectCount) this.#brush = this.#labels[surfaceIndex - this.#objectCount];
    }
  }

  #leave(reason, message) {
    if (this.reason !== 'left') return;
    this.reason = reason;
    this.#message = reasonsOfEnd[reason] + message;
    this.#session.end().catch(() => {});
  }

  async #close() {
    const { renderer } = this.#stage;
    renderer.setAnimationLoop(null);
    this.#session.removeEventListener('inputsourceschange', this.#bind);
    this.#session.removeEventListener('visibilitychange', this.#look);
    this.#session.removeEventListener('selectstart', this.#press);
    this.#space.removeEventListener('reset', this.#onReset);
    renderer.domElement.removeEventListener('webglcontextlost', this.#onGraphicsLost);
    const rates = this.rates();
    // An engine that is closed already has closed its voices.
    await this.#hands.close().catch(() => {});
    this.#stage.close();
    this.#onEnd({ reason: this.reason, message: this.#message, ...rates });
  }
}
