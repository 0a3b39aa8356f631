// Names the model that pages and results were made with, by its SHA-256.
import { createHash } from 'node:crypto';
import { readFileSync } from 'node:fs';
import { inRepository } from './repository.mjs';

export const shippedModel = inRepository('Packages', 'com.haptoflow.runtime', 'Runtime', 'Models', 'default.haptoflow');

export const sha256OfBytes = (bytes) => createHash('sha256').update(bytes).digest('hex');

export const sha256Of = (file) => sha256OfBytes(readFileSync(file));

/** The line of a page that names the model. */
export const modelLine = (sha256) => `Model: SHA-256 \`${sha256}\`.`;
