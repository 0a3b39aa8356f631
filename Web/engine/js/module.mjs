import { HaptoFlowError } from './errors.mjs';

// The one WebAssembly module, instantiated by every thread that uses it. Runs in pages, workers, Node and in audio
// worklets, which have neither performance nor TextDecoder.

const pageBytes = 65536;
const initialPages = 1024;
/** As the module declares it. */
const largestPages = 16384;
const usualPages = 4096;
const stackBytes = 262144;
/** What hapto_thread_create puts below a stack. */
const threadBytes = 512;
const textStatus = { failure: -1 };
const enosys = -52;

/** Milliseconds since 1970, alike in all threads. */
const now = globalThis.performance?.timeOrigin ? () => performance.timeOrigin + performance.now() : Date.now;

/**
 * Memory for an engine. It can be shared between threads wherever the page may do so; it exists everywhere.
 * @param {{isLarge?: boolean}} [options] large: for learning
 */
export function createMemory({ isLarge = false } = {}) {
  return new WebAssembly.Memory({ initial: initialPages, maximum: isLarge ? largestPages : usualPages, shared: true });
}

/**
 * @typedef {object} ThreadBlock a thread's own memory, made by `Core.createThread` of another
 * @property {number} address
 */

/**
 * @typedef {object} InstanceOptions
 * @property {WebAssembly.Memory} memory
 * @property {ThreadBlock} [thread] for all instances in one memory but the first
 * @property {boolean} [mayWait] false for a page and for an audio thread
 * @property {boolean} [isPage]
 * @property {Record<string, Function>} [runtime] what runs graphs: see runtime.mjs
 * @property {(share: number, doing: string) => void} [onProgress]
 * @property {Float64Array} [clock] its first number is the time in milliseconds, for a thread on which a clock's new numbers
 *   would be garbage
 */

/** An instance of the module on this thread, with its memory. */
export class Core {
  /**
   * @param {WebAssembly.Module} module
   * @param {InstanceOptions} options
   */
  constructor(module, { memory, thread, mayWait = false, isPage = false, runtime = {}, onProgress, clock }) {
    this.memory = memory;
    this.clock = clock;
    this.views = { buffer: /** @type {ArrayBufferLike | null} */ (null), u8: new Uint8Array(), i32: new Int32Array(), f32: new Float32Array(), f64: new Float64Array() };
    const own = {
      memory,
      emscripten_get_now: clock ? () => clock[0] : now,
      clock_gettime: (/** @type {number} */ clock, /** @type {number} */ at) => this.#writeTime(at),
      emscripten_memcpy_big: (/** @type {number} */ to, /** @type {number} */ from, /** @type {number} */ count) => void this.u8.copyWithin(to, from, from + count),
      emscripten_resize_heap: (/** @type {number} */ bytes) => this.#grow(bytes),
      __emscripten_init_main_thread_js: (/** @type {number} */ block) => this.#enter(block, mayWait, isPage),
      abort: () => {
        throw new HaptoFlowError('INTERNAL_ERROR', 'the engine aborted');
      },
      hapto_progress: (/** @type {number} */ share, /** @type {number} */ doing) => onProgress?.(share, this.textAt(doing)),
    };
    /** @type {Record<string, Record<string, any>>} */
    const imports = {};
    for (const { module: from, name, kind } of WebAssembly.Module.imports(module)) {
      imports[from] ??= {};
      const found = /** @type {Record<string, unknown>} */ (own)[name] ?? runtime[name];
      // System calls that no browser has: files, processes, signals.
      imports[from][name] = found ?? (kind === 'function' ? () => (from === 'env' && !name.startsWith('__syscall') ? 0 : enosys) : undefined);
    }
    const { exports } = new WebAssembly.Instance(module, imports);
    /** @type {Record<string, any>} */
    this.exports = exports;
    if (thread === undefined) {
      this.exports.__wasm_call_ctors();
    } else {
      const { address } = thread;
      this.exports.stackRestore(address + threadBytes + stackBytes);
      this.exports.emscripten_stack_set_limits?.(address + threadBytes + stackBytes, address + threadBytes);
      this.#enter(address, mayWait, isPage);
    }
  }

