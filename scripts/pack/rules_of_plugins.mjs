import { loadAlignment } from './binaries.mjs';
import { kindOfLibrary, platforms, pluginsFolder } from './natives.mjs';

/** Devices with Android 15 and later may have pages of 16 KiB; they load no library whose segments are aligned to less. */
export const androidPageBytes = 16384;

/** The import settings with which Unity loads each platform's library on that platform only. */
const settings = {
  'Linux x86-64': { player: 'Linux64', editor: 'Linux' },
  'Windows x86-64': { player: 'Win64', editor: 'Windows' },
  // Unity's desktop players for Linux are x64 only; Embedded Linux has arm64.
  'Linux arm64': { player: 'EmbeddedLinux', cpu: 'ARM64' },
  'macOS arm64': { player: 'OSXUniversal', editor: 'OSX', cpu: 'ARM64' },
  'Android arm64': { player: 'Android', cpu: 'ARM64' },
};

/** [platform, enabled, settings text] of the .meta's platformData, in the form of Unity 2022.3. */
export function platformData(meta) {
  const pattern = /^ {2}- first:\n {6}([^\n]*?)\n {4}second:\n {6}enabled: ([01])\n {6}settings:([\s\S]*?)(?=^ {2}- first:|^ {2}\w)/gm;
  return [...meta.matchAll(pattern)].map(([, first, enabled, text]) => ({ name: first.split(': ').at(-1).trim(), isEnabled: enabled === '1', text }));
}

/** Each native library has the format of its folder's platform, is enabled for that platform only, and is loaded at start. */
export function checkPlugins(files) {
  const complaints = [];
  for (const name of files.endingIn('.so', '.dll', '.dylib')) {
    const platform = platforms.find(({ place }) => `${pluginsFolder}/${place}` === name);
    if (!platform) {
      complaints.push(`${name}: expected one of ${platforms.map(({ place }) => place).join(', ')} below ${pluginsFolder}`);
      continue;
    }
    const kind = kindOfLibrary(files.bytes(name));
    if (kind !== platform.kind) complaints.push(`${name}: is ${kind ?? 'no library'}; expected ${platform.kind}`);
    const alignment = kind === 'android-arm64' ? loadAlignment(files.bytes(name)) : androidPageBytes;
    if (alignment < androidPageBytes) complaints.push(`${name}: segments are aligned to ${alignment} bytes, expected ${androidPageBytes}: link with -z max-page-size=${androidPageBytes}`);
    if (files.has(`${name}.meta`)) complaints.push(...checkPluginMeta(`${name}.meta`, files.text(`${name}.meta`), settings[platform.name]));
  }
  return complaints;
}

function checkPluginMeta(name, meta, wanted) {
  const complaints = [];
  const enabled = platformData(meta).filter(({ isEnabled }) => isEnabled);
  const expected = [...(wanted.editor ? ['Editor'] : []), wanted.player].sort();
  const actual = enabled.map(({ name: platform }) => platform).sort();
  if (JSON.stringify(actual) !== JSON.stringify(expected)) {
    complaints.push(`${name}: enabled for ${actual.join(', ') || 'nothing'}; expected ${expected.join(', ')}`);
  }
  const editor = enabled.find((entry) => entry.name === 'Editor');
  if (editor && wanted.editor && !editor.text.includes(`OS: ${wanted.editor}\n`)) complaints.push(`${name}: expected the editor of OS ${wanted.editor}`);
  const player = enabled.find((entry) => entry.name === wanted.player);
  if (player && wanted.cpu && !player.text.includes(`CPU: ${wanted.cpu}\n`)) complaints.push(`${name}: expected CPU ${wanted.cpu}`);
  if (!/^ {2}isPreloaded: 1$/m.test(meta)) complaints.push(`${name}: expected isPreloaded: 1; Unity lists audio effects of libraries loaded at start`);
  return complaints;
}
