// The board of all labels: swatches behind the workbench that are touched like every other object.

const columns = 5;
const cellMetres = { width: 0.08, height: 0.062 };
const gapMetres = 0.006;
const thicknessMetres = 0.008;
/** The lower edge's middle, in the scene's frame: behind a desk of 0.35 m. */
const foot = [0, 0.04, 0.23];
const leanRadians = 0.4;

/** The size of one swatch: x, y, z. */
export const swatchMetres = /** @type {const} */ ([cellMetres.width - gapMetres, cellMetres.height - gapMetres, thicknessMetres]);

/** The upper edge's middle, in the scene's frame. */
export function boardTop(count) {
  const height = Math.ceil(count / columns) * cellMetres.height;
  return [foot[0], foot[1] + height * Math.cos(leanRadians), foot[2] + height * Math.sin(leanRadians)];
}

/**
 * Surfaces of SCENE.json, one for each label, row by row from the top, in the scene's frame.
 * @param {readonly string[]} names of labels
 */
export function swatches(names) {
  const rows = Math.ceil(names.length / columns);
  const [up, back] = [Math.cos(leanRadians), Math.sin(leanRadians)];
  return names.map((name, index) => {
    const across = ((index % columns) - (columns - 1) / 2) * cellMetres.width;
    const along = (rows - Math.floor(index / columns) - 0.5) * cellMetres.height;
    return {
      name: `swatch of ${name}`,
      shape: { box: { size: swatchMetres } },
      position: [foot[0] + across, foot[1] + along * up, foot[2] + along * back],
      rotation: [Math.sin(leanRadians / 2), 0, 0, Math.cos(leanRadians / 2)],
      material: name,
    };
  });
}

/** A scene with the board in it, and how many surfaces are its own. */
export function withBoard(scene, names) {
  return { scene: { ...scene, surfaces: [...scene.surfaces, ...swatches(names)] }, objectCount: scene.surfaces.length };
}

/** What a hand that presses its button paints: the surface and the material, or null. */
export function strokeOfPaint(contact, brush, objectCount) {
  if (contact === null || brush === '' || contact.surfaceIndex < 0 || contact.surfaceIndex >= objectCount) return null;
  return { surface: contact.surfaceName, material: brush };
}
