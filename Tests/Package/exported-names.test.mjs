import assert from 'node:assert/strict';
import { readFileSync } from 'node:fs';
import test from 'node:test';
import { declaredNames, exportedNames } from '../../scripts/lib/exported_names.mjs';
import { inRepository } from '../../scripts/lib/repository.mjs';

test('the library must export the functions of the header and the entry that Unity looks up', () => {
  const header = 'HAPTOFLOW_API const char* haptoflow_version(void);\n\nHAPTOFLOW_API haptoflow_status\nhaptoflow_panic(void);\n';
  assert.deepEqual(declaredNames(header), ['UnityGetAudioEffectDefinitions', 'haptoflow_panic', 'haptoflow_version']);
  const real = readFileSync(inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h'), 'utf8');
  assert.equal(declaredNames(real).length, real.match(/^HAPTOFLOW_API /gm).length + 1);
});

test('the exported names are read from the output of objdump, of old and new binutils', () => {
  const addresses = 'Export Address Table -- Ordinal Base 1\n\t[   0] +base[   1] 1234 Export RVA\n\n';
  const old = `${addresses}[Ordinal/Name Pointer] Table\n\t[   0] haptoflow_version\n\t[   1] a_stray_one\n\nThe Function Table\n\t[   2] not_this\n`;
  assert.deepEqual(exportedNames(old), ['a_stray_one', 'haptoflow_version']);
  const recent = `${addresses}[Ordinal/Name Pointer] Table -- Ordinal Base 1\n\t[   0] +base[   1]  0000 haptoflow_version\n\nmore\n`;
  assert.deepEqual(exportedNames(recent), ['haptoflow_version']);
  assert.deepEqual(exportedNames('no table at all'), []);
});
