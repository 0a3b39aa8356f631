import { mkdirSync, readFileSync, rmSync, writeFileSync } from 'node:fs';
import { loadAlignment } from '../pack/elf.mjs';
import { androidPageBytes } from '../pack/rules/plugins.mjs';
import { CommandError, runOrFail } from './process.mjs';
import { inRepository } from './repository.mjs';

/** The linker options for the page size in a link command. */
export const pageOptions = (command) => [...command.matchAll(/-Wl,-z,max-page-size=\S+/g)].map(([option]) => option);

/**
 * One test: CMake links the Android library with segments that a device with pages of 16 KiB loads. Without an NDK, the
 * project is configured for a stand-in of Android, and a small library is linked with the link options of that build.
 */
export async function judgeAndroidPages() {
  const folder = inRepository('build', 'android-stand-in');
  try {
    rmSync(folder, { recursive: true, force: true });
    mkdirSync(folder, { recursive: true });
    const toolchain = inRepository('Tests', 'Platforms', 'android-stand-in.cmake');
    const words = ['-S', inRepository(), '-B', folder, '-G', 'Ninja', `-DCMAKE_TOOLCHAIN_FILE=${toolchain}`, '-DHAPTOFLOW_BUILD_TESTS=OFF', '-DHAPTOFLOW_BUILD_CLI=OFF'];
    await runOrFail('cmake', words, { quiet: true });
    const commands = await runOrFail('ninja', ['-C', folder, '-t', 'commands', 'audioplugin_haptoflow'], { quiet: true });
    const link = commands.split('\n').find((line) => line.includes('-shared') && line.includes('libaudioplugin_haptoflow.so')) ?? '';
    const [source, library] = ['page.c', 'page.so'].map((name) => `${folder}/${name}`);
    writeFileSync(source, 'int page = 1;\n');
    await runOrFail('aarch64-linux-gnu-gcc', ['-shared', '-fPIC', source, '-o', library, ...pageOptions(link)], { quiet: true });
    const alignment = loadAlignment(readFileSync(library));
    if (alignment === androidPageBytes) return { passed: 1, failed: 0, skipped: 0 };
    console.error(`test: the segments of the Android library are aligned to ${alignment} bytes; expected ${androidPageBytes}`);
  } catch (error) {
    if (!(error instanceof CommandError)) throw error;
    console.error(`test: ${error.message}`);
  }
  return { passed: 0, failed: 1, skipped: 0 };
}
