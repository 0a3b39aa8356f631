import { parquetMetadataAsync, parquetSchema, parquetScan } from 'hyparquet';
import { compressors } from 'hyparquet-compressors';

/** A file that is no readable Parquet table; the message says what was found. */
export class ParquetError extends Error {}

/** Array of each dtype, as NumPy writes it: little-endian, as Node's machines are. */
const arrays = {
  '<i4': Int32Array, '<u4': Uint32Array, '<i8': BigInt64Array, '<u8': BigUint64Array, '<f4': Float32Array, '<f8': Float64Array,
};

const mark = (bytes, offset) => String.fromCharCode(...bytes.subarray(offset, offset + 4));

function checkMarks(bytes) {
  if (bytes.length < 12 || !['PAR1', 'PARE'].includes(mark(bytes, 0))) throw new ParquetError('not a Parquet file');
  if (mark(bytes, bytes.length - 4) === 'PARE') throw new ParquetError('an encrypted Parquet file');
  if (mark(bytes, bytes.length - 4) !== 'PAR1') throw new ParquetError('a truncated Parquet file: its end is missing');
}

/** {dtype} of a column of numbers, or {kind}: what its values are instead. */
function describe({ element, children }) {
  const { type, converted_type: converted, logical_type: logical, repetition_type: repetition } = element;
  if (converted === 'LIST' || repetition === 'REPEATED') return { kind: 'a list' };
  if (children.length > 0) return { kind: 'a group' };
  if (converted === 'DECIMAL' || logical?.type === 'DECIMAL') return { dtype: '<f8' };
  if (type === 'FLOAT') return { dtype: '<f4' };
  if (type === 'DOUBLE') return { dtype: '<f8' };
  if (type === 'BOOLEAN') return { kind: 'true or false' };
  // Whole numbers; anything else that is stored as one is a date, a time of day or a time stamp.
  const whole = (converted === undefined && logical === undefined) || /^U?INT_/.test(converted) || logical?.type === 'INTEGER';
  const unsigned = /^UINT_/.test(converted) || (logical?.type === 'INTEGER' && !logical.isSigned);
  if (type === 'INT32') return whole ? { dtype: unsigned ? '<u4' : '<i4' } : { kind: 'a date or a time of day' };
  if (type === 'INT64') return whole ? { dtype: unsigned ? '<u8' : '<i8' } : { kind: 'a date or a time of day' };
  if (type === 'INT96') return { kind: 'a date or a time of day' };
  return { kind: 'text' };
}

/** The values of pieces in one array; whole numbers with missing ones become float64 with NaN, as pandas has them. */
function joined(pieces, dtype, rows) {
  const Whole = arrays[dtype];
  const values = new Whole(rows);
  let at = 0;
  for (const piece of pieces) {
    if (piece instanceof Whole) {
      values.set(piece, at);
    } else {
      for (let index = 0; index < piece.length; index += 1) {
        const value = piece[index];
        if (value === null || value === undefined) {
          if (!dtype.startsWith('<f')) return joined(pieces.map((one) => Array.from(one, (each) => (each == null ? NaN : Number(each)))), '<f8', rows);
          values[at + index] = NaN;
        } else {
          values[at + index] = value;
        }
      }
    }
    at += piece.length;
  }
  return { dtype, values };
}

function checkCodecs(metadata) {
  for (const { columns } of metadata.row_groups) {
    for (const { meta_data: column } of columns) {
      if (column && column.codec !== 'UNCOMPRESSED' && !compressors[column.codec]) {
        throw new ParquetError(`column ${column.path_in_schema.join('.')} is compressed by ${column.codec ?? 'a codec of another number'}, which is not known here`);
      }
    }
  }
}

/**
 * The top-level columns of a Parquet file, in its order.
 * @param {Uint8Array} bytes the whole file
 * @returns {Promise<{rows: number, columns: {name: string, dtype?: string, kind?: string, values?: ArrayBufferView}[]}>}
 *   Columns of numbers have dtype and values [rows] (missing ones NaN); others have only kind, what they hold instead.
 * @throws ParquetError
 */
export async function readColumns(bytes) {
  checkMarks(bytes);
  try {
    // Not `bytes.slice`: a Buffer's own is a view, whose `buffer` begins elsewhere.
    const file = { byteLength: bytes.length, slice: (begin, end) => Uint8Array.prototype.slice.call(bytes, begin, end).buffer };
    const metadata = await parquetMetadataAsync(file);
    checkCodecs(metadata);
    const rows = Number(metadata.num_rows);
    const scan = await parquetScan({ file, metadata, compressors, useOffsetIndex: false });
    const columns = [];
    for (const child of parquetSchema(metadata).children) {
      const { name } = child.element;
      const { dtype, kind } = describe(child);
      if (kind) {
        columns.push({ name, kind });
        continue;
      }
      const pieces = [];
      for (const range of scan.ranges) pieces.push(await scan.readColumn({ column: name, ...range }));
      const count = pieces.reduce((sum, piece) => sum + piece.length, 0);
      if (count !== rows) throw new ParquetError(`column ${name} has ${count} of ${rows} rows`);
      columns.push({ name, ...joined(pieces, dtype, rows) });
    }
    return { rows, columns };
  } catch (error) {
    if (error instanceof ParquetError) throw error;
    throw new ParquetError(`a damaged Parquet file (${error.message})`);
  }
}
