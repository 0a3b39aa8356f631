/**
 * A CSV file with a header line and no quoted fields, as the stroke files and `haptoflow contact` are.
 * @param {string} text @param {string} name shown in errors @param {string[]} required columns that must be there
 * @returns {Record<string, string>[]} one object a row
 */
export function parseCsv(text, name, required) {
  const lines = text.split(/\r?\n/).filter((line) => line.trim() !== '');
  const header = (lines.shift() ?? '').split(',').map((word) => word.trim());
  const absent = required.filter((column) => !header.includes(column));
  if (absent.length > 0) throw new RangeError(`${name}, line 1: expected the columns ${required.join(', ')}; ${absent.join(', ')} not there`);
  return lines.map((line, index) => {
    const fields = line.split(',');
    if (fields.length !== header.length) {
      throw new RangeError(`${name}, row ${index + 1}: expected ${header.length} fields, got ${fields.length}`);
    }
    return Object.fromEntries(header.map((column, place) => [column, fields[place].trim()]));
  });
}
