import { readFileSync } from 'node:fs';
import { run } from './process.mjs';
import { inRepository } from './repository.mjs';

/** What Unity looks up by name, declared in its own SDK and not in haptoflow.h. */
const unitysEntry = 'UnityGetAudioEffectDefinitions';

/** Names that a library of HaptoFlow exports, by the text of haptoflow.h: what Tests/Native/capi/exports_test.cpp asks of an ELF. */
export function declaredNames(headerText) {
  return [...headerText.matchAll(/^HAPTOFLOW_API [^(;]*?(haptoflow_\w+)\(/gm)].map(([, name]) => name).concat(unitysEntry).sort();
}

/** Names in the export table that `objdump -p` prints of a DLL. */
export function exportedNames(objdumpText) {
  const table = objdumpText.split('[Ordinal/Name Pointer] Table')[1]?.split(/\n\s*\n/)[0] ?? '';
  return [...table.matchAll(/^\s*\[\s*\d+\]\s+(?:\+base\[\s*\d+\]\s+(?:[0-9a-f]+\s+)?)?(\S+)$/gm)].map(([, name]) => name).sort();
}

/** One test: that DLL exports the header's functions and Unity's entry only. Names what is missing and what is too much. */
export async function judgeExportsOfDll(dll) {
  const { exitCode, output } = await run('x86_64-w64-mingw32-objdump', ['-p', dll], { quiet: true });
  const declared = declaredNames(readFileSync(inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h'), 'utf8'));
  const exported = exitCode === 0 ? exportedNames(output) : [];
  const missing = declared.filter((name) => !exported.includes(name));
  const unwanted = exported.filter((name) => !declared.includes(name));
  const isRight = missing.length + unwanted.length === 0;
  if (!isRight) console.error(`test: ${dll}: missing exports: ${missing.join(', ') || 'none'}; unwanted: ${unwanted.join(', ') || 'none'}`);
  return { passed: isRight ? 1 : 0, failed: isRight ? 0 : 1, skipped: 0 };
}
