import { defaultNewtonsAtFullPressure } from './profiles.mjs';

// The door to the headset. three.js and everything that draws is loaded only on entering.

/** Whether "Enter VR" can do anything in this browser now. */
export async function headsetIsPossible() {
  try {
    return (await navigator.xr?.isSessionSupported('immersive-vr')) === true;
  } catch {
    return false;
  }
}

/**
 * Enters the headset; call it in a gesture. Opens two voices and closes them again at the end.
 * @param {object} options
 * @param {import('../../engine/js/haptoflow.d.ts').HaptoFlow} options.haptics
 * @param {object} options.scene SCENE.json as an object, about 0.5 m wide, its table's top at y = 0
 * @param {{labels: Record<string, {colour: string, accent?: string, picture?: string, picture_metres?: number}>}} options.looks
 * @param {Map<string, import('../table/reliefs.mjs').SurfaceRelief>} [options.reliefs] to be drawn, by names of surfaces; `onScene` lays them
 * @param {(end: {reason: 'left' | 'graphics-lost' | 'failed', message: string, framesPerSecond: number, posesPerSecond: number}) => void} [options.onEnd]
 *   `message` is for people, empty where nothing is wrong
 * @param {(paint: {surface: string, material: string}) => void} [options.onPaint]
 * @param {(voice: import('../../engine/js/haptoflow.d.ts').Voice) => void} [options.onVoice] gets each hand's voice before it sounds
 * @param {(scene: import('../../engine/js/haptoflow.d.ts').Scene) => void} [options.onScene] gets each hand's scene before it is touched
 * @param {number} [options.newtonsAtFullPressure] the force at which a pen's tip reports 1; a guess of 1 N unless given
 * @returns {Promise<import('./visit.mjs').Visit>} `end()` leaves, `rates()` says how often poses come
 */
export async function enterHeadset({ haptics, scene, looks, reliefs = new Map(), onEnd = () => {}, onPaint = () => {}, onVoice = () => {}, onScene = () => {}, newtonsAtFullPressure = defaultNewtonsAtFullPressure }) {
  // Both need the gesture, which loading would outlast. Sound may come later than sight.
  haptics.resume().catch(() => {});
  const session = await navigator.xr.requestSession('immersive-vr', { requiredFeatures: ['local-floor'], optionalFeatures: ['hand-tracking'] });
  try {
    const [three, { Visit }] = await Promise.all([import('../three/three.module.js'), import('./visit.mjs')]);
    return await Visit.begin({ haptics, scene, looks, reliefs, three, session, newtonsAtFullPressure, onEnd, onPaint, onVoice, onScene });
  } catch (error) {
    await session.end().catch(() => {});
    throw error;
  }
}
