import { HaptoFlowError } from './errors.mjs';

// PNG files of heights. A canvas would give 8 of 16 bits, and other colours where an image is transparent: the samples would not be
// the command line's. Inflating is the browser's.

const signature = [137, 80, 78, 71, 13, 10, 26, 10];
/** How many numbers a pixel has, by the file's colour type: 0 is grey, 2 red, green and blue, 3 a palette, 4 and 6 the first two with opacity. @type {Record<number, number>} */
const channelsOf = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };
/** @type {Record<number, number[]>} */
const depthsOf = { 0: [1, 2, 4, 8, 16], 2: [8, 16], 3: [1, 2, 4, 8], 4: [8, 16], 6: [8, 16] };
/** First column and row, and steps, of the seven parts of an interlaced image. */
const passes = [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];

const sums = Uint32Array.from({ length: 256 }, (_, byte) => {
  let sum = byte;
  for (let bit = 0; bit < 8; bit += 1) sum = (sum >>> 1) ^ (sum & 1 ? 0xedb88320 : 0);
  return sum;
});

function checkSum(/** @type {Uint8Array} */ bytes) {
  let sum = 0xffffffff;
  for (const byte of bytes) sum = (sum >>> 8) ^ sums[(sum ^ byte) & 255];
  return ~sum >>> 0;
}

/** What comes out of a stream that bytes are put into. @param {Uint8Array} bytes @param {{readable: ReadableStream, writable: WritableStream}} stream */
const through = async (bytes, stream) => new Uint8Array(await new Response(new Blob([/** @type {BlobPart} */ (bytes)]).stream().pipeThrough(stream)).arrayBuffer());

const viewOf = (/** @type {Uint8Array} */ bytes) => new DataView(bytes.buffer, bytes.byteOffset, bytes.byteLength);

/** @param {Uint8Array} bytes */
export const isPng = (bytes) => signature.every((byte, at) => bytes[at] === byte);

/** The file's size in pixels, before anything is decoded; null for what is no PNG file. @param {Uint8Array} bytes */
export function pngSize(bytes) {
  if (!isPng(bytes) || bytes.length < 33) return null;
  const view = viewOf(bytes);
  return { width: view.getUint32(16), height: view.getUint32(20) };
}

/** The parts of a file: header, palette and joined data. */
function chunksOf(/** @type {Uint8Array} */ bytes) {
  const view = viewOf(bytes);
  /** @type {Record<string, Uint8Array[]>} */
  const found = { IHDR: [], PLTE: [], IDAT: [] };
  for (let at = signature.length; at + 12 <= bytes.length;) {
    const length = view.getUint32(at);
    const type = String.fromCharCode(...bytes.subarray(at + 4, at + 8));
    if (at + 12 + length > bytes.length) throw new Error('the file is cut short');
    if (view.getUint32(at + 8 + length) !== checkSum(bytes.subarray(at + 4, at + 8 + length))) throw new Error(`a wrong check sum of ${type}`);
    found[type]?.push(bytes.subarray(at + 8, at + 8 + length));
    at += 12 + length;
    if (type === 'IEND') return found;
  }
  throw new Error('the file is cut short');
}

function paeth(/** @type {number} */ left, /** @type {number} */ above, /** @type {number} */ corner) {
  const [byLeft, byAbove, byCorner] = [Math.abs(above - corner), Math.abs(left - corner), Math.abs(left + above - 2 * corner)];
  if (byLeft <= byAbove && byLeft <= byCorner) return left;
  return byAbove <= byCorner ? above : corner;
}

/** Undoes a line's filter, in place: each byte was written less what its neighbours foretell. */
function unfilter(/** @type {number} */ filter, /** @type {Uint8Array} */ line, /** @type {Uint8Array} */ above, /** @type {number} */ step) {
  if (filter > 4) throw new Error('an unknown filter');
  for (let at = 0; filter !== 0 && at < line.length; at += 1) {
    const left = at < step ? 0 : line[at - step];
    if (filter === 1) line[at] += left;
    else if (filter === 2) line[at] += above[at];
    else if (filter === 3) line[at] += (left + above[at]) >> 1;
    else line[at] += paeth(left, above[at], at < step ? 0 : above[at - step]);
  }
}

/** Reads the numbers of a line. */
function numbersOf(/** @type {Uint8Array} */ line, /** @type {number} */ bits, /** @type {Uint16Array} */ into) {
  for (let at = 0; at < into.length; at += 1) {
    if (bits === 16) into[at] = 256 * line[2 * at] + line[2 * at + 1];
    else if (bits === 8) into[at] = line[at];
    else into[at] = (line[(at * bits) >> 3] >> (8 - bits - ((at * bits) & 7))) & ((1 << bits) - 1);
  }
}

