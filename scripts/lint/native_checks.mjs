import { areOfTheseSources, committedPlatforms, complaintsOfRecord, readRecord, renewal } from '../lib/libraries.mjs';

/** Says where the sources are newer than the libraries in git. No complaint: a comment must not put 4 MB more into git. */
export async function checkNatives(record = readRecord()) {
  const warnings = areOfTheseSources(record) ? [] : [`NativePlugin/natives.json: the libraries in git are older than the sources of the plugin; ${renewal} builds them anew`];
  return { checked: committedPlatforms.length, complaints: complaintsOfRecord(record), warnings };
}
