// What the user names: a folder on the hub, or one on this disk.
import { CommandError } from '../lib/process.mjs';

export const defaultSpec = 'hf://tamago117/HaptoFlow/haptoflow_accel';

const form = 'expected hf://owner/repo/folder or hf://owner/repo/folder@revision, or a folder on this disk';
const namePattern = /^[\w][\w.-]*$/;

/**
 * @param {string} spec
 * @returns {{repo: import('./hub.mjs').Repository, folder: string, revision: string} | null} null for a folder on this disk;
 *   folder: '' for the repository's root
 * @throws CommandError where it begins as an address and is none
 */
export function parseSpec(spec) {
  if (!/^[a-z]+:\/\//i.test(spec)) return null;
  const wrong = (what) => new CommandError(`"${spec}": ${what}; ${form}`, 2);
  if (!spec.startsWith('hf://')) throw wrong(`only hf:// is read`);
  const [path, revision = 'main', ...more] = spec.slice('hf://'.length).split('@');
  if (more.length > 0) throw wrong('more than one @');
  const [owner, name, ...folders] = path.replace(/\/$/, '').split('/');
  if (!namePattern.test(owner ?? '') || !namePattern.test(name ?? '')) throw wrong('no owner and repository');
  if (folders.some((part) => part === '' || part === '.' || part === '..' || /[?#%\\]/.test(part))) throw wrong('no name of a folder');
  if (!/^[\w][\w./-]*$/.test(revision)) throw wrong(`"${revision}" is no revision`);
  return { repo: { type: 'model', name: `${owner}/${name}` }, folder: folders.join('/'), revision };
}