async function decoded(/** @type {Uint8Array} */ bytes) {
  const { IHDR: [header], PLTE: [palette], IDAT: parts } = chunksOf(bytes);
  if (header?.length !== 13) throw new Error('no header');
  const view = viewOf(header);
  const [width, height] = [view.getUint32(0), view.getUint32(4)];
  const [bits, colourType, compression, filters, interlace] = header.subarray(8);
  const channels = channelsOf[colourType];
  if (!depthsOf[colourType]?.includes(bits) || compression > 0 || filters > 0 || interlace > 1 || width === 0 || height === 0) throw new Error('a header that no image has');
  if (colourType === 3 && !palette) throw new Error('no palette');
  const raw = await through(new Uint8Array(await new Blob(/** @type {BlobPart[]} */ (parts)).arrayBuffer()), new DecompressionStream('deflate'));
  const isWide = bits === 16;
  const data = isWide ? new Uint16Array(4 * width * height) : new Uint8ClampedArray(4 * width * height);
  const most = isWide ? 65535 : 255;
  // Fewer than 8 bits stretch to 8; a palette's numbers are none of brightness.
  const stretch = bits < 8 && colourType !== 3 ? 255 / ((1 << bits) - 1) : 1;
  const step = Math.max(1, (channels * bits) >> 3);
  let from = 0;
  for (const [firstColumn, firstRow, acrossStep, downStep] of interlace ? passes : [[0, 0, 1, 1]]) {
    const [columns, rows] = [Math.ceil((width - firstColumn) / acrossStep), Math.ceil((height - firstRow) / downStep)];
    if (columns <= 0 || rows <= 0) continue;
    const lineBytes = Math.ceil((columns * channels * bits) / 8);
    const numbers = new Uint16Array(columns * channels);
    let above = new Uint8Array(lineBytes);
    for (let row = 0; row < rows; row += 1) {
      if (from + 1 + lineBytes > raw.length) throw new Error('too few pixels');
      const line = raw.subarray(from + 1, from + 1 + lineBytes);
      unfilter(raw[from], line, above, step);
      numbersOf(line, bits, numbers);
      for (let column = 0; column < columns; column += 1) {
        const at = 4 * ((firstRow + row * downStep) * width + firstColumn + column * acrossStep);
        const number = channels * column;
        if (colourType === 3) for (let part = 0; part < 3; part += 1) data[at + part] = /** @type {Uint8Array} */ (palette)[3 * numbers[number] + part] ?? 0;
        else for (let part = 0; part < 3; part += 1) data[at + part] = stretch * numbers[number + (channels < 3 ? 0 : part)];
        data[at + 3] = channels === 2 || channels === 4 ? numbers[number + channels - 1] : most;
      }
      above = line;
      from += 1 + lineBytes;
    }
  }
  return { width, height, data };
}

/**
 * The pixels of a PNG file, every bit of them, as the command line reads it: without gamma and colour profile.
 * @param {Uint8Array} bytes
 * @param {string} [name] for messages
 * @returns {Promise<import('./haptoflow.d.ts').ReliefImage>}
 * @throws HaptoFlowError "input"
 */
export async function decodePng(bytes, name = 'image') {
  if (!isPng(bytes)) throw new HaptoFlowError('input', `${name}: not a PNG file`);
  if (!globalThis.DecompressionStream) throw new HaptoFlowError('input', `${name}: this browser has no DecompressionStream, which PNG files need: use one of 2023 or later`);
  try {
    return await decoded(bytes);
  } catch (error) {
    throw new HaptoFlowError('input', `${name}: damaged (${/** @type {Error} */ (error).message})`);
  }
}

/**
 * A grey PNG file of 16 bits.
 * @param {number} width @param {number} height @param {Uint16Array} greys
 */
export async function encodePng(width, height, greys) {
  const raw = new Uint8Array(height * (1 + 2 * width));
  for (let row = 0; row < height; row += 1) {
    for (let column = 0; column < width; column += 1) {
      const at = row * (1 + 2 * width) + 1 + 2 * column;
      const grey = greys[row * width + column];
      raw[at] = grey >> 8;
      raw[at + 1] = grey & 255;
    }
  }
  const header = new Uint8Array(13);
  viewOf(header).setUint32(0, width);
  viewOf(header).setUint32(4, height);
  header[8] = 16;
  const chunk = (/** @type {string} */ type, /** @type {Uint8Array} */ content) => {
    const bytes = new Uint8Array(12 + content.length);
    viewOf(bytes).setUint32(0, content.length);
    bytes.set(new TextEncoder().encode(type), 4);
    bytes.set(content, 8);
    viewOf(bytes).setUint32(8 + content.length, checkSum(bytes.subarray(4, 8 + content.length)));
    return bytes;
  };
  const parts = [Uint8Array.from(signature), chunk('IHDR', header), chunk('IDAT', await through(raw, new CompressionStream('deflate'))), chunk('IEND', new Uint8Array(0))];
  return new Uint8Array(await new Blob(/** @type {BlobPart[]} */ (parts)).arrayBuffer());
}
