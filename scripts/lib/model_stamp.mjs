// Stamps pages, results and pictures with the SHA-256 of the model that they were made with, and reads the stamps.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { inRepository } from './repository.mjs';

export const shippedModel = inRepository('Packages', 'com.haptoflow.runtime', 'Runtime', 'Models', 'default.haptoflow');

/** The keyword of the PNG text chunk that holds the stamp. Python and C# write the same. */
const pictureKey = 'Model-SHA-256';
const signatureLength = 8;

export const sha256Of = (file) => createHash('sha256').update(readFileSync(file)).digest('hex');

/** The line of a page that names the model. */
export const modelLine = (sha256) => `Model: SHA-256 \`${sha256}\`.`;

/** The SHA-256 that a page names; null where it names none. Throws RangeError where it names two. */
export function modelOfPage(text) {
  const named = new Set([...text.matchAll(/^Model: SHA-256 `([0-9a-f]{64})`\.$/gm)].map(([, sha256]) => sha256));
  if (named.size > 1) throw new RangeError(`the page names ${named.size} models`);
  return [...named][0] ?? null;
}

/** The chunks of a PNG file: name, content and offset. */
function* chunks(png) {
  for (let at = signatureLength; at < png.length; ) {
    const length = png.readUInt32BE(at);
    const [content, end] = [at + 8, at + 12 + length];
    yield { name: png.toString('latin1', at + 4, content), content: png.subarray(content, content + length), at, end };
    at = end;
  }
}

const textOf = ({ name, content }) => (name === 'tEXt' ? content.toString('latin1').split('\0') : []);

/** The SHA-256 of the model that a PNG file is stamped with; null where it has no stamp. */
export function modelOfPicture(png) {
  for (const chunk of chunks(png)) {
    const [key, value] = textOf(chunk);
    if (key === pictureKey) return value;
  }
  return null;
}

/** The PNG file with a stamp of the model that it was drawn with; an older stamp is removed. */
export function stampedPicture(png, sha256) {
  const kept = [...chunks(png)].filter((chunk) => textOf(chunk)[0] !== pictureKey).map(({ at, end }) => png.subarray(at, end));
  const typed = Buffer.from(`tEXt${pictureKey}\0${sha256}`, 'latin1');
  const chunk = Buffer.alloc(typed.length + 8);
  chunk.writeUInt32BE(typed.length - 4, 0);
  typed.copy(chunk, 4);
  chunk.writeUInt32BE(checksum(typed), typed.length + 4);
  const [header, ...rest] = kept;
  return Buffer.concat([png.subarray(0, signatureLength), header, chunk, ...rest]);
}

/** CRC-32 of the PNG specification. Node has the function from version 22 on. */
function checksum(bytes) {
  let remainder = 0xffffffff;
  for (const byte of bytes) {
    remainder ^= byte;
    for (let bit = 0; bit < 8; ++bit) remainder = (remainder >>> 1) ^ (remainder & 1 ? 0xedb88320 : 0);
  }
  return (remainder ^ 0xffffffff) >>> 0;
}
