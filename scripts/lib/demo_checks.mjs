import { mkdirSync, writeFileSync } from 'node:fs';
import { inRepository } from './process.mjs';
import { closingLine } from './test_results.mjs';
import { runNodeTests } from './test_runners.mjs';

// Checks the files that `npm run demo` wrote to out/demo and writes the counts to out/test/demo-summary.json.
const counts = await runNodeTests([inRepository('Tests', 'Package', 'demo-outputs.check.mjs')]);
mkdirSync(inRepository('out', 'test'), { recursive: true });
writeFileSync(inRepository('out', 'test', 'demo-summary.json'), `${JSON.stringify(counts, null, 2)}\n`);
console.log(`demo outputs: ${closingLine(counts)}`);
process.exitCode = counts.failed > 0 ? 1 : 0;
