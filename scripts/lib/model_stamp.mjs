// Stamps pages and results with the SHA-256 of the model that they were made with, and reads the stamps.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { inRepository } from './repository.mjs';

export const shippedModel = inRepository('Packages', 'com.haptoflow.runtime', 'Runtime', 'Models', 'default.haptoflow');

export const sha256Of = (file) => createHash('sha256').update(readFileSync(file)).digest('hex');

/** The line of a page that names the model. */
export const modelLine = (sha256) => `Model: SHA-256 \`${sha256}\`.`;

/** The SHA-256 that a page names; null where it names none. Throws RangeError where it names two. */
export function modelOfPage(text) {
  const named = new Set([...text.matchAll(/^Model: SHA-256 `([0-9a-f]{64})`\.$/gm)].map(([, sha256]) => sha256));
  if (named.size > 1) throw new RangeError(`the page names ${named.size} models`);
  return [...named][0] ?? null;
}
