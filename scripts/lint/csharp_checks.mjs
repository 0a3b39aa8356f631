import { dotnetEnvironment, findDotnet } from '../lib/setup.mjs';
import { inRepository, run } from '../lib/process.mjs';
import { endingIn } from './files.mjs';

const folders = ['Assets/', 'Packages/', 'Samples~/', 'Tests/'];

/** Every C# file has the white space of .editorconfig, by .NET's own formatter, which needs no project for that. */
export async function checkCSharpFormat(files) {
  const sources = endingIn(files, '.cs');
  const dotnet = findDotnet();
  if (dotnet === null) return { checked: 0, complaints: [], warnings: ['the .NET SDK 10 is missing: the format of C# was not checked'] };
  const words = ['format', 'whitespace', '.', '--folder', '--verify-no-changes', '--include', ...folders];
  const { exitCode, output } = await run(dotnet, words, { quiet: true, cwd: inRepository(), env: dotnetEnvironment(dotnet) });
  if (exitCode === 0) return { checked: sources.length, complaints: [] };
  const complaints = output.split('\n').filter((line) => /\.cs\(\d+,\d+\)/.test(line));
  const remedy = `mend it with: dotnet format whitespace . --folder --include ${folders.join(' ')}`;
  return { checked: sources.length, complaints: complaints.length > 0 ? [...complaints, remedy] : [`dotnet format ended with ${exitCode}: ${output.trim()}`] };
}
