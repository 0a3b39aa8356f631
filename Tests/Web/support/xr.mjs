import { HaptoFlow } from '/somewhere/engine/haptoflow.mjs';
import { Ears } from '/somewhere/ears.mjs';
import { enterHeadset, headsetIsPossible } from '/somewhere/xr/headset.mjs';

// An emulated Quest, and what tests do with it: strokes in the scene's frame, and every pulse that a controller gets.

const { XRDevice, metaQuest3, metaQuestTouchPlus, P_SPACE } = globalThis.IWER;
const nibMetres = 0.06;

const pause = (milliseconds) => new Promise((resolve) => {
  setTimeout(resolve, milliseconds);
});
const nextFrame = () => new Promise((resolve) => {
  requestAnimationFrame(resolve);
});

/** MX Ink as the registry of WebXR input profiles has it. */
const button = (id, type = 'analog') => ({ id, type });
const ink = {
  profileId: 'logitech-mx-ink',
  fallbackProfileIds: ['generic-trigger'],
  layout: {
    right: {
      gamepad: {
        mapping: 'xr-standard',
        buttons: [
          { ...button('trigger'), eventTrigger: 'select' }, { ...button('squeeze'), eventTrigger: 'squeeze' }, null, null,
          button('touch-pad'), button('tip-force'), button('docked', 'binary'),
        ],
        axes: [],
      },
      numHapticActuators: 1,
    },
  },
};
ink.layout.left = ink.layout.right;

/** A device in the page. `controllers`: "touch-plus", "mx-ink". */
function emulate(controllers = 'touch-plus') {
  const device = new XRDevice({ ...metaQuest3, controllerConfig: controllers === 'mx-ink' ? ink : metaQuestTouchPlus });
  device.installRuntime({ forceInstall: true });
  device.stereoEnabled = false;
  device.position.set(0, 1.3, 0);
  // The emulator calls all its poses guessed.
  for (const each of Object.values(device.controllers)) each.inputSource.targetRaySpace[P_SPACE].emulated = false;
  device.viewerSpace[P_SPACE].emulated = false;
  globalThis.device = device;
  park('left');
  park('right');
  record(device);
  return device;
}

/** Hands that rest beside the body. */
function park(side) {
  device.controllers[side].position.set(side === 'left' ? -0.4 : 0.4, 0.9, 0.1);
  device.controllers[side].quaternion.set(0, 0, 0, 1);
}

const pulses = [];

/** Notes the pulses of each side's motor. */
function record(device) {
  for (const side of ['left', 'right']) {
    const [motor] = device.controllers[side].inputSource.gamepad.hapticActuators;
    motor.pulse = async (value, durationMs) => {
      pulses.push({ side, value, durationMs, atMs: performance.now() });
      globalThis.onPulse?.(side, value);
      return true;
    };
  }
}

/** Puts a tip at a place of the scene; an MX Ink has it at the origin of its ray. */
function putTip(visit, side, place) {
  const room = visit.placement.toRoom(place, [0, 0, 0]);
  const isInk = device.controllers[side].profileId === 'logitech-mx-ink';
  device.controllers[side].position.set(room[0], room[1], room[2] + (isInk ? 0 : nibMetres));
}

/** Moves tips for a time; `placeOf(side, seconds)` is in the scene's frame, null for hands off. */
async function stroke(visit, seconds, placeOf, sides = ['right']) {
  const began = performance.now();
  for (let now = 0; now < seconds; now = (performance.now() - began) / 1000) {
    for (const side of sides) {
      const place = placeOf(side, now);
      if (place) putTip(visit, side, place);
    }
    await nextFrame();
  }
}

/** A stroke, and what each voice was meanwhile: the reasons of its silences, "none" where it sounded. */
async function listen(visit, seconds, placeOf, sides = ['right']) {
  const found = haptics.voices.map(() => new Set());
  await stroke(visit, seconds, (side, now) => {
    haptics.voices.forEach((voice, index) => found[index].add(voice.silence));
    return placeOf(side, now);
  }, sides);
  return found.map((reasons) => [...reasons]);
}

let haptics = null;
/** @type {Ears | null} */
let ears = null;

/** Enters with the page's scene, or another one. */
async function enter({ quality = 'sketch', controllers = 'touch-plus', ...options } = {}) {
  if (!globalThis.device || globalThis.controllers !== controllers) {
    globalThis.device?.uninstallRuntime();
    emulate(controllers);
    globalThis.controllers = controllers;
  }
  haptics ??= await HaptoFlow.create({ quality });
  ears ??= new Ears(haptics.context, haptics.output);
  const [scene, looks] = await Promise.all(['workbench', 'looks'].map(async (name) => (await fetch(`/somewhere/table/${name}.json`)).json()));
  const ends = [];
  const painted = [];
  const visit = await enterHeadset({ haptics, scene, looks, onEnd: (end) => ends.push(end), onPaint: (paint) => painted.push(paint), onVoice: (voice) => ears.take(voice), ...options });
  await nextFrame();
  await nextFrame();
  await nextFrame();
  return { visit, haptics, ends, painted };
}

Object.assign(globalThis, { HaptoFlow, tools: { pause, nextFrame, park, pulses, putTip, stroke, listen, enter, headsetIsPossible, P_SPACE } });
