/**
 * Debian's Mono 6.8 has its base library built by Mono's old compiler, which leaves out the mark `modreq(InAttribute)` of
 * methods that return `ref readonly T`. It therefore does not find `ReadOnlySpan<T>`'s indexer by the signature of .NET
 * Standard 2.1, which Unity's Mono, built by the newer compiler, has. This file takes the mark out of compiled assemblies.
 */

/** The number at `at` in the metadata's compressed form, and where the next byte lies. */
function compressed(bytes, at) {
  if (bytes[at] < 0x80) return [bytes[at], at + 1];
  if (bytes[at] < 0xc0) return [((bytes[at] & 0x3f) << 8) | bytes[at + 1], at + 2];
  return [bytes.readUInt32BE(at) & 0x1fffffff, at + 4];
}

/** Where the heap of signatures of a .NET assembly begins and ends. Throws RangeError where the bytes hold no metadata. */
function blobHeap(bytes) {
  const root = bytes.indexOf('BSJB');
  if (root < 0) throw new RangeError('no .NET metadata');
  let at = root + 16 + bytes.readUInt32LE(root + 12);
  const streams = bytes.readUInt16LE(at + 2);
  at += 4;
  for (let stream = 0; stream < streams; stream += 1) {
    const [offset, size] = [bytes.readUInt32LE(at), bytes.readUInt32LE(at + 4)];
    const end = bytes.indexOf(0, at + 8);
    if (bytes.toString('latin1', at + 8, end) === '#Blob') return [root + offset, root + offset + size];
    at = at + 8 + 4 * Math.ceil((end + 1 - at - 8) / 4);
  }
  throw new RangeError('no heap of signatures');
}

const [instanceMethod, requiredModifier, byReference, typeParameter] = [0x20, 0x1f, 0x10, 0x13];

/**
 * Removes the modifier from every signature `instance !0 modreq(X)& method(...)`, in place; an entry of the heap becomes
 * shorter and the bytes behind it stay unused.
 * @param {Buffer} bytes an assembly
 * @returns {number} the number of signatures changed
 */
export function withoutReadOnlyMarks(bytes) {
  const [begin, end] = blobHeap(bytes);
  let changed = 0;
  for (let at = begin; at < end;) {
    const [length, first] = compressed(bytes, at);
    const next = first + length;
    if (length >= 6 && length < 0x80 && bytes[first] === instanceMethod && bytes[first + 2] === requiredModifier) {
      const [, type] = compressed(bytes, first + 3);
      if (bytes[type] === byReference && bytes[type + 1] === typeParameter) {
        bytes.copy(bytes, first + 2, type, next);
        bytes[at] = length - (type - first - 2);
        changed += 1;
      }
    }
    at = next;
  }
  return changed;
}
