import assert from 'node:assert/strict';
import { readFileSync, writeFileSync } from 'node:fs';
import path from 'node:path';
import { after, before, describe, test } from 'node:test';
import { render } from '../../Web/engine/js/offline.mjs';
import { decodePng, encodePng } from '../../Web/engine/js/png.mjs';
import { mostTexels } from '../../Web/engine/js/relief.mjs';
import { hasBrowser, openPage } from './support/browser.mjs';
import { coreWithModel, hasCommandLine, native, sample, samplePath, wavSamples } from './support/engine.mjs';
import { png } from './support/png.mjs';

// Scenes whose surfaces name images of heights or normals sound as at the command line.

const core = await coreWithModel();
const boards = { scene: sample('boards.scene.json'), stroke: sample('tracing.stroke.csv') };
const boardsFile = readFileSync(samplePath('boards.png'));

function difference(web, other) {
  assert.equal(web.length, other.length);
  const peak = other.reduce((most, each) => Math.max(most, Math.abs(each)), 0);
  assert.ok(peak > 0.01, `the peak is ${peak}`);
  return other.reduce((most, each, index) => Math.max(most, Math.abs(each - web[index])), 0) / peak;
}

const words = ['--quiet', '--quality', 'sketch', '--effects'];
const effects = { texture: true, impact: true, edge: true };
const nativeBoards = () => native(
  (folder) => ['render', samplePath('boards.scene.json'), '--stroke', samplePath('tracing.stroke.csv'), '-o', path.join(folder, 'out.wav'), ...words, 'texture,impact,edge'],
  (folder) => wavSamples(path.join(folder, 'out.wav')),
);

// Over this stroke the engine of Clang 14 once kept a filter that the native one exchanged.
test('the boards of the samples sound as at the command line, within a millionth of the peak', { skip: !hasCommandLine }, async () => {
  const images = { 'boards.png': await decodePng(boardsFile) };
  const found = difference(render(core, { ...boards, quality: 'sketch', effects, images }).samples, nativeBoards());
  assert.ok(found < 1e-6, `difference ${found}`);
});

const [width, height] = [48, 32];
const wave = (index) => 0.5 + 0.5 * Math.sin((2 * Math.PI * (index % width)) / 12 + Math.floor(index / width) / 3);
const files = {
  'grey of 8 bits': { relief: { image: 'map.png', tiled: false, share: 0.2 }, file: { numbers: Array.from({ length: width * height }, (_, index) => Math.round(255 * wave(index))) } },
  'colours of 16 bits with opacity': {
    relief: { image: 'map.png' },
    file: { bits: 16, colourType: 6, numbers: Array.from({ length: 4 * width * height }, (_, at) => Math.round(65535 * wave(Math.floor(at / 4)) * [1, 0.5, 0.8, 0.1][at % 4])) },
  },
  'normals, tiled': { relief: { normals: 'map.png' }, file: { colourType: 2, numbers: normals(), filterOf: (row) => row % 5 } },
  'normals of one tile': { relief: { normals: 'map.png', tiled: false }, file: { colourType: 2, numbers: normals() } },
};
function normals() {
  return Array.from({ length: width * height }, (_, index) => {
    const [x, y] = [0.4 * Math.cos((2 * Math.PI * (index % width)) / 12), 0.3 * Math.sin((2 * Math.PI * Math.floor(index / width)) / 16)];
    const length = Math.hypot(x, y, 1);
    return [x, y, 1].map((part) => Math.round(127.5 + (127.5 * part) / length));
  }).flat();
}
const sceneOf = (relief) => ({ surfaces: [{ name: 'table', shape: { box: { size: [1, 0.02, 1] } }, position: [0, -0.01, 0], material: 'wood', relief }], stylus: { tip_radius: 0.0005 } });
const stroke = `t,x,y,z,force\n${Array.from({ length: 101 }, (_, row) => `${0.01 * row},${(0.0015 * row - 0.1).toFixed(6)},0.0004,${(0.0004 * row).toFixed(6)},1`).join('\n')}\n`;