  #enter(/** @type {number} */ block, /** @type {boolean} */ mayWait, /** @type {boolean} */ isPage) {
    const { _emscripten_thread_init: begin, emscripten_tls_init: olderTls, _emscripten_tls_init: tls } = this.exports;
    begin?.(block, isPage ? 1 : 0, 0, mayWait ? 1 : 0, 0, 0);
    (tls ?? olderTls)?.();
  }

  #writeTime(/** @type {number} */ at) {
    const milliseconds = this.clock ? this.clock[0] : now();
    const seconds = Math.floor(milliseconds / 1000);
    this.i32[at >> 2] = seconds;
    this.i32[(at >> 2) + 1] = Math.round((milliseconds - seconds * 1000) * 1e6);
    return 0;
  }

  #grow(/** @type {number} */ bytes) {
    const missing = Math.ceil((bytes >>> 0) / pageBytes) - this.memory.buffer.byteLength / pageBytes;
    try {
      // A little more at once, since growing is slow.
      this.memory.grow(Math.max(missing, 0));
      return 1;
    } catch {
      return 0;
    }
  }

  /** The views of a memory that may have grown meanwhile, on any thread. */
  #fresh() {
    const { buffer } = this.memory;
    if (buffer !== this.views.buffer) {
      this.views = { buffer, u8: new Uint8Array(buffer), i32: new Int32Array(buffer), f32: new Float32Array(buffer), f64: new Float64Array(buffer) };
    }
    return this.views;
  }

  get u8() { return this.#fresh().u8; }
  get i32() { return this.#fresh().i32; }
  get f32() { return this.#fresh().f32; }
  get f64() { return this.#fresh().f64; }

  /** Memory for another thread that instantiates the module; this one must be able to wait. */
  createThread() {
    const address = this.exports.hapto_thread_create(stackBytes);
    if (address === 0) throw new HaptoFlowError('OUT_OF_MEMORY', 'out of memory');
    return { address };
  }

  /** @param {number} bytes */
  allocate(bytes) {
    const address = this.exports.malloc(bytes);
    if (address === 0) throw new HaptoFlowError('OUT_OF_MEMORY', 'out of memory');
    return address;
  }

  /** @param {number} address */
  free(address) {
    this.exports.free(address);
  }

  /** A copy of bytes in the engine's memory, to be freed. @param {Uint8Array} bytes */
  copyIn(bytes) {
    const address = this.allocate(Math.max(1, bytes.length));
    this.u8.set(bytes, address);
    return address;
  }

  /** The text at an address, "" at zero. @param {number} address */
  textAt(address) {
    if (address === 0) return '';
    const { u8 } = this;
    let end = address;
    while (u8[end] !== 0) end += 1;
    // A decoder refuses shared memory.
    return new TextDecoder().decode(u8.slice(address, end));
  }

  #error() {
    return new HaptoFlowError(this.textAt(this.exports.hapto_error_code()), this.textAt(this.exports.hapto_error_message()));
  }

  /**
   * Calls a function that returns an index or 0.
   * @param {string} name
   * @param {...(number | string)} values a text is copied in for the call, with a final zero byte
   * @returns {number}
   */
  call(name, ...values) {
    const result = this.#with(values, (numbers) => this.exports[name](...numbers));
    if (result === textStatus.failure) throw this.#error();
    return result;
  }

  /**
   * Calls a function that returns a text.
   * @param {string} name
   * @param {...(number | string)} values
   */
  text(name, ...values) {
    return this.#with(values, (numbers) => {
      const address = this.exports[name](...numbers);
      if (address === 0) throw this.#error();
      return this.textAt(address);
    });
  }

  /**
   * Calls a function that returns JSON.
   * @param {string} name
   * @param {...(number | string)} values
   */
  json(name, ...values) {
    return JSON.parse(this.text(name, ...values));
  }

  #with(/** @type {(number | string)[]} */ values, /** @type {(numbers: number[]) => any} */ action) {
    /** @type {number[]} */
    const texts = [];
    try {
      return action(values.map((value) => {
        if (typeof value === 'number') return value;
        texts.push(this.copyIn(new TextEncoder().encode(`${value}\0`)));
        return /** @type {number} */ (texts.at(-1));
      }));
    } finally {
      texts.forEach((address) => this.free(address));
    }
  }
}
