import { readFileSync } from 'node:fs';
import koffi from 'koffi';
import { inRepository } from './process.mjs';

/** The header of the library's C interface. */
export const headerFile = inRepository('NativePlugin', 'include', 'haptoflow', 'haptoflow.h');

const numbers = /** @type {Record<string, string>} */ ({
  int32_t: 'int32', uint32_t: 'uint32', int64_t: 'int64', uint64_t: 'uint64', float: 'float', double: 'double',
});

/** What haptoflow.h declares: structs with their fields, and functions. Layouts are read from it, so that they stand in one place. */
export function readHeader(text = readFileSync(headerFile, 'utf8')) {
  const code = text.replaceAll(/\/\*[\s\S]*?\*\//g, '');
  const constants = Object.fromEntries([...code.matchAll(/^#define (\w+) (\d+)$/gm)].map(([, name, number]) => [name, Number(number)]));
  const aliases = Object.fromEntries([...code.matchAll(/^typedef (u?int\d+_t) (\w+);/gm)].map(([, type, name]) => [name, type]));
  const structs = [...code.matchAll(/^typedef struct (\w+) \{([^}]*)\} \1;/gm)].map(([, name, body]) => ({ name, fields: fieldsOf(body, constants) }));
  const functions = [...code.matchAll(/^HAPTOFLOW_API (?<returned>[^(;]*?)(?<name>haptoflow_\w+)\((?<list>[^)]*)\);/gm)]
    .map(({ groups }) => ({ name: groups?.name ?? '', returned: groups?.returned.trim() ?? '', parameters: parametersOf(groups?.list ?? '') }));
  return { aliases, structs, functions };
}

function fieldsOf(/** @type {string} */ body, /** @type {Record<string, number>} */ constants) {
  return body.split(';').map((line) => line.trim().replaceAll(/\s+/g, ' ')).filter((line) => line !== '').map((line) => {
    const [, type, name, length] = /** @type {RegExpExecArray} */ (/^(.*?[ *])(\w+)(?:\[(\w+)\])?$/.exec(line));
    return { type: type.trim(), name, length: length === undefined ? null : (constants[length] ?? Number(length)) };
  });
}

const parametersOf = (/** @type {string} */ list) => list.split(',').map((each) => each.trim().replaceAll(/\s+/g, ' '))
  .filter((each) => each !== '' && each !== 'void').map((each) => each.replace(/\b\w+$/, '').trim());

/**
 * Loads a native library of HaptoFlow by its C interface.
 * @param {string} file the library @param {ReturnType<typeof readHeader>} header
 * @returns {{functions: Record<string, Function>, sizeOf: (struct: string) => number, disagreeing: string[]}} functions by the names of
 *   the header, each without "haptoflow_": a pointer to a struct takes an object, a pointer to a handle an array of one; disagreeing:
 *   structs whose size in the library is not that of the header, so that no function may be called
 */
export function loadLibrary(file, header = readHeader()) {
  const { aliases, structs, functions } = header;
  const scalar = (/** @type {string} */ type) => numbers[aliases[type] ?? type];
  const layouts = /** @type {Record<string, import('koffi').TypeObject>} */ ({});
  for (const { name, fields } of structs) {
    layouts[name] = koffi.struct(Object.fromEntries(fields.map((field) => {
      const type = field.type === 'const char*' ? 'str' : (layouts[field.type] ?? scalar(field.type) ?? 'void*');
      return [field.name, field.length === null ? type : koffi.array(type, field.length)];
    })));
  }
  const typeOf = (/** @type {string} */ type) => {
    if (type === 'void') return 'void';
    if (type === 'const char*') return 'str';
    if (type.endsWith('**')) return koffi.inout(koffi.pointer('void*'));
    const [pointed] = /^\w+(?=\*$)|(?<=^const )\w+(?=\*$)/.exec(type) ?? [];
    if (pointed === undefined) return scalar(type);
    if (layouts[pointed]) return type.startsWith('const') ? koffi.pointer(layouts[pointed]) : koffi.inout(koffi.pointer(layouts[pointed]));
    if (scalar(pointed)) return koffi.inout(koffi.pointer(scalar(pointed)));
    return 'void*';
  };
  const library = koffi.load(file);
  const bound = functions.map(({ name, returned, parameters }) => [name.replace('haptoflow_', ''), library.func(name, typeOf(returned), parameters.map(typeOf))]);
  const callable = Object.fromEntries(bound);
  const sizeOf = (/** @type {string} */ struct) => koffi.sizeof(layouts[struct]);
  const disagreeing = structs.map(({ name }) => name).filter((name) => {
    const bytes = [0];
    return callable.struct_size(name, bytes) !== 0 || bytes[0] !== sizeOf(name);
  });
  return { functions: callable, sizeOf, disagreeing };
}
