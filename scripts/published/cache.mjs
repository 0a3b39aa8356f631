// Where downloaded files lie: outside the repository, so that every clone uses them and none carries them.
import os from 'node:os';
import path from 'node:path';

/** The folder of HaptoFlow's downloads. */
export function cacheRoot(env = process.env, platform = process.platform) {
  if (env.XDG_CACHE_HOME) return path.resolve(env.XDG_CACHE_HOME, 'haptoflow');
  if (platform === 'win32') return path.resolve(env.LOCALAPPDATA ?? path.join(os.homedir(), 'AppData', 'Local'), 'haptoflow', 'cache');
  return path.resolve(env.HOME ?? os.homedir(), '.cache', 'haptoflow');
}

/**
 * The folder in which files of a repository have their paths. It is named by the revision that was asked for: where a branch
 * has moved on, files that did not change stay.
 */
export function repositoryFolder({ type, name }, revision, root = cacheRoot()) {
  return path.join(root, `${type}s`, ...name.split('/'), encodeURIComponent(revision));
}
