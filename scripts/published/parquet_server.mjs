// Reads Parquet files for haptoflow_training where pyarrow is missing, one process for many files. For each file, standard
// input brings its length in bytes (8, little-endian) and its bytes; standard output answers with the length of a JSON
// header (8, little-endian), the header, {rows, columns: [{name, dtype or kind, bytes}]} or {problem}, and the columns'
// bytes one after another. Header {"ready": true} comes first, or {"missing"} where `npm ci` has not been run.

async function reader() {
  try {
    return await import('./parquet_columns.mjs');
  } catch (error) {
    if (error.code !== 'ERR_MODULE_NOT_FOUND') throw error;
    return null;
  }
}

function answer(header, arrays = []) {
  const text = Buffer.from(JSON.stringify(header));
  const length = Buffer.alloc(8);
  length.writeBigUInt64LE(BigInt(text.length));
  const parts = arrays.map((values) => Buffer.from(values.buffer, values.byteOffset, values.byteLength));
  return new Promise((resolve) => {
    process.stdout.write(Buffer.concat([length, text, ...parts]), resolve);
  });
}

/** The input's files, one after another. */
async function* files() {
  let parts = [];
  let held = 0;
  let wanted = null;
  for await (const part of process.stdin) {
    parts.push(part);
    held += part.length;
    while (held >= (wanted ?? 8)) {
      const bytes = Buffer.concat(parts);
      const taken = wanted ?? 8;
      parts = [bytes.subarray(taken)];
      held -= taken;
      if (wanted === null) {
        wanted = Number(bytes.readBigUInt64LE(0));
      } else {
        yield bytes.subarray(0, taken);
        wanted = null;
      }
    }
  }
}

const found = await reader();
await answer(found ? { ready: true } : { missing: 'hyparquet' });
if (found) {
  for await (const bytes of files()) {
    try {
      const { rows, columns } = await found.readColumns(bytes);
      const described = columns.map(({ values, ...column }) => (values ? { ...column, bytes: values.byteLength } : column));
      await answer({ rows, columns: described }, columns.flatMap(({ values }) => (values ? [values] : [])));
    } catch (error) {
      if (!(error instanceof found.ParquetError)) throw error;
      await answer({ problem: error.message });
    }
  }
}
