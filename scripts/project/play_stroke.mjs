import { readFileSync } from 'node:fs';
import { setTimeout } from 'node:timers/promises';
import koffi from 'koffi';
import { loadLibrary } from '../lib/c_interface.mjs';
import { CommandError } from '../lib/process.mjs';

const sampleRateHz = 48000;
const blockFrames = 256;
const stateRateHz = 72;
const fullScaleMps2 = 200;
const touching = { seconds: 2, speedMps: 0.1, forceNewtons: 1 };
const restSeconds = 0.3;

/**
 * Plays one stroke by the C interface, as a scene does: contact states at the rate of a headset, blocks of 256 frames at 48 kHz when they
 * are due, the network on the library's own worker.
 * @param {{library: string, runtime: string, model: string}} files
 * @returns {Promise<{version: string, label: string, levelMps2: number, peak: number, restPeak: number, inferences: number}>}
 *   level while the tip slides, RMS; peaks as shares of full scale, restPeak after the tip was lifted
 * @throws {CommandError} where the library is of another interface, or a call fails
 */
export async function playStroke({ library, runtime, model }) {
  const { functions: call, sizeOf, disagreeing } = loadLibrary(library);
  // With other layouts the calls below would read other fields than were written.
  if (disagreeing.length > 0) throw new CommandError(`${library}: is of another interface than haptoflow.h (${disagreeing.join(', ')}): \`npm run natives\` builds it anew`);
  const succeed = (/** @type {number} */ status) => {
    if (status !== 0) throw new CommandError(`${library}: ${call.status_name(status)}: ${call.last_message()}`);
  };
  const result = { version: String(call.version()), label: '', levelMps2: 0, peak: 0, restPeak: 0, inferences: 0 };
  const sized = (/** @type {string} */ name, fields = {}) => ({ struct_size: sizeOf(name), ...fields });
  // ONNX Runtime is loaded as Unity loads it: by its file, and its entry point is handed over.
  const ortApiBase = koffi.load(runtime).func('void* OrtGetApiBase()')();
  const [runtimeHandle, modelHandle, engine, voice] = [[null], [null], [null], [0]];
  succeed(call.runtime_open(sized('haptoflow_runtime_options', { ort_api_base: ortApiBase }), runtimeHandle));
  const bytes = readFileSync(model);
  succeed(call.model_open(sized('haptoflow_model_options', { bytes, byte_count: bytes.length }), modelHandle));
  const label = /** @type {{name: string}} */ (/** @type {unknown} */ (sized('haptoflow_label_info')));
  succeed(call.model_label(modelHandle[0], 0, label));
  result.label = label.name;
  succeed(call.engine_create(sized('haptoflow_engine_options', { runtime: runtimeHandle[0], model: modelHandle[0], full_scale_mps2: fullScaleMps2 }), engine));
  succeed(call.voice_create(engine[0], sampleRateHz, voice));

  const block = new Float32Array(blockFrames);
  let squares = 0;
  let slidingFrames = 0;
  const begin = performance.now();
  let blocks = 0;
  let states = 0;
  for (;;) {
    const seconds = (performance.now() - begin) / 1000;
    if (seconds >= touching.seconds + restSeconds) break;
    for (; states <= seconds * stateRateHz; states += 1) {
      const touches = states < touching.seconds * stateRateHz;
      succeed(call.voice_publish(voice[0], sized('haptoflow_contact_state', {
        touching: touches ? 1 : 0, touch_counter: 1, label_count: 1, labels: [0, 0, 0, 0], weights: [1, 0, 0, 0],
        velocity_mps: [touching.speedMps, 0], force_newtons: touching.forceNewtons,
      })));
    }
    for (; (blocks + 1) * blockFrames <= seconds * sampleRateHz; blocks += 1) {
      succeed(call.voice_render(voice[0], block, blockFrames, 1, 0, sampleRateHz));
      const at = (blocks * blockFrames) / sampleRateHz;
      const peak = block.reduce((most, sample) => Math.max(most, Math.abs(sample)), 0);
      if (at < touching.seconds) {
        result.peak = Math.max(result.peak, peak);
        squares += block.reduce((sum, sample) => sum + sample * sample, 0);
        slidingFrames += blockFrames;
      } else if (at > touching.seconds + restSeconds / 2) result.restPeak = Math.max(result.restPeak, peak);
    }
    await setTimeout(2);
  }
  const statistics = sized('haptoflow_voice_statistics');
  succeed(call.voice_get_statistics(voice[0], statistics));
  result.inferences = Number(statistics.inferences);
  result.levelMps2 = fullScaleMps2 * Math.sqrt(squares / slidingFrames);
  succeed(call.voice_destroy(voice));
  succeed(call.engine_close(engine));
  succeed(call.model_close(modelHandle));
  succeed(call.runtime_close(runtimeHandle));
  return result;
}
