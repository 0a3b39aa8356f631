import path from 'node:path';
import { fileURLToPath } from 'node:url';

/** Absolute path of the repository's root folder. */
export const repositoryRoot = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..', '..');

/** Absolute path of something in the repository. */
export const inRepository = (...parts) => path.join(repositoryRoot, ...parts);

/** Where the command line program lies after a release build. */
export const commandLinePath = () => inRepository('build', 'native', process.platform === 'win32' ? 'haptoflow.exe' : 'haptoflow');

/** Where the person stands who ran npm or ./run: paths in arguments are relative to it. npm runs its scripts elsewhere. */
export const standingIn = () => path.resolve(process.env.INIT_CWD || process.cwd());
