import { crc32, deflateSync } from 'node:zlib';

const channelsOf = { 0: 1, 2: 3, 3: 1, 4: 2, 6: 4 };
const passes = [[0, 0, 8, 8], [4, 0, 8, 8], [0, 4, 4, 8], [2, 0, 4, 4], [0, 2, 2, 4], [1, 0, 2, 2], [0, 1, 1, 2]];

function chunk(type, content) {
  const body = Buffer.concat([Buffer.from(type, 'latin1'), Buffer.from(content)]);
  const [length, sum] = [Buffer.alloc(4), Buffer.alloc(4)];
  length.writeUInt32BE(content.length);
  sum.writeUInt32BE(crc32(body));
  return Buffer.concat([length, body, sum]);
}

function foretold(filter, left, above, corner) {
  if (filter === 4) {
    const sum = left + above - corner;
    return [left, above, corner].reduce((best, each) => (Math.abs(sum - each) < Math.abs(sum - best) ? each : best));
  }
  return [0, left, above, Math.floor((left + above) / 2)][filter];
}

/** Lines of packed numbers, each with another filter. */
function lines(width, height, bits, channels, numberAt, filterOf) {
  const bytesAPixel = Math.max(1, (channels * bits) / 8);
  const all = [];
  let above = Buffer.alloc(Math.ceil((width * channels * bits) / 8));
  for (let row = 0; row < height; row += 1) {
    const line = Buffer.alloc(above.length);
    for (let at = 0; at < width * channels; at += 1) {
      const number = numberAt(Math.floor(at / channels), row, at % channels);
      if (bits === 16) line.writeUInt16BE(number, 2 * at);
      else line[(at * bits) >> 3] |= number << (8 - bits - ((at * bits) & 7));
    }
    const filter = filterOf(row);
    all.push(Buffer.from([filter]), Buffer.from(line.map((byte, at) => byte - foretold(filter, line[at - bytesAPixel] ?? 0, above[at], above[at - bytesAPixel] ?? 0))));
    above = line;
  }
  return Buffer.concat(all);
}

/** A PNG file of numbers, pixel by pixel; grey of 8 bits unless told otherwise. `lines`: as many as are written. */
export function png({ width, height, lines: written = height, numbers, bits = 8, colourType = 0, palette, isInterlaced = false, filterOf = () => 0 }) {
  const header = Buffer.alloc(13);
  header.writeUInt32BE(width, 0);
  header.writeUInt32BE(height, 4);
  header.set([bits, colourType, 0, 0, isInterlaced ? 1 : 0], 8);
  const channels = channelsOf[colourType];
  const parts = (isInterlaced ? passes : [[0, 0, 1, 1]]).map(([left, top, across, down]) => {
    const [columns, rows] = [Math.max(0, Math.ceil((width - left) / across)), Math.max(0, Math.ceil((written - top) / down))];
    return columns === 0 ? Buffer.alloc(0) : lines(columns, rows, bits, channels, (column, row, part) => numbers[channels * ((top + row * down) * width + left + column * across) + part], filterOf);
  });
  return Buffer.concat([
    Buffer.from('\x89PNG\r\n\x1a\n', 'latin1'), chunk('IHDR', header), ...(palette ? [chunk('PLTE', palette)] : []), chunk('IDAT', deflateSync(Buffer.concat(parts))), chunk('IEND', []),
  ]);
}
