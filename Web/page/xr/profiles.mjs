// What a WebXR input source is: where its tip is, and whether the tip measures force.

/**
 * The force at which a pen's tip reports 1, in newtons. No public source gives MX Ink's, so that it is a choice, the same as the
 * Unity package's; whoever puts the pen on a scale can give a measured one to `enterHeadset`.
 */
export const defaultNewtonsAtFullPressure = 1;

/** Pressures up to this count as a tip in the air. */
const minimumPressure = 0.01;

/**
 * @typedef {object} Profile
 * @property {string} name for the panel
 * @property {readonly [number, number, number]} tipMetres in the target ray's space
 * @property {string} [joint] of a tracked hand, instead of the target ray
 * @property {number} [pressureButton] its value is the pressure on the tip, 0 to 1
 * @property {number} [dockedButton] pressed while the device lies in its dock
 */

// A controller has no tip: a nib before it keeps the hand off the surface.
const nib = /** @type {const} */ ([0, 0, -0.06]);

/** By the names of the WebXR input profiles registry. @type {Record<string, Profile>} */
const profiles = {
  'logitech-mx-ink': { name: 'MX Ink', tipMetres: [0, 0, 0], pressureButton: 5, dockedButton: 6 },
  'meta-quest-touch-plus': { name: 'Touch Plus', tipMetres: nib },
  'meta-quest-touch-plus-v2': { name: 'Touch Plus', tipMetres: nib },
  'meta-quest-touch-pro': { name: 'Touch Pro', tipMetres: nib },
};
const generic = { name: 'controller', tipMetres: nib };
const finger = { name: 'finger', tipMetres: /** @type {const} */ ([0, 0, 0]), joint: 'index-finger-tip' };

/**
 * The profile of an XRInputSource; null for one that is not held, such as gaze.
 * @returns {Profile | null}
 */
export function profileOf(source) {
  if (source.hand) return finger;
  if (source.targetRayMode !== 'tracked-pointer') return null;
  const name = Array.from(source.profiles ?? []).find((each) => Object.hasOwn(profiles, each));
  return name === undefined ? generic : profiles[name];
}

/** The measured force in newtons; undefined in the air and without a sensor: then the contact model's spring gives the force. */
export function tipForceNewtons(profile, gamepad, newtonsAtFullPressure) {
  if (profile.pressureButton === undefined) return undefined;
  const pressure = gamepad?.buttons[profile.pressureButton]?.value ?? 0;
  return pressure > minimumPressure ? Math.min(1, pressure) * newtonsAtFullPressure : undefined;
}

/** Whether the device lies in its dock, where its tip must not feel anything. */
export const isDocked = (profile, gamepad) => profile.dockedButton !== undefined && gamepad?.buttons[profile.dockedButton]?.pressed === true;
