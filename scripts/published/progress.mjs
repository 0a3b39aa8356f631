// A line that shows how far downloads are: redrawn on a terminal; elsewhere one line when they are done.

const megabytes = (bytes) => (bytes / 1e6).toFixed(1);
const width = 24;

/** The bar's text. @param {{title: string, bytes: number, total: number | null, seconds: number, newBytes: number}} state */
export function barText({ title, bytes, total, seconds, newBytes }) {
  const rate = seconds > 0 ? `, ${megabytes(newBytes / seconds)} MB/s` : '';
  if (total === null) return `${title}: ${megabytes(bytes)} MB${rate}`;
  const share = total > 0 ? Math.min(1, bytes / total) : 1;
  const full = Math.round(width * share);
  return `${title}: [${'#'.repeat(full)}${'.'.repeat(width - full)}] ${Math.floor(100 * share)} %, ${megabytes(bytes)} of ${megabytes(total)} MB${rate}`;
}

/**
 * @param {string} title @param {number | null} total bytes of all files, null where the first answer states it
 * @param {NodeJS.WriteStream} stream
 */
export function progressBar(title, total, stream = process.stderr) {
  const begin = performance.now();
  let bytes = 0;
  let size = total;
  let drawn = 0;
  // What lies here from an earlier run comes at once and is no speed of the network.
  let newBytes = 0;
  const text = () => barText({ title, bytes, total: size, seconds: (performance.now() - begin) / 1000, newBytes });
  const erase = () => stream.isTTY && drawn > 0 && stream.write('\r\x1b[K');
  return {
    /** `advance` of a download. */
    advance(delta, itsSize, isHere = false) {
      bytes += delta;
      if (!isHere) newBytes += Math.max(0, delta);
      size = total ?? itsSize;
      if (!stream.isTTY || performance.now() - drawn < 100) return;
      drawn = performance.now();
      stream.write(`\r\x1b[K${text()}`);
    },
    /** A sentence between two pictures of the bar. */
    say(line) {
      erase();
      stream.write(`${line}\n`);
    },
    end() {
      erase();
      if (newBytes > 0) stream.write(`${text()}\n`);
    },
  };
}
