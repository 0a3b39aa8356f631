import path from 'node:path';
import { openPage } from './browser.mjs';
import { repository } from './places.mjs';

const inRepository = (/** @type {string[]} */ ...names) => path.join(repository, ...names);

/** A page in Chromium with an emulated Quest. */
export const openHeadsetPage = (/** @type {object} */ options = {}) => openPage({
  name: 'xr',
  folders: {
    xr: inRepository('Web', 'page', 'xr'),
    signal: inRepository('Web', 'page', 'signal'),
    table: inRepository('Web', 'page', 'table'),
    scene: inRepository('Web', 'page', 'scene'),
    three: inRepository('node_modules', 'three', 'build'),
    iwer: inRepository('node_modules', 'iwer', 'build'),
  },
  ...options,
});
