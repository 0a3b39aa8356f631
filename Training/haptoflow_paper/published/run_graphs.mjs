// Runs ONNX graphs in ONNX Runtime: `node run_graphs.mjs JOBS.json`, a list of {graph: FILE, inputs: {name: {dims, data}}};
// prints the first output of each as {dims, data}.
import { readFileSync } from 'node:fs';
import * as ort from 'onnxruntime-web';

ort.env.wasm.numThreads = 1;
const results = [];
for (const { graph, inputs } of JSON.parse(readFileSync(process.argv[2], 'utf8'))) {
  const session = await ort.InferenceSession.create(readFileSync(graph), { executionProviders: ['wasm'] });
  const feeds = Object.entries(inputs).map(([name, { dims, data }]) => [
    name,
    new ort.Tensor('float32', Float32Array.from(data), dims),
  ]);
  const { dims, data } = Object.values(await session.run(Object.fromEntries(feeds)))[0];
  results.push({ dims, data: Array.from(data) });
}
process.stdout.write(JSON.stringify(results));
