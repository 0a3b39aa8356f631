import { mkdirSync } from 'node:fs';
import { committedPlatforms, fileInPackage } from '../natives/committed.mjs';
import { runtimeLibrary } from '../pack/dependency.mjs';
import { shippedModel } from './model_stamp.mjs';
import { runOrFail } from './process.mjs';
import { inRepository } from './repository.mjs';
import { countsOfAttempt } from './test_counts.mjs';

/** The C compiler for each platform, and its ONNX Runtime. */
const ways = {
  'windows-x64': { compiler: 'x86_64-w64-mingw32-gcc', runtime: runtimeLibrary('windows-x64') },
  'linux-arm64': { compiler: 'aarch64-linux-gnu-gcc', runtime: inRepository('Tests', 'Platforms', 'node_modules', 'onnxruntime-node', 'bin', 'napi-v6', 'linux', 'arm64', 'libonnxruntime.so.1') },
};

/**
 * One test: a program for a platform opens the library in git by its file, as Unity does, and renders a stroke with the shipped
 * model, ONNX Runtime and the worker's thread.
 * @param {string} id of the platform @param {{command: string, args: string[], env: Record<string, string>, suffix: string}} emulator
 */
export function judgeCommittedTouch(id, { command, args, env, suffix }) {
  const { compiler, runtime } = ways[id];
  const folder = inRepository('build', 'touch', id);
  mkdirSync(folder, { recursive: true });
  const program = `${folder}/touch${suffix}`;
  return countsOfAttempt(async () => {
    await runOrFail(compiler, ['-std=c11', '-Wall', '-Wextra', '-Werror', `-I${inRepository('NativePlugin', 'include')}`, inRepository('Tests', 'Platforms', 'touch.c'), '-lm', '-o', program], { quiet: true });
    const library = fileInPackage(committedPlatforms.find((platform) => platform.id === id));
    const output = await runOrFail(command, [...args, program, library, runtime, shippedModel], { env, quiet: true, limitSeconds: 120 });
    // wine adds lines of its own.
    console.log(`test: ${output.split('\n').find((line) => line.includes('of full scale'))}`);
  });
}
