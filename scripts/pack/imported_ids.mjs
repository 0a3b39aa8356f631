const mask = (1n << 64n) - 1n;
const primes = [0x9e3779b185ebca87n, 0xc2b2ae3d27d4eb4fn, 0x165667b19e3779f9n, 0x85ebca77c2b2ae63n, 0x27d4eb2f165667c5n];
const rotate = (value, bits) => ((value << BigInt(bits)) | (value >> BigInt(64 - bits))) & mask;
const round = (sum, lane) => (rotate((sum + lane * primes[1]) & mask, 31) * primes[0]) & mask;

/** xxHash64 with seed 0 (Collet; the algorithm's public specification). @param {Buffer} bytes @returns {bigint} */
export function xxHash64(bytes) {
  let at = 0;
  let hash;
  if (bytes.length >= 32) {
    const sums = [(primes[0] + primes[1]) & mask, primes[1], 0n, (1n << 64n) - primes[0]];
    for (; at + 32 <= bytes.length; at += 32) {
      sums.forEach((sum, lane) => {
        sums[lane] = round(sum, bytes.readBigUInt64LE(at + 8 * lane));
      });
    }
    hash = (rotate(sums[0], 1) + rotate(sums[1], 7) + rotate(sums[2], 12) + rotate(sums[3], 18)) & mask;
    for (const sum of sums) hash = ((hash ^ round(0n, sum)) * primes[0] + primes[3]) & mask;
  } else {
    hash = primes[4];
  }
  hash = (hash + BigInt(bytes.length)) & mask;
  for (; at + 8 <= bytes.length; at += 8) hash = (rotate(hash ^ round(0n, bytes.readBigUInt64LE(at)), 27) * primes[0] + primes[3]) & mask;
  if (at + 4 <= bytes.length) {
    hash = (rotate(hash ^ ((BigInt(bytes.readUInt32LE(at)) * primes[0]) & mask), 23) * primes[1] + primes[2]) & mask;
    at += 4;
  }
  for (; at < bytes.length; at += 1) hash = (rotate(hash ^ ((BigInt(bytes[at]) * primes[4]) & mask), 11) * primes[0]) & mask;
  hash = ((hash ^ (hash >> 33n)) * primes[1]) & mask;
  hash = ((hash ^ (hash >> 29n)) * primes[2]) & mask;
  return hash ^ (hash >> 32n);
}

/**
 * The fileID by which scenes refer to a ScriptableObject that a ScriptedImporter added under an identifier: Unity hashes
 * the object's native type, the identifier and a count. Published asset files agree: the identifier "<root>" of input
 * action assets gives -944628639613478452, "tree" of visual trees 9197481963319205126.
 */
export function importedObjectId(identifier) {
  return BigInt.asIntN(64, xxHash64(Buffer.from(`Type:MonoBehaviour->${identifier}0`, 'utf8'))).toString();
}