for (const [name, { relief, file }] of Object.entries(files)) {
  test(`${name}: the command line's samples`, { skip: !hasCommandLine }, async () => {
    const bytes = png({ width, height, ...file });
    const scene = sceneOf({ size: [0.05, 0.03], depth: 2e-4, ...relief });
    const expected = native((folder) => {
      const at = (entry) => path.join(folder, entry);
      writeFileSync(at('map.png'), bytes);
      writeFileSync(at('scene.json'), JSON.stringify(scene));
      writeFileSync(at('stroke.csv'), stroke);
      return ['render', at('scene.json'), '--stroke', at('stroke.csv'), '-o', at('out.wav'), ...words, 'texture,impact,edge'];
    }, (folder) => wavSamples(path.join(folder, 'out.wav')));
    const options = { scene, stroke, quality: 'sketch', effects };
    const web = render(core, { ...options, images: { 'map.png': await decodePng(bytes) } });
    assert.ok(difference(web.samples, expected) < 1e-5, `difference ${difference(web.samples, expected)}`);
    assert.ok(difference(render(core, { ...options, effects: { ...effects, relief: false } }).samples, expected) > 0.1, 'the relief makes no difference');
  });
}

test('every kind of PNG file is read, bit by bit, and what is written is read again', async () => {
  const [columns, rows] = [13, 11];
  const depths = { 0: [1, 2, 4, 8, 16], 2: [8, 16], 3: [1, 2, 4, 8], 4: [8, 16], 6: [8, 16] };
  const channelsOf = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };
  for (const [type, all] of Object.entries(depths)) {
    for (const bits of all) {
      for (const isInterlaced of [false, true]) {
        const colourType = Number(type);
        const channels = channelsOf[colourType];
        const numbers = Array.from({ length: channels * columns * rows }, (_, at) => (at * 7919 + 13 * Math.floor(at / 5) ** 2) % 2 ** bits);
        const palette = colourType === 3 ? Array.from({ length: 3 * 2 ** bits }, (_, at) => (at * 37) % 256) : undefined;
        const image = await decodePng(png({ width: columns, height: rows, numbers, bits, colourType, palette, isInterlaced, filterOf: (row) => row % 5 }));
        const most = bits === 16 ? 65535 : 255;
        const expected = Array.from({ length: columns * rows }, (_, index) => {
          const own = numbers.slice(channels * index, channels * (index + 1)).map((number) => (colourType === 3 ? number : (number * most) / (2 ** bits - 1)));
          if (palette) return [...palette.slice(3 * own[0], 3 * own[0] + 3), most];
          return channels < 3 ? [own[0], own[0], own[0], own[1] ?? most] : [own[0], own[1], own[2], own[3] ?? most];
        }).flat();
        assert.deepEqual([...image.data], expected, `type ${type}, ${bits} bits, interlaced: ${isInterlaced}`);
      }
    }
  }
  const greys = Uint16Array.from({ length: columns * rows }, (_, index) => (index * 9973) % 65536);
  const again = await decodePng(await encodePng(columns, rows, greys));
  assert.deepEqual([...again.data].filter((_, at) => at % 4 === 1), [...greys]);
});

/** What `action` is refused by. */
const refusalOf = async (action) => {
  try {
    await action();
  } catch (error) {
    return error;
  }
  throw new Error('nothing was refused');
};
const rendered = (relief, images) => () => render(core, { scene: sceneOf(relief), stroke, quality: 'sketch', images });
const map = { image: 'map.png', size: [0.1, 0.1], depth: 1e-3 };
const whole = png({ width: 8, height: 8, numbers: Array.from({ length: 64 }, (_, at) => at) });
const ill = Buffer.from(whole);
ill[45] ^= 8;

