import { readFileSync } from 'node:fs';
import { inRepository } from '../lib/process.mjs';
import { endingIn } from './files.mjs';

const read = (name) => readFileSync(inRepository(name), 'utf8');

// Some of these are broken on purpose.
const brokenFiles = 'Tests/Golden/recordings/files/';

/** Every JSON file parses. */
export async function checkJson(files) {
  const sources = endingIn(files, '.json', '.asmdef').filter((name) => !name.startsWith(brokenFiles));
  const complaints = [];
  for (const name of sources) {
    try {
      JSON.parse(read(name));
    } catch (error) {
      complaints.push(`${name}: ${error.message}`);
    }
  }
  return { checked: sources.length, complaints };
}

const publicHeader = 'NativePlugin/include/haptoflow/haptoflow.h';

/** Functions of a C header without a comment directly before them that has a thread tag, such as [any-thread]. */
export function functionsWithoutThreadTag(header) {
  const untagged = [];
  for (const declaration of header.matchAll(/^HAPTOFLOW_API\b[^;(]*?\b(haptoflow_\w+)\s*\(/gm)) {
    const before = header.slice(0, declaration.index).trimEnd();
    const comment = before.endsWith('*/') ? before.slice(before.lastIndexOf('/*')) : '';
    if (!/\[(?:(?:any|loader|worker)-thread|publisher|audio-callback)\]/.test(comment)) untagged.push(declaration[1]);
  }
  return untagged;
}

/** Every function of the C ABI says which thread may call it. */
export async function checkThreadTags(files) {
  const headers = files.filter((name) => name === publicHeader);
  const complaints = headers.flatMap((name) =>
    functionsWithoutThreadTag(read(name)).map((declared) => `${name}: ${declared}: expected a thread tag such as [any-thread] in the comment before it`),
  );
  return { checked: headers.length, complaints };
}

const binary = /\.(haptoflow|png|wav|npz|bin|onnx|parquet|pt|so|dll)$/;

// Each is spelt in two parts, so that this file does not complain about itself.
const forbidden = [
  { what: 'a path of one machine', pattern: new RegExp('(^|["\'\\s(=:])/(wor' + 'k|hom' + 'e|roo' + 't|Use' + 'rs|tm' + 'p)/[\\w.]') },
  { what: 'a path of one machine', pattern: new RegExp('[A-Z]:\\\\\\\\?Use' + 'rs\\\\') },
  { what: 'a package host', pattern: new RegExp('registry\\.npm' + 'js|registry\\.yarn' + 'pkg|pypi\\.or' + 'g|files\\.python' + 'hosted|deb\\.debian\\.or' + 'g|nuget\\.or' + 'g/v3') },
];

/** Paths of one machine and package hosts in a text: "line: what". */
export function machineTraces(text) {
  return text.split('\n').flatMap((line, index) =>
    forbidden.filter(({ pattern }) => pattern.test(line)).map(({ what }) => `${index + 1}: ${what}: ${line.trim().slice(0, 80)}`),
  );
}

/** No file names one machine's paths or a package host. */
export async function checkContent(files) {
  const texts = files.filter((name) => !binary.test(name));
  return { checked: texts.length, complaints: texts.flatMap((name) => machineTraces(read(name)).map((trace) => `${name}:${trace}`)) };
}
