// Runs one ONNX graph in ONNX Runtime: `node run_graph.mjs GRAPH INPUTS.json`, where INPUTS.json has {name: {dims, data}};
// prints the same of the graph's outputs.
import { readFileSync } from 'node:fs';
import * as ort from 'onnxruntime-web';

ort.env.wasm.numThreads = 1;
const [graph, inputs] = process.argv.slice(2);
const session = await ort.InferenceSession.create(readFileSync(graph), { executionProviders: ['wasm'] });
const feeds = Object.entries(JSON.parse(readFileSync(inputs, 'utf8'))).map(([name, { dims, data }]) => [
  name,
  new ort.Tensor('float32', Float32Array.from(data), dims),
]);
const results = await session.run(Object.fromEntries(feeds));
const outputs = Object.entries(results).map(([name, { dims, data }]) => [name, { dims, data: Array.from(data) }]);
process.stdout.write(JSON.stringify(Object.fromEntries(outputs)));
