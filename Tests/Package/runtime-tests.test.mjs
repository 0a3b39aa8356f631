import assert from 'node:assert/strict';
import test from 'node:test';
import { complaintsAboutCore, withoutReadOnlyMarks } from '../../scripts/lib/runtime_tests.mjs';

/** The metadata of an assembly with two streams and these signatures. */
function assembly(...signatures) {
  const entries = [[], ...signatures].map((bytes) => Buffer.from([bytes.length, ...bytes]));
  const heap = Buffer.concat(entries);
  const version = Buffer.from('v4.0.30319\0\0');
  const root = Buffer.alloc(16);
  root.write('BSJB');
  root.writeUInt32LE(version.length, 12);
  const headers = Buffer.alloc(4 + 12 + 16);
  headers.writeUInt16LE(2, 2);
  headers.write('#~\0\0', 4 + 8);
  const offset = root.length + version.length + headers.length;
  headers.writeUInt32LE(offset, 4);
  headers.writeUInt32LE(offset, 16);
  headers.writeUInt32LE(heap.length, 20);
  headers.write('#Blob\0\0\0', 24);
  return { bytes: Buffer.concat([Buffer.from('code'), root, version, headers, heap]), at: 4 + offset + 1 };
}

test('a signature "instance !0 modreq(X)& get_Item(int)" loses its mark, and no other signature changes', () => {
  const marked = [0x20, 1, 0x1f, 0x12, 0x10, 0x13, 0, 0x08];
  const markedWide = [0x20, 0, 0x1f, 0x81, 0x09, 0x10, 0x13, 0];
  const plain = [0x20, 1, 0x10, 0x13, 0, 0x08];
  const setter = [0x20, 1, 0x1f, 0x12, 0x01, 0x08];
  const { bytes, at } = assembly(marked, plain, setter, markedWide);
  const before = Buffer.from(bytes);
  assert.equal(withoutReadOnlyMarks(bytes), 2);
  assert.deepEqual([...bytes.subarray(at, at + 7)], [6, ...plain]);
  const last = at + 9 + 7 + 7;
  assert.deepEqual([...bytes.subarray(last, last + 6)], [5, 0x20, 0, 0x10, 0x13, 0]);
  assert.deepEqual(bytes.subarray(0, at), before.subarray(0, at));
  assert.deepEqual(bytes.subarray(at + 9, last), before.subarray(at + 9, last));
});

test('only complaints about the core count, each once', () => {
  const core = '/x/HaptoFlow.Core.dll : warning IL2104: Assembly \'HaptoFlow.Core\' produced trim warnings.';
  const source = '/x/Packages/com.haptoflow.runtime/Runtime/Core/A.cs(3): Trim analysis warning IL2026: uses reflection';
  const others = 'ILC : warning IL3000: NUnit.Framework\n/x/Newtonsoft.Json.dll : warning IL2104: Assembly\nHaptoFlow.Core -> HaptoFlow.Core.dll';
  assert.deepEqual(complaintsAboutCore([others, core, core, source].join('\n')), [core, source]);
  assert.deepEqual(complaintsAboutCore(others), []);
});

test('bytes that are no assembly are refused', () => {
  assert.throws(() => withoutReadOnlyMarks(Buffer.from('MZ')), /no \.NET metadata/);
});
