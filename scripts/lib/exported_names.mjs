import { readFileSync } from 'node:fs';
import { run } from './process.mjs';
import { inRepository } from './repository.mjs';

/** The entry point that Unity looks up by name; Unity's plugin SDK declares it, not haptoflow.h. */
const unitysEntry = 'UnityGetAudioEffectDefinitions';

/** The names that the library must export, from the text of haptoflow.h. Tests/Native/capi/exports_test.cpp checks the same of an ELF. */
export function declaredNames(headerText) {
  return [...headerText.matchAll(/^HAPTOFLOW_API [^(;]*?(haptoflow_\w+)\(/gm)].map(([, name]) => name).concat(unitysEntry).sort();
}

/** The exported names in the output of `objdump -p` for a DLL. */
export function exportedNames(objdumpText) {
  const table = objdumpText.split('[Ordinal/Name Pointer] Table')[1]?.split(/\n\s*\n/)[0] ?? '';
  return [...table.matchAll(/^\s*\[\s*\d+\]\s+(?:\+base\[\s*\d+\]\s+(?:[0-9a-f]+\s+)?)?(\S+)$/gm)].map(([, name]) => name).sort();
}

/** One test: a DLL exports exactly the functions of the header and Unity's entry. Missing and additional names are printed. */
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
