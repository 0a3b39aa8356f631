import path from 'node:path';
import { fileURLToPath } from 'node:url';

/** Absolute path of the repository's root folder. */
export const repositoryRoot = path.resolve(path.dirname(fileURLToPath(import.meta.url)), '..', '..');

/** Absolute path of something in the repository. */
export const inRepository = (...parts) => path.join(repositoryRoot, ...parts);

/** Absolute path of the command line program of a release build. */
export const commandLinePath = () => inRepository('build', 'native', process.platform === 'win32' ? 'haptoflow.exe' : 'haptoflow');

/** The folder in which npm or ./run was typed. Paths in arguments are relative to it, though npm runs scripts in the root. */
export const callerFolder = () => path.resolve(process.env.INIT_CWD || process.cwd());
