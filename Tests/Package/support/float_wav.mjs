const formatFloat = 3;

/**
 * Reads a RIFF/WAVE file of one channel of 32-bit float samples, as `haptoflow render` writes it.
 * @param {Buffer} bytes @param {string} name shown in errors
 * @returns {{rateHz: number, samples: Float32Array}}
 */
export function readFloatWav(bytes, name) {
  if (bytes.length < 12 || bytes.toString('latin1', 0, 4) !== 'RIFF' || bytes.toString('latin1', 8, 12) !== 'WAVE') {
    throw new RangeError(`${name}: expected a RIFF/WAVE file`);
  }
  let rateHz = 0;
  for (let offset = 12; offset + 8 <= bytes.length; ) {
    const chunk = bytes.toString('latin1', offset, offset + 4);
    const size = bytes.readUInt32LE(offset + 4);
    const begin = offset + 8;
    if (begin + size > bytes.length) throw new RangeError(`${name}: its "${chunk}" chunk is cut off`);
    if (chunk === 'fmt ') {
      const [format, channels, bits] = [bytes.readUInt16LE(begin), bytes.readUInt16LE(begin + 2), bytes.readUInt16LE(begin + 14)];
      if (format !== formatFloat || channels !== 1 || bits !== 32) {
        throw new RangeError(`${name}: expected one channel of 32-bit float, got format ${format}, ${channels} channels, ${bits} bits`);
      }
      rateHz = bytes.readUInt32LE(begin + 4);
    } else if (chunk === 'data') {
      if (rateHz === 0) throw new RangeError(`${name}: its "data" chunk comes before "fmt "`);
      const samples = new Float32Array(Math.floor(size / 4));
      for (let index = 0; index < samples.length; index += 1) samples[index] = bytes.readFloatLE(begin + 4 * index);
      return { rateHz, samples };
    }
    offset = begin + size + (size % 2);
  }
  throw new RangeError(`${name}: has no "data" chunk`);
}
