// bench: measures callback, latencies, inference and memory into out/bench.json (--quick, --only, --publish)
import { spawn } from 'node:child_process';
import { existsSync, mkdirSync, readFileSync, statSync, writeFileSync } from 'node:fs';
import { modelLine, sha256Of, shippedModel, withMeasuredPart } from './lib/measured_part.mjs';
import { buildNative } from './lib/native_build.mjs';
import { CommandError, commandLinePath, inRepository, parsed, runMain, runOrFail } from './lib/process.mjs';
import { pythonOrFail, setUp, trainingEnvironment } from './lib/setup.mjs';

const report = inRepository('out', 'bench.json');
const paperModel = inRepository('out', 'bench', 'paper-architecture.haptoflow');
const documentPath = inRepository('Training', 'results', 'benchmarks.md');

const optionTable = {
  quick: { type: 'boolean', default: false },
  only: { type: 'string' },
  events: { type: 'string' },
  model: { type: 'string' },
  'no-paper': { type: 'boolean', default: false },
  publish: { type: 'boolean', default: false },
};

function optionsOf(words) {
  const { values } = parsed(words, optionTable);
  if (values.publish && (values.quick || values.only || values.events || values.model || values['no-paper'])) {
    throw new CommandError('--publish goes with a whole run of the shipped model: no other option beside it', 2);
  }
  return values;
}

/** Makes the model file of the paper's architecture where it is missing or older than its sources. */
async function makePaperModel() {
  const config = inRepository('Training', 'haptoflow_paper', 'configs', 'paper-codec-size.toml');
  const program = inRepository('Training', 'haptoflow_paper', 'rows', 'paper_model.py');
  const isNew = existsSync(paperModel) && [config, program].every((name) => statSync(name).mtimeMs <= statSync(paperModel).mtimeMs);
  if (isNew) return;
  await setUp(['python']);
  console.log('bench: making the paper\'s architecture with random weights, once');
  await runOrFail(pythonOrFail(), [program, config, paperModel], { env: trainingEnvironment(), quiet: true });
}

/** Runs the command line with its progress shown on this terminal; prints and returns its tables. */
function measure(args) {
  return new Promise((resolve, reject) => {
    const child = spawn(commandLinePath(), args, { stdio: ['ignore', 'pipe', 'inherit'] });
    const chunks = [];
    child.stdout.on('data', (chunk) => chunks.push(chunk));
    child.on('error', (error) => reject(new CommandError(`cannot start ${commandLinePath()}: ${error.message}`, 2)));
    child.on('close', (code) => {
      const tables = Buffer.concat(chunks).toString('utf8');
      process.stdout.write(tables);
      if (code === 0) resolve(tables);
      else reject(new CommandError(`\`haptoflow bench\` ended with ${code ?? 'a signal'}`, code ?? 1));
    });
  });
}

const help = `usage: ./run bench [--quick] [--only NAMES] [--events N] [--model FILE] [--no-paper] [--publish]

Measures callback, latencies, inference and memory into out/bench.json.

  --quick      fewer events and devices: a first look
  --only       some measurements: callback, effects, latency, inference, voices, idle
  --events     events behind each latency
  --model      another model file than the shipped one
  --no-paper   without the comparison with the paper's architecture
  --publish    a whole run of the shipped model, written into Training/results/benchmarks.md too`;

await runMain('bench', async (words) => {
  const options = optionsOf(words);
  await setUp(['build']);
  await buildNative({ targets: ['haptoflow_cli'] });
  mkdirSync(inRepository('out', 'bench'), { recursive: true });
  const comparesWithPaper = !options['no-paper'] && (options.only ?? 'inference').split(',').includes('inference');
  if (comparesWithPaper) await makePaperModel();
  const tables = await measure([
    'bench', '--output', report,
    ...(comparesWithPaper ? ['--paper-model', paperModel] : []),
    ...(options.quick ? ['--quick'] : []),
    ...['only', 'events', 'model'].flatMap((name) => (options[name] === undefined ? [] : [`--${name}`, options[name]])),
  ]);
  const modelSha256 = sha256Of(options.model ?? shippedModel);
  const measured = JSON.parse(readFileSync(report, 'utf8'));
  measured.model.sha256 = modelSha256;
  writeFileSync(report, `${JSON.stringify(measured, null, 2)}\n`);
  console.log(`\nbench: ${report}`);
  if (options.publish) {
    const text = `${modelLine(modelSha256)}\n\n\`\`\`\n${tables.trim()}\n\`\`\``;
    writeFileSync(documentPath, withMeasuredPart(readFileSync(documentPath, 'utf8'), 'npm run bench -- --publish', text));
    console.log(`bench: ${documentPath}`);
  }
}, { help });
