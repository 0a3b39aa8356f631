import { readFileSync } from 'node:fs';
import { namesExportedByElf } from '../pack/elf.mjs';
import { namesExportedByPe } from '../pack/pe.mjs';
import { inRepository } from './repository.mjs';

/** The entry point that Unity looks up by name; Unity's plugin SDK declares it, not haptoflow.h. */
const unitysEntry = 'UnityGetAudioEffectDefinitions';

const header = () => readFileSync(inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h'), 'utf8');

/** The names that the library must export, from the text of haptoflow.h. Tests/Native/capi/exports_test.cpp checks the same of an ELF. */
export function declaredNames(headerText = header()) {
  return [...headerText.matchAll(/^HAPTOFLOW_API [^(;]*?(haptoflow_\w+)\(/gm)].map(([, name]) => name).concat(unitysEntry).sort();
}

/** The names that a library exports, by its bytes: an ELF's or a DLL's. */
export const exportedNames = (bytes) => (bytes.toString('latin1', 0, 2) === 'MZ' ? namesExportedByPe(bytes) : namesExportedByElf(bytes)).sort();

/** How the exported names of a library differ from those of the header. @returns {{missing: string[], unwanted: string[]}} */
export function differencesOfExports(bytes) {
  const [declared, exported] = [declaredNames(), exportedNames(bytes)];
  return { missing: declared.filter((name) => !exported.includes(name)), unwanted: exported.filter((name) => !declared.includes(name)) };
}

/** One test: a DLL exports exactly the functions of the header and Unity's entry. Missing and additional names are printed. */
export function judgeExportsOfDll(dll) {
  const { missing, unwanted } = differencesOfExports(readFileSync(dll));
  const isRight = missing.length + unwanted.length === 0;
  if (!isRight) console.error(`test: ${dll}: missing exports: ${missing.join(', ') || 'none'}; unwanted: ${unwanted.join(', ') || 'none'}`);
  return { passed: isRight ? 1 : 0, failed: isRight ? 0 : 1, skipped: 0 };
}
