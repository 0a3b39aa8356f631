// build: builds the native plugin and the command line (--platform NAME for one of the package's platforms, --help)
import path from 'node:path';
import { androidTools, buildAndroid } from './lib/android.mjs';
import { buildNative, presetFolder } from './lib/native_build.mjs';
import { CommandError, inRepository, parsed, runMain } from './lib/process.mjs';
import { onDebian, setUp } from './lib/setup.mjs';
import { putIntoPackage } from './lib/libraries.mjs';
import { platforms as packaged } from './pack/natives.mjs';

/** The values of --platform: what each needs, and how it is built (a preset, or the Android tools found on the machine). */
const platforms = {
  'linux-x64': { preset: () => 'release', purposes: ['build'], needs: 'a Linux x64 machine' },
  'linux-arm64': { preset: () => (process.arch === 'arm64' ? 'release' : 'linux-arm64'), purposes: ['build', 'cross'], needs: 'Linux' },
  'windows-x64': { preset: () => (process.platform === 'win32' ? 'windows-msvc' : 'windows-x64'), purposes: ['build', 'cross'], needs: 'mingw-w64 on Linux, Visual Studio 2022 on Windows' },
  macos: { preset: () => 'macos', purposes: ['build'], needs: 'a Mac' },
  'android-arm64': { needs: 'the Android NDK and CMake: those that Unity\'s Hub installs, ANDROID_NDK_ROOT, or Android Studio\'s' },
};

const notInGit = packaged.filter(({ isInGit }) => !isInGit).map(({ id }) => id);
const placeOf = (platform) => packaged.find(({ id }) => id === platform).place;

const help = `usage: npm run build -- [--platform NAME] [--help]

Without --platform: the plugin and the command line for this machine, in build/native. With it: the plugin alone, in the
folder below build/ from which \`npm run pack\` takes it. The libraries of ${notInGit.join(' and ')} also go into the
package, with their .meta, so that Unity finds them when it opens this folder; git ignores them there. The package has the
others from git, which \`npm run natives\` renews.

${Object.entries(platforms).map(([name, { needs }]) => `  ${name.padEnd(14)} needs ${needs}`).join('\n')}`;

/** On Debian set-up installs the build tools; on other systems those of the Android SDK are enough. */
async function buildForAndroid() {
  await setUp(onDebian() ? ['build'] : []);
  showBuilt('android-arm64', await buildAndroid(androidTools()));
}

/** A library that is not in git goes into the package of this project. */
function showBuilt(id, library) {
  console.log(`build: ${path.relative(inRepository(), library)}; \`npm run pack\` takes it in`);
  console.log(`build: ${putIntoPackage(placeOf(id), library)}, with its .meta: Unity finds it there when it opens this folder`);
}

await runMain('build', async (words) => {
  const { platform } = parsed(words, { platform: { type: 'string' } }).values;
  if (platform === undefined) {
    await setUp(['build']);
    await buildNative();
    return 0;
  }
  if (!Object.hasOwn(platforms, platform)) {
    throw new CommandError(`--platform: no platform "${platform}"; there are ${Object.keys(platforms).join(', ')}`, 2);
  }
  if (platform === 'android-arm64') {
    await buildForAndroid();
    return 0;
  }
  await setUp(platforms[platform].purposes);
  const preset = platforms[platform].preset();
  await buildNative({ preset, targets: ['audioplugin_haptoflow'] });
  if (notInGit.includes(platform)) showBuilt(platform, inRepository(presetFolder(preset), path.basename(placeOf(platform))));
  return 0;
}, { help });