const refusals = [
  ['an image that was not given', rendered(map, {}), 'input', /^scene: surfaces\[0\]\.relief\.image: "map\.png" is not among the images; give its pixels/],
  ['normals that were not given', rendered({ ...map, image: undefined, normals: 'up.png' }, { 'map.png': whole }), 'input', /relief\.normals: "up\.png"/],
  ['bytes in place of pixels', rendered(map, { 'map.png': whole }), 'invalid-argument', /^map\.png: expected width, height and data/],
  ['too few pixels', rendered(map, { 'map.png': { width: 2, height: 2, data: new Uint8Array(15) } }), 'invalid-argument', /^map\.png: 15 numbers for 2 x 2 pixels/],
  ['a width that is no number', rendered(map, { 'map.png': { width: NaN, height: 2, data: new Uint8Array(16) } }), 'invalid-argument', /NaN x 2/],
  ['no pixels', rendered(map, { 'map.png': { width: 0, height: 0, data: new Uint8Array(0) } }), 'invalid-argument', /0 x 0/],
  ['numbers that are none', rendered(map, { 'map.png': { width: 1, height: 1, data: new Float32Array([NaN, 0, 0, 1]) } }), 'INVALID_ARGUMENT', /finite/],
  ['normals that are none', rendered({ ...map, image: undefined, normals: 'map.png' }, { 'map.png': { width: 1, height: 1, data: new Float32Array([NaN, 0, 0, 1]) } }), 'INVALID_ARGUMENT', /finite/],
  ['an unknown key', rendered({ ...map, tile: 1 }, {}), 'input', /unknown key "tile"/],
  ['a size that is no size', rendered({ ...map, size: [0, 1] }, {}), 'input', /surfaces\[0\]\.relief\.size/],
  ['both kinds of images', rendered({ ...map, normals: 'b.png' }, {}), 'input', /"image" \(heights\) and "normals"/],
  ['text in place of a file', () => decodePng(new TextEncoder().encode('no image'), 'text.png'), 'input', /^text\.png: not a PNG file$/],
  ['a file cut short', () => decodePng(whole.subarray(0, 60), 'cut.png'), 'input', /^cut\.png: damaged \(the file is cut short\)/],
  ['a file with a changed bit', () => decodePng(ill, 'ill.png'), 'input', /^ill\.png: damaged \(a wrong check sum of IDAT\)/],
  ['a file of too few pixels', () => decodePng(png({ width: 8, height: 8, numbers: [], lines: 5 }), 'few.png'), 'input', /^few\.png: damaged \(too few pixels\)/],
  ['no bytes', () => decodePng(new Uint8Array(0), 'none.png'), 'input', /^none\.png: not a PNG file/],
];
for (const [name, action, code, message] of refusals) {
  test(`${name}: refused in words`, async () => {
    const error = await refusalOf(action);
    assert.equal(error.code, code, error.message);
    assert.match(error.message, message);
  });
}

test('the engine has the limit of texels that the scripts have', () => {
  const of = (rows) => ({ columns: 2 ** 20, rows, heightsMetres: new Float32Array(2 ** 20 * rows), sizeMetres: [0.1, 0.1], depthMetres: 1e-3 });
  assert.equal(mostTexels, 3 * 2 ** 20);
  const { scene, ...plain } = { scene: sceneOf(undefined), stroke, quality: 'sketch' };
  assert.throws(() => render(core, { scene, ...plain, reliefs: { table: of(4) } }), /3145728/);
  const wide = { 'map.png': { width: 2 ** 20, height: 4, data: new Uint8Array(2 ** 24) } };
  assert.throws(() => render(core, { scene: sceneOf(map), ...plain, images: wide }), /^HaptoFlowError: map\.png: 1048576 x 4 texels; a relief has at most 3145728, such as 2048 x 1536\. Make the image smaller$/);
});

