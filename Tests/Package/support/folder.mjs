import { mkdtempSync, realpathSync, rmSync } from 'node:fs';
import os from 'node:os';
import path from 'node:path';

/** Calls a function with a temporary folder outside the repository, which is gone afterwards; a promise is waited for. */
export function inFolder(act) {
  const folder = realpathSync(mkdtempSync(path.join(os.tmpdir(), 'haptoflow-')));
  const remove = () => rmSync(folder, { recursive: true, force: true });
  let found;
  try {
    found = act(folder);
  } catch (error) {
    remove();
    throw error;
  }
  if (found instanceof Promise) return found.finally(remove);
  remove();
  return found;
}
