import { HaptoFlowError } from './errors.mjs';
import { decodePng, pngSize } from './png.mjs';

/** A canvas with a bitmap on it, on a page and in a worker. @param {ImageBitmap} bitmap @param {number} width @param {number} height */
function drawn(bitmap, width, height) {
  const canvas = globalThis.OffscreenCanvas ? new OffscreenCanvas(width, height) : Object.assign(document.createElement('canvas'), { width, height });
  const context = /** @type {CanvasRenderingContext2D | null} */ (canvas.getContext('2d', { willReadFrequently: true }));
  if (!context) throw new Error('there is no canvas for it');
  context.imageSmoothingQuality = 'high';
  context.drawImage(bitmap, 0, 0, width, height);
  return context.getImageData(0, 0, width, height);
}

/**
 * The pixels of a picture that a browser can show; see haptoflow.d.ts.
 * @param {Blob} file @param {{mostPixels?: number}} [options]
 */
export async function decodeImage(file, { mostPixels = Infinity } = {}) {
  const name = /** @type {File} */ (file).name ?? 'image';
  const bytes = new Uint8Array(await file.arrayBuffer());
  const size = pngSize(bytes);
  if (size && size.width * size.height <= mostPixels && globalThis.DecompressionStream) return { ...await decodePng(bytes, name), fullWidth: size.width, fullHeight: size.height };
  /** @type {ImageBitmap | undefined} */
  let bitmap;
  try {
    bitmap = await createImageBitmap(file, { colorSpaceConversion: 'none', premultiplyAlpha: 'none' });
    const { width: fullWidth, height: fullHeight } = bitmap;
    const scale = Math.min(1, Math.sqrt(mostPixels / (fullWidth * fullHeight)));
    const height = Math.max(1, Math.floor(scale * fullHeight));
    const width = Math.max(1, Math.min(Math.floor(scale * fullWidth), Math.floor(mostPixels / height)));
    const { data } = drawn(bitmap, width, height);
    return { width, height, data, fullWidth, fullHeight };
  } catch (error) {
    throw new HaptoFlowError('input', `${name}: damaged, too large, or no picture that this browser reads (${/** @type {Error} */ (error).message})`);
  } finally {
    bitmap?.close();
  }
}
