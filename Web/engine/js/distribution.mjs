/**
 * By nearest rank, as `haptoflow bench` has it; not a number where nothing was measured.
 * @param {readonly number[]} values
 */
export function distribution(values) {
  const sorted = [...values].sort((one, other) => one - other);
  const at = (/** @type {number} */ share) => sorted[Math.max(1, Math.ceil(share * sorted.length)) - 1] ?? NaN;
  return { count: sorted.length, minimum: at(0), median: at(0.5), percentile99: at(0.99), worst: at(1) };
}
