// Draws the pictures of menus and clicks in Documentation~: `node scripts/pack/click_pictures.mjs`. They imitate Unity's
// menus and are no screenshots, and each says so.
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { fileURLToPath } from 'node:url';
import { inRepository } from '../lib/repository.mjs';
import { dependencyName } from './dependency.mjs';
import { manifestPath } from './layout.mjs';

const colours = { ground: '#383838', bar: '#282828', field: '#2a2a2a', edge: '#1a1a1a', text: '#d2d2d2', soft: '#9a9a9a', chosen: '#2c5d87', click: '#f2a33c' };
const { name: packageName, version, dependencies } = JSON.parse(readFileSync(manifestPath, 'utf8'));
const tarballs = [`${dependencyName}-${dependencies[dependencyName]}.tgz`, `${packageName}-${version}.tgz`];
const row = 22;
const width = 640;

const escaped = (text) => text.replaceAll('&', '&amp;').replaceAll('<', '&lt;').replaceAll('>', '&gt;');
const box = (x, y, w, h, fill, edge = colours.edge) => `<rect x="${x}" y="${y}" width="${w}" height="${h}" fill="${fill}" stroke="${edge}" rx="3"/>`;
const text = (x, y, words, { size = 13, fill = colours.text, anchor = 'start' } = {}) =>
  `<text x="${x}" y="${y}" font-size="${size}" fill="${fill}" text-anchor="${anchor}">${escaped(words)}</text>`;

/** The mark of a click: its number in a disc. */
const click = (x, y, number) =>
  `<circle cx="${x}" cy="${y}" r="11" fill="${colours.click}"/>${text(x, y + 5, String(number), { size: 14, fill: '#1a1a1a', anchor: 'middle' })}`;

/** A menu; the chosen entry is highlighted and carries the number of its click. */
function menu(x, y, w, entries, chosen, number) {
  const lines = entries.map((entry, index) => {
    const top = y + 4 + index * row;
    const isChosen = entry === chosen;
    const lit = isChosen ? `<rect x="${x + 2}" y="${top}" width="${w - 4}" height="${row}" fill="${colours.chosen}"/>` : '';
    return lit + text(x + 10, top + 15, entry) + (isChosen ? click(x + w - 16, top + 11, number) : '');
  });
  return box(x, y, w, entries.length * row + 8, colours.field) + lines.join('');
}

/** A window with title and content. */
const windowed = (x, y, w, h, title, inside) => box(x, y, w, h, colours.ground) + box(x, y, w, 24, colours.bar) + text(x + 10, y + 17, title) + inside;

const button = (x, y, w, words, number) => box(x, y, w, 24, '#585858') + text(x + w / 2, y + 17, words, { anchor: 'middle' }) + (number ? click(x + w + 14, y + 12, number) : '');

const mainMenu = (chosen, number) => {
  const names = ['File', 'Edit', 'Assets', 'GameObject', 'Component', 'Window', 'Help'];
  let x = 16;
  return box(0, 0, width, 28, colours.bar) + names.map((name) => {
    const drawn = text(x, 19, name, { fill: name === chosen ? '#ffffff' : colours.soft }) + (name === chosen ? click(x + 8 * name.length + 12, 14, number) : '');
    x += 8 * name.length + 38;
    return drawn;
  }).join('');
};

/** Name, height and content of each picture. Menu names are those of Unity 2022.3 and 6. */
export const pictures = {
  'install-1-package-manager': [250, mainMenu('Window', 1) + menu(430, 32, 190, ['General', 'Rendering', 'Package Manager', 'Asset Store', 'HaptoFlow'], 'Package Manager', 2)
    + text(16, 100, 'newer versions of Unity 6: Window > Package Management >', { fill: colours.soft }) + text(16, 120, 'Package Manager', { fill: colours.soft })],
  'install-2-from-tarball': [250, windowed(16, 14, 608, 190, 'Package Manager', box(16, 38, 608, 28, colours.bar) + button(24, 40, 34, '+', 1)
    + menu(24, 70, 300, ['Install package from disk...', 'Install package from tarball...', 'Install package from git URL...'], 'Install package from tarball...', 2)
    + text(340, 110, '2022.3 calls it', { fill: colours.soft }) + text(340, 130, '"Add package from tarball..."', { fill: colours.soft }))],
  'install-3-two-files': [250, windowed(16, 14, 608, 190, 'Select package on disk', text(34, 66, 'first, then the same clicks again for the second:', { fill: colours.soft })
    + menu(34, 78, 430, tarballs, tarballs[0], 1)
    + click(448, 115, 2) + button(500, 166, 90, 'Open'))],
  'install-4-settings': [270, windowed(16, 14, 608, 210, 'Project Settings', menu(24, 46, 170, ['Audio', 'Editor', 'HaptoFlow', 'Package Manager', 'Player'], 'HaptoFlow', 1)
    + text(214, 66, 'HaptoFlow', { size: 16 }) + text(214, 92, 'This project has no HaptoFlow settings.', { fill: colours.soft }) + button(214, 110, 130, 'Create Settings', 2))],
  'first-scene-1-menu': [270, mainMenu('GameObject', 1) + menu(220, 32, 150, ['3D Object', 'Light', 'Camera', 'HaptoFlow'], 'HaptoFlow', 2)
    + menu(374, 98, 230, ['First Scene', 'Tagged Cube', 'Mouse Pen', 'XR Pen (Right Hand)', 'XR Pen (Left Hand)'], 'First Scene', 3)],
  'first-scene-2-play': [300, windowed(16, 14, 608, 240, 'Game', button(290, 16, 44, 'Play', 1)
    + '<path d="M150 210 L470 210 L420 130 L200 130 Z" fill="#b9783f" stroke="#1a1a1a"/>'
    + '<path d="M300 172 C330 150 360 190 390 168" fill="none" stroke="#f2f2f2" stroke-width="2"/>'
    + '<path d="M390 168 L412 84" stroke="#333336" stroke-width="10" stroke-linecap="round"/>' + click(430, 176, 2)
    + text(34, 236, 'hold the left mouse button over the plate and draw', { fill: colours.soft }))],
};

/** The picture as SVG. */
export function drawn(name) {
  const [height, inside] = pictures[name];
  const remark = 'A drawing after Unity\'s menus, not a screenshot; the numbers are the order of clicks.';
  return `<svg xmlns="http://www.w3.org/2000/svg" width="${width}" height="${height}" viewBox="0 0 ${width} ${height}" font-family="Arial, Helvetica, sans-serif">`
    + `<title>${escaped(name)}</title><rect width="${width}" height="${height}" fill="#202020"/>${inside}${text(16, height - 14, remark, { size: 12, fill: colours.soft })}</svg>\n`;
}

export const pictureFile = (name) => inRepository('Documentation~', 'images', `${name}.svg`);

if (process.argv[1] && path.resolve(process.argv[1]) === fileURLToPath(import.meta.url)) {
  for (const name of Object.keys(pictures)) writeFileSync(pictureFile(name), drawn(name));
}
