import { HaptoFlowError } from './errors.mjs';
import { bytesOf } from './files.mjs';

// ONNX Runtime for the web behind the engine's seam (native/web_graph_session.cpp). The package's own interface returns
// promises, and a worker that waits for contact states in shared memory cannot wait for those; the functions of the module
// inside return numbers at once. They are not documented: the package's version is pinned, and `startRuntime` checks them.

/** The version whose inner functions this was written for. */
export const onnxRuntimeVersion = '1.30.0';

const float32 = 1;
const allOptimisations = 99;
const warnings = 2;
/** Layout of HaptoTensor in native/web_imports.hpp, in 32-bit words. */
const tensorWords = { name: 0, data: 1, count: 2, rank: 3, shape: 4, size: 10 };

/**
 * Loads ONNX Runtime.
 * @param {string} folder address with a final slash
 * @returns {Promise<Runtime>}
 * @throws HaptoFlowError "runtime-unreachable"
 */
export async function startRuntime(folder) {
  const remedy = `the folder must hold ort-wasm-simd-threaded.mjs and .wasm of onnxruntime-web ${onnxRuntimeVersion}, or \`onnxRuntime\` name the folder that does`;
  const [script, wasmBinary] = await Promise.all([
    importOf(new URL('ort-wasm-simd-threaded.mjs', folder), remedy),
    bytesOf(new URL('ort-wasm-simd-threaded.wasm', folder), { code: 'runtime-unreachable', remedy }),
  ]);
  return startRuntimeFrom(script, wasmBinary, remedy);
}

async function importOf(/** @type {URL} */ address, /** @type {string} */ remedy) {
  try {
    return await import(address.href);
  } catch (error) {
    throw new HaptoFlowError('runtime-unreachable', `${address}: cannot be imported (${/** @type {Error} */ (error).message}); ${remedy}`);
  }
}

/**
 * @param {{default: (options: object) => Promise<any>}} script
 * @param {Uint8Array} wasmBinary
 * @param {string} remedy
 */
export async function startRuntimeFrom(script, wasmBinary, remedy = `use onnxruntime-web ${onnxRuntimeVersion}`) {
  const inner = await script.default({ numThreads: 1, wasmBinary });
  const needed = ['_OrtInit', '_OrtCreateSessionOptions', '_OrtCreateSession', '_OrtReleaseSession', '_OrtGetInputOutputCount', '_OrtGetInputOutputMetadata', '_OrtCreateTensor', '_OrtGetTensorData', '_OrtReleaseTensor', '_OrtRun', '_OrtGetLastError', '_malloc', '_free', 'getValue', 'setValue', 'stackSave', 'stackRestore', 'stackAlloc', 'UTF8ToString', 'stringToUTF8', 'lengthBytesUTF8'];
  const lacking = needed.filter((name) => typeof inner[name] !== 'function');
  if (lacking.length > 0) throw new HaptoFlowError('runtime-unreachable', `ONNX Runtime lacks ${lacking.join(', ')}: ${remedy}`);
  const code = inner._OrtInit(1, warnings);
  if (code !== 0) throw new HaptoFlowError('runtime-unreachable', `ONNX Runtime does not start (${code}): ${remedy}`);
  return new Runtime(inner);
}

/** ONNX Runtime, and what the engine imports of it once `attach` has named the engine's memory. */
export class Runtime {
  #inner;
  /** @type {{session: number, names: Map<string, number>, inputCount: number, buffers: Map<number, {address: number, count: number}>}[]} */
  #graphs = [];
  #failure = '';
  /** @type {import('./module.mjs').Core | null} */
  #core = null;

  constructor(/** @type {any} */ inner) {
    this.#inner = inner;
  }

  /** @param {import('./module.mjs').Core} core */
  attach(core) {
    this.#core = core;
  }