describe('in a page', { skip: !hasBrowser }, () => {
  /** @type {Awaited<ReturnType<typeof openPage>>} */
  let opened;
  before(async () => {
    opened = await openPage({ folders: { scenes: path.dirname(samplePath('boards.png')) } });
  });
  after(() => opened.close());
  const inPage = (action, argument) => opened.page.evaluate(action, argument);

  test('a scene fetches its images from beside itself, and gives the command line\'s samples', { skip: !hasCommandLine }, async () => {
    const samples = await inPage(async (given) => {
      const sceneBase = '/scenes/boards.scene.json';
      const scene = await (await fetch(sceneBase)).text();
      return Array.from((await globalThis.HaptoFlow.render({ scene, sceneBase, quality: 'sketch', ...given })).samples);
    }, { stroke: boards.stroke, effects });
    const found = difference(samples, nativeBoards());
    assert.ok(found < 1e-6, `difference ${found}`);
  });

  test('the reliefs of a scene are laid for a live tip; a file that is missing, or is none, is named with its key and the remedy', async () => {
    opened.server.changes.set('/scenes/boards.png', (bytes) => bytes);
    const found = await inPage(async () => {
      const haptics = await globalThis.HaptoFlow.create({ quality: 'sketch' });
      const text = await (await fetch('/scenes/boards.scene.json')).text();
      const scene = haptics.loadScene(text);
      const at = (seconds) => scene.update({ timeSeconds: seconds, positionMetres: [0.015, 0.001, 0.03], forceNewtons: 1 });
      const before = at(0).relief;
      const reliefs = await haptics.loadReliefs(scene, { sceneBase: '/scenes/' });
      const contact = at(0.01);
      const place = [...contact.reliefPlace];
      const isLaid = contact.relief === reliefs[0];
      const { columns, rows, sizeMetres, depthMetres, tipRadiusMetres, isTiled } = reliefs[0];
      const refusal = async (options) => {
        try {
          await haptics.loadReliefs(haptics.loadScene(text), options);
          return 'nothing was refused';
        } catch ({ code, message }) {
          return `${code}: ${message}`;
        }
      };
      const refusals = [await refusal({ sceneBase: '/nowhere/' }), await refusal({ images: { 'boards.png': { width: 2, height: 2, data: new Uint8Array(3) } } })];
      const normals = await haptics.createRelief({ image: { width: 2, height: 2, data: Uint8Array.from({ length: 16 }, (_, at) => [128, 128, 255, 255][at % 4]) }, isNormalMap: true, sizeMetres: [0.1, 0.1], depthMetres: 1e-3 });
      const flat = [...normals.heightsMetres];
      await haptics.close();
      return { before, isLaid, place, columns, rows, sizeMetres, depthMetres, tipRadiusMetres, isTiled, refusals, flat, surface: scene.surfaces[0].relief };
    });
    assert.equal(found.before, null);
    assert.equal(found.isLaid, true);
    assert.deepEqual(found.place.map((part) => Number(part.toFixed(5))), [0.25, -0.5]);
    assert.deepEqual([found.columns, found.rows, found.sizeMetres, found.depthMetres, found.tipRadiusMetres, found.isTiled], [480, 8, [0.06, 0.06], 0.0003, 0.002, true]);
    assert.deepEqual(found.surface, { image: 'boards.png', isNormalMap: false, sizeMetres: [0.06, 0.06], depthMetres: 0.0003, isTiled: true, share: 0.5 });
    assert.match(found.refusals[0], /^input: http.*\/nowhere\/boards\.png: 404.*; scene: surfaces\[0\]\.relief\.image is relative to the scene: give its address as sceneBase/);
    assert.match(found.refusals[1], /^invalid-argument: boards\.png: 3 numbers for 2 x 2 pixels/);
    assert.ok(found.flat.every((heightMetres) => heightMetres <= 1e-3), `${found.flat}`);
    opened.server.changes.set('/scenes/boards.png', () => Buffer.from('<!doctype html>'));
    const refused = await inPage(async () => {
      const haptics = await globalThis.HaptoFlow.create({ quality: 'sketch' });
      const scene = await (await fetch('/scenes/boards.scene.json')).text();
      const message = await haptics.render({ scene, stroke: 't,x,y,z\n0,0,0,0\n1,0,0,0\n', sceneBase: '/scenes/' }).catch((error) => `${error.code}: ${error.message}`);
      await haptics.close();
      return message;
    });
    opened.server.changes.clear();
    assert.equal(refused, 'input: boards.png: not a PNG file');
  });

  test('a picture is scaled to the pixels that are wanted, and what is none is refused by its name', async () => {
    const found = await inPage(async () => {
      const canvas = new OffscreenCanvas(300, 200);
      const context = canvas.getContext('2d');
      context.fillStyle = 'rgb(0 0 0)';
      context.fillRect(0, 0, 300, 200);
      const of = async (type, mostPixels) => {
        const { width, height, data, fullWidth, fullHeight } = await globalThis.HaptoFlow.decodeImage(new File([await canvas.convertToBlob({ type })], 'a.x'), { mostPixels });
        return [width, height, data.length, fullWidth, fullHeight];
      };
      const refusal = await globalThis.HaptoFlow.decodeImage(new File(['no picture'], 'b.jpg')).catch((error) => `${error.code}: ${error.message}`);
      return { sizes: [await of('image/png'), await of('image/png', 15000), await of('image/jpeg', 60000), await of('image/webp', 7)], refusal, most: globalThis.HaptoFlow.mostTexels };
    });
    assert.deepEqual(found.sizes, [[300, 200, 240000, 300, 200], [150, 100, 60000, 300, 200], [300, 200, 240000, 300, 200], [3, 2, 24, 300, 200]]);
    assert.match(found.refusal, /^input: b\.jpg: damaged, too large, or no picture that this browser reads/);
    assert.equal(found.most, mostTexels);
  });
});
