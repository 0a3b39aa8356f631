import { HaptoFlowError } from './errors.mjs';
import { bytesOf } from './files.mjs';
import { decodePng, isPng, pngSize } from './png.mjs';
import { requireImage, requireTexels } from './relief.mjs';

/** @typedef {import('./haptoflow.d.ts').SceneRelief} SceneRelief */
/** @typedef {import('./haptoflow.d.ts').ReliefImage} ReliefImage */
/** @typedef {{index: number, surface: string, relief: SceneRelief}} NamedRelief of a surface of a scene, by its index there */

/** As the errors of scene files name it. @param {NamedRelief} named */
const keyOf = ({ index, relief }) => `scene: surfaces[${index}].relief.${relief.isNormalMap ? 'normals' : 'image'}`;

/**
 * The image of a surface's relief, of those that were given.
 * @param {NamedRelief} named @param {Readonly<Record<string, ReliefImage>>} images by the names that the scene gives them
 * @throws HaptoFlowError that names the key and the remedy
 */
export function imageOf(named, images) {
  const name = named.relief.image;
  if (!Object.hasOwn(images, name)) {
    throw new HaptoFlowError('input', `${keyOf(named)}: "${name}" is not among the images; give its pixels as { images: { ${JSON.stringify(name)}: { width, height, data } } }, as decodePng reads them`);
  }
  requireImage(images[name], name);
  return images[name];
}

/**
 * What an engine needs for a relief of a scene.
 * @param {NamedRelief} named @param {Readonly<Record<string, ReliefImage>>} images @param {number} tipRadiusMetres
 * @returns {import('./haptoflow.d.ts').ReliefImageOptions & {share: number}}
 */
export function optionsOf(named, images, tipRadiusMetres) {
  const { isNormalMap, sizeMetres, depthMetres, isTiled, share } = named.relief;
  return { image: imageOf(named, images), isNormalMap, sizeMetres, depthMetres, isTiled, share, tipRadiusMetres };
}

/**
 * The images that a scene names and nobody gave, read from beside the scene.
 * @param {readonly NamedRelief[]} named
 * @param {{images?: Readonly<Record<string, ReliefImage>>, sceneBase: string, signal?: AbortSignal}} options sceneBase: the scene's own address, or that of its folder
 * @returns {Promise<Record<string, ReliefImage>>} all of them
 * @throws HaptoFlowError that names the file, the key and the remedy
 */
export async function loadedImages(named, { images = {}, sceneBase, signal }) {
  const all = { ...images };
  for (const each of named) {
    const name = each.relief.image;
    if (Object.hasOwn(all, name)) continue;
    const bytes = await bytesOf(new URL(name.split('/').map(encodeURIComponent).join('/'), sceneBase), { code: 'input', remedy: `${keyOf(each)} is relative to the scene: give its address as sceneBase, or the pixels as images`, signal });
    if (!isPng(bytes)) throw new HaptoFlowError('input', `${name}: not a PNG file`);
    const size = pngSize(bytes);
    if (size) requireTexels(size.width, size.height, name);
    all[name] = await decodePng(bytes, name);
  }
  return all;
}