  /** What `Core` takes as `runtime`. */
  get imports() {
    const core = () => /** @type {import('./module.mjs').Core} */ (this.#core);
    return {
      hapto_ort_load: (/** @type {number} */ bytes, /** @type {number} */ count) => this.#guarded(() => this.#load(core().u8.subarray(bytes, bytes + count))),
      hapto_ort_input_count: (/** @type {number} */ graph) => this.#graphs[graph].inputCount,
      hapto_ort_has_input: (/** @type {number} */ graph, /** @type {number} */ name) => (this.#graphs[graph].names.has(`in ${core().textAt(name)}`) ? 1 : 0),
      hapto_ort_has_output: (/** @type {number} */ graph, /** @type {number} */ name) => (this.#graphs[graph].names.has(`out ${core().textAt(name)}`) ? 1 : 0),
      hapto_ort_run: (/** @type {number} */ graph, /** @type {number} */ tensors, /** @type {number} */ count) => this.#guarded(() => this.#run(core(), this.#graphs[graph], tensors, count)),
      hapto_ort_release: (/** @type {number} */ graph) => this.#release(graph),
      hapto_ort_error: (/** @type {number} */ text, /** @type {number} */ capacity) => {
        const bytes = new TextEncoder().encode(this.#failure).subarray(0, capacity - 1);
        core().u8.set(bytes, text);
        core().u8[text + bytes.length] = 0;
      },
    };
  }

  /** Bytes of ONNX Runtime's own memory. */
  get memoryBytes() {
    return this.#inner.HEAPU8.length;
  }

  #guarded(/** @type {() => number} */ action) {
    try {
      return action();
    } catch (error) {
      this.#failure = /** @type {Error} */ (error).message;
      return -1;
    }
  }

  #lastError() {
    const inner = this.#inner;
    const stack = inner.stackSave();
    const found = inner.stackAlloc(8);
    inner._OrtGetLastError(found, found + 4);
    const text = inner.getValue(found + 4, '*');
    inner.stackRestore(stack);
    return text ? inner.UTF8ToString(text) : 'ONNX Runtime failed';
  }

  #text(/** @type {string} */ text) {
    const inner = this.#inner;
    const size = inner.lengthBytesUTF8(text) + 1;
    const address = inner._malloc(size);
    inner.stringToUTF8(text, address, size);
    return address;
  }

  #load(/** @type {Uint8Array} */ bytes) {
    const inner = this.#inner;
    const copy = inner._malloc(bytes.length);
    inner.HEAPU8.set(bytes, copy);
    const options = inner._OrtCreateSessionOptions(allOptimisations, true, true, 0, false, 0, this.#text('haptoflow'), warnings, 0, 0);
    const session = inner._OrtCreateSession(copy, bytes.length, options);
    inner._free(copy);
    inner._OrtReleaseSessionOptions?.(options);
    if (typeof session !== 'number') throw new Error('this ONNX Runtime loads by promises');
    if (session === 0) throw new Error(this.#lastError());
    const stack = inner.stackSave();
    const counts = inner.stackAlloc(8);
    inner._OrtGetInputOutputCount(session, counts, counts + 4);
    const inputCount = inner.getValue(counts, 'i32');
    const outputCount = inner.getValue(counts + 4, 'i32');
    const names = new Map();
    for (let index = 0; index < inputCount + outputCount; index += 1) {
      inner._OrtGetInputOutputMetadata(session, index, counts, counts + 4);
      const name = inner.getValue(counts, '*');
      names.set(`${index < inputCount ? 'in' : 'out'} ${inner.UTF8ToString(name)}`, name);
    }
    inner.stackRestore(stack);
    return this.#graphs.push({ session, names, inputCount, buffers: new Map() }) - 1;
  }

  #release(/** @type {number} */ index) {
    const graph = this.#graphs[index];
    if (!graph) return;
    for (const { address } of graph.buffers.values()) this.#inner._free(address);
    this.#inner._OrtReleaseSession(graph.session);
    // Handles are not reused.
    delete this.#graphs[index];
  }

  /** A buffer of ONNX Runtime's memory for the tensor at an address of the engine's, kept for the next run. */
  #buffer(/** @type {{buffers: Map<number, {address: number, count: number}>}} */ graph, /** @type {number} */ data, /** @type {number} */ count) {
    let buffer = graph.buffers.get(data);
    if (!buffer || buffer.count < count) {
      if (buffer) this.#inner._free(buffer.address);
      buffer = { address: this.#inner._malloc(4 * count), count };
      graph.buffers.set(data, buffer);
    }
    return buffer.address;
  }

  #run(/** @type {import('./module.mjs').Core} */ core, /** @type {any} */ graph, /** @type {number} */ tensors, /** @type {number} */ count) {
    const inner = this.#inner;
    const stack = inner.stackSave();
    const inputs = count - 1;
    const inNames = inner.stackAlloc(4 * inputs);
    const inTensors = inner.stackAlloc(4 * inputs);
    const outName = inner.stackAlloc(4);
    const outTensor = inner.stackAlloc(4);
    /** @type {number[]} */
    const made = [];
    const words = core.i32;
    const at = (/** @type {number} */ index) => (tensors >> 2) + tensorWords.size * index;
    const nameOf = (/** @type {number} */ word, /** @type {string} */ side) => graph.names.get(`${side} ${this.#nameText(core, words[word + tensorWords.name])}`);
    for (let index = 0; index < inputs; index += 1) {
      const word = at(index);
      const data = words[word + tensorWords.data];
      const numbers = words[word + tensorWords.count];
      const rank = words[word + tensorWords.rank];
      const copy = this.#buffer(graph, data, numbers);
      new Float32Array(inner.HEAPU8.buffer, copy, numbers).set(core.f32.subarray(data >> 2, (data >> 2) + numbers));
      const shape = inner.stackAlloc(4 * rank);
      for (let axis = 0; axis < rank; axis += 1) inner.setValue(shape + 4 * axis, words[word + tensorWords.shape + axis], 'i32');
      const tensor = inner._OrtCreateTensor(float32, copy, 4 * numbers, shape, rank, 1);
      if (tensor === 0) throw new Error(this.#lastError());
      made.push(tensor);
      inner.setValue(inNames + 4 * index, nameOf(word, 'in'), '*');
      inner.setValue(inTensors + 4 * index, tensor, '*');
    }
    const output = at(inputs);
    inner.setValue(outName, nameOf(output, 'out'), '*');
    inner.setValue(outTensor, 0, '*');
    const code = inner._OrtRun(graph.session, inNames, inTensors, inputs, outName, 1, outTensor, 0);
    made.forEach((tensor) => inner._OrtReleaseTensor(tensor));
    if (typeof code !== 'number') throw new Error('this ONNX Runtime runs by promises');
    if (code !== 0) {
      inner.stackRestore(stack);
      throw new Error(this.#lastError());
    }
    const result = inner.getValue(outTensor, '*');
    const found = inner.stackAlloc(16);
    inner._OrtGetTensorData(result, found, found + 4, found + 8, found + 12);
    const from = inner.getValue(found + 4, '*');
    const numbers = words[output + tensorWords.count];
    const to = words[output + tensorWords.data] >> 2;
    core.f32.set(new Float32Array(inner.HEAPU8.buffer, from, numbers), to);
    inner._OrtReleaseTensor(result);
    inner.stackRestore(stack);
    return 0;
  }

  /** Names of tensors stay at their addresses while their graph lives, and texts are slow to read. */
  #names = new Map();

  #nameText(/** @type {import('./module.mjs').Core} */ core, /** @type {number} */ address) {
    let text = this.#names.get(address);
    if (text === undefined || !this.#isStill(core, address, text)) {
      text = core.textAt(address);
      this.#names.set(address, text);
    }
    return text;
  }

  #isStill(/** @type {import('./module.mjs').Core} */ core, /** @type {number} */ address, /** @type {string} */ text) {
    const { u8 } = core;
    for (let index = 0; index < text.length; index += 1) if (u8[address + index] !== text.charCodeAt(index)) return false;
    return u8[address + text.length] === 0;
  }
}
