import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { declaredNames, exportedNames } from '../../scripts/lib/libraries.mjs';
import { inRepository } from '../../scripts/lib/process.mjs';
import { dllOf } from './support/dll.mjs';
import { elfWithSymbols } from './support/elf.mjs';

test('the library must export the functions of the header and the entry that Unity looks up', () => {
  const header = 'HAPTOFLOW_API const char* haptoflow_version(void);\n\nHAPTOFLOW_API haptoflow_status\nhaptoflow_panic(void);\n';
  assert.deepEqual(declaredNames(header), ['UnityGetAudioEffectDefinitions', 'haptoflow_panic', 'haptoflow_version']);
  const real = readFileSync(inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h'), 'utf8');
  assert.equal(declaredNames(real).length, real.match(/^HAPTOFLOW_API /gm).length + 1);
});

test('a DLL\'s exported names are read from its bytes, and a DLL that breaks off has none', () => {
  const whole = dllOf(['haptoflow_version', 'a_stray_one']);
  assert.deepEqual(exportedNames(whole), ['a_stray_one', 'haptoflow_version']);
  for (const length of [2, 64, 200, 400]) assert.deepEqual(exportedNames(whole.subarray(0, length)), [], `${length} bytes`);
});

test('an ELF exports the dynamic symbols that have a place in it, and neither its own local ones nor those of other libraries', () => {
  const whole = elfWithSymbols([{ name: 'memcpy', section: 0 }, { name: '.init', section: 9, isLocal: true }, { name: 'haptoflow_version', section: 12 }, { name: 'a_stray_one', section: 9 }]);
  assert.deepEqual(exportedNames(whole), ['a_stray_one', 'haptoflow_version']);
  for (const length of [2, 63, 70, whole.length - 10]) assert.deepEqual(exportedNames(whole.subarray(0, length)), [], `${length} bytes`);
});
