import { find, make } from './dom.mjs';

// Every failure of the engine in a sentence for somebody who came to draw.

const sentences = /** @type {Record<string, string>} */ ({
  'model-unreachable': 'The model of the materials could not be loaded.',
  'engine-unreachable': 'The engine could not be loaded.',
  'runtime-unreachable': 'The part that computes the networks could not be loaded.',
  'audio-unavailable': 'This browser gives the page no sound.',
  'worker-lost': 'The engine stopped.',
  aborted: 'Stopped.',
  closed: 'The engine is closed: reload the page.',
  'invalid-argument': 'That does not work.',
  input: 'This file cannot be used.',
  RECORDING_UNUSABLE: 'This recording cannot be used.',
});

const silences = /** @type {Record<string, string>} */ ({
  context: 'The browser holds the sound back: tap the table.',
  stale: 'Silent: the page was too busy to follow the tip. It goes on by itself.',
  muted: 'Silent: the sound is muted.',
  paused: 'Silent: the sound is paused.',
  panic: 'Silenced. The next touch sounds.',
  rate: 'The sound device changed. It goes on by itself.',
  closing: 'The sound ends.',
  'worker-dead': 'The engine stopped: reload the page.',
  'turned-down': 'Silent: the volume is at zero.',
});

export const deviceSentences = {
  lost: 'The sound device was lost. Pictures and motors go on, and the next device sounds by itself.',
  stopped: 'The sound device was lost. Connect one, and reload the page.',
};

/** @param {any} error @returns {string} what happened, then what the engine says of it */
export function sentenceOf(error) {
  const code = String(error?.code ?? '');
  const opening = sentences[code] ?? (code.startsWith('MODEL_') ? 'The file of the model is damaged.' : 'Something failed.');
  const detail = String(error?.message ?? error);
  return `${opening.slice(0, -1)}: ${detail}${/[.!?]$/.test(detail) ? '' : '.'}`;
}

const forbidden = 'this page may not use it: its server (Permissions-Policy) or the frame that it stands in forbids it';

/** Why something cannot be used. @param {any} why what was thrown, or words */
const reasonOf = (why) => {
  if (typeof why === 'string') return why;
  if (['SecurityError', 'NotAllowedError'].includes(why?.name)) return forbidden;
  return `the browser fails at it (${String(why?.message ?? why).replace(/\.$/, '')})`;
};

/** @param {import('../engine/js/haptoflow.d.ts').Material} material */
export const materialWords = (material) => (typeof material === 'string' ? material : Object.entries(material).map(([label, share]) => `${Math.round(100 * share)} % ${label}`).join(' and '));

/** The message for a silence; empty where there is nothing to say. @param {string} reason */
export const silenceSentence = (reason) => silences[reason] ?? '';

/** The line at the top of the page; errors are read out at once. */
export class Messages {
  #box = find('#message');
  #text = find('#message-text');
  #key = '';
  #missing = find('#missing');
  /** @type {Map<string, HTMLElement>} */
  #lines = new Map();

  constructor() {
    find('#message-close').addEventListener('click', () => this.clear());
  }

  /** @param {string} text @param {{kind?: 'error' | 'note', key?: string}} [options] key: by which `clear` takes back this message only */
  show(text, { kind = 'note', key = '' } = {}) {
    // A note does not cover an error.
    if (kind === 'note' && !this.#box.hidden && this.#box.dataset.kind === 'error') return;
    this.#key = key;
    this.#box.dataset.kind = kind;
    this.#box.setAttribute('role', kind === 'error' ? 'alert' : 'status');
    this.#text.textContent = text;
    this.#box.hidden = false;
  }

  /** @param {string} [key] */
  clear(key) {
    if (key !== undefined && key !== this.#key) return;
    this.#box.hidden = true;
    this.#text.textContent = '';
    this.#key = '';
  }

  /** One line, for good or until it is `found`, for what the page does without. @param {string} feature @param {any} why what was thrown, or words */
  missing(feature, why = 'this browser has none for pages') {
    if (this.#lines.has(feature)) return;
    const line = make('li', { textContent: `${feature}: ${reasonOf(why)}.` });
    this.#lines.set(feature, line);
    this.#missing.append(line);
    this.#missing.hidden = false;
  }

  /** @param {string} feature that works after all */
  found(feature) {
    this.#lines.get(feature)?.remove();
    this.#lines.delete(feature);
    this.#missing.hidden = this.#lines.size === 0;
  }

  /** @param {any} error */
  error(error) {
    this.show(sentenceOf(error), { kind: 'error' });
  }
}
