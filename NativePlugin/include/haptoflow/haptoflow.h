/*
 * HaptoFlow's C interface: the one public header of the library audioplugin_haptoflow.
 *
 * Conventions
 *
 * - Every function that can fail returns a haptoflow_status. Any of them may return HAPTOFLOW_INVALID_ARGUMENT; its
 *   comment names the other errors. After a status other than HAPTOFLOW_OK, haptoflow_last_message() describes the
 *   error, on the thread that made the call. A call that fails leaves its outputs unchanged, unless its comment says
 *   otherwise.
 * - Every descriptor begins with struct_size, which the caller sets to sizeof the struct before each call; any other
 *   size is refused.
 * - Before 1.0 no two versions are compatible. A caller that could meet a library of another version than this header
 *   compares haptoflow_version() with HAPTOFLOW_VERSION_TEXT; one that declares the structs itself, in another
 *   language, also compares its sizes with haptoflow_struct_size.
 * - Handles are opaque and never reused. A call with a closed handle, or with anything else that is not an open handle
 *   of that kind, returns HAPTOFLOW_INVALID_ARGUMENT. An open handle keeps alive the objects that it was created from.
 * - Text is UTF-8 and ends with a zero byte. Text that the library returns belongs to the library.
 * - Names carry their units: m/s^2 (mps2), m/s (mps), newtons, ms. Waveforms have 2000 samples per second.
 * - No C++ exception leaves the library.
 *
 * Thread tags, one on every function
 *
 * - [any-thread]: any thread, at any time, also concurrently with other calls. With a handle it blocks while another
 *   thread opens or closes one.
 * - [loader-thread]: any thread that can wait, because it reads files, allocates memory, or builds networks. Never call
 *   it from an audio callback; call it from a main thread only while the application loads.
 * - [worker-thread]: any thread that can wait for a network: it allocates inside ONNX Runtime and takes up to
 *   milliseconds. Never call it from an audio callback. Calls on one generator wait for each other.
 * - [publisher]: any thread that is not an audio callback; takes microseconds and never waits for other threads. Two
 *   threads must not publish on one voice at the same time: the second call is refused.
 * - [audio-callback]: for the audio callback, but allowed on any thread: takes microseconds, never allocates, locks,
 *   logs or makes a system call. Two threads must not render one voice at the same time: the second call is refused and
 *   gets silence.
 */
#ifndef HAPTOFLOW_H
#define HAPTOFLOW_H

#include <stddef.h>
#include <stdint.h>

#if defined(_WIN32)
#if defined(HAPTOFLOW_BUILDING_LIBRARY)
#define HAPTOFLOW_API __declspec(dllexport)
#else
#define HAPTOFLOW_API __declspec(dllimport)
#endif
#elif defined(__GNUC__)
#define HAPTOFLOW_API __attribute__((visibility("default")))
#else
#define HAPTOFLOW_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

/* The version of this header, which is that of package.json. haptoflow_version() returns that of the loaded library. */
#define HAPTOFLOW_VERSION_MAJOR 0
#define HAPTOFLOW_VERSION_MINOR 2
#define HAPTOFLOW_VERSION_PATCH 0
#define HAPTOFLOW_VERSION_TEXT "0.2.0"

/* Samples of a segment and of the previous waveform; lengths of a material embedding, a motion and the
 * phases of the surface's waves. */
#define HAPTOFLOW_SEGMENT_SAMPLES 200
#define HAPTOFLOW_EMBEDDING_SIZE 64
#define HAPTOFLOW_MOTION_SIZE 3
#define HAPTOFLOW_PHASES 6

/* The acceleration in m/s^2 that corresponds to +-1 in the output unless options set another one. */
#define HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2 200.0
#define HAPTOFLOW_MAXIMUM_BATCH 256

typedef int32_t haptoflow_status;
enum {
    HAPTOFLOW_OK = 0,
    /* A null pointer, a handle that is not open, an index or a number out of range, or an unknown name. */
    HAPTOFLOW_INVALID_ARGUMENT = 1,
    HAPTOFLOW_OUT_OF_MEMORY = 2,
    /* An error in this library itself. */
    HAPTOFLOW_INTERNAL_ERROR = 3,
    /* Another thread is publishing on this voice, or rendering it. */
    HAPTOFLOW_BUSY = 4,
    /* The model file cannot be opened or read. */
    HAPTOFLOW_MODEL_UNREADABLE = 10,
    /* The bytes are not a .haptoflow file. */
    HAPTOFLOW_NOT_A_MODEL = 11,
    HAPTOFLOW_MODEL_TRUNCATED = 12,
    /* The file's format is newer than this library: update HaptoFlow. */
    HAPTOFLOW_MODEL_TOO_NEW = 13,
    /* A length or count above the format's limits. */
    HAPTOFLOW_MODEL_OVERSIZED = 14,
    /* A checksum does not match: the file was modified or corrupted. */
    HAPTOFLOW_MODEL_DAMAGED = 15,
    /* The file is intact, but it or one of its graphs breaks a rule of the format. */
    HAPTOFLOW_MODEL_INCONSISTENT = 16,
    /* The material was learnt for a model with another embedding space. */
    HAPTOFLOW_MATERIAL_MISMATCH = 17,
    /* The text is not a valid material file; the message names the key. */
    HAPTOFLOW_MATERIAL_INVALID = 18,
    /* No material can be learnt from the recording; the message says why. */
    HAPTOFLOW_RECORDING_UNUSABLE = 19,
    /* There is no ONNX Runtime of version 1.16 or newer at the given path. */
    HAPTOFLOW_RUNTIME_UNAVAILABLE = 20,
    /* A graph failed while it ran, or returned numbers that are not finite. */
    HAPTOFLOW_INFERENCE_FAILED = 21,
    /* A load ended early because its haptoflow_cancellation was cancelled. */
    HAPTOFLOW_CANCELLED = 22,
    /* A trial run of a tier took longer than probe_limit_ms; the message names the tier. */
    HAPTOFLOW_TIER_TOO_SLOW = 23
};

typedef int32_t haptoflow_solver;
enum {
    /* The tier's own solver and number of steps. */
    HAPTOFLOW_SOLVER_OF_TIER = 0,
    HAPTOFLOW_SOLVER_EULER = 1,
    HAPTOFLOW_SOLVER_MIDPOINT = 2,
    HAPTOFLOW_SOLVER_HEUN = 3
};

/* ------------------------------------------------------------------------------------------------------ library */

/* Returns the library's version, for example "0.2.0". The text is valid as long as the process runs. Never fails.
 * [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_version(void);

/* Returns a status's name, for example "HAPTOFLOW_OK", or "HAPTOFLOW_UNKNOWN_STATUS" for any other number. The text
 * is valid as long as the process runs. Never fails. [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_status_name(haptoflow_status status);

/* Why a voice is silent. If several reasons apply, the one that lasts longest. */
typedef int32_t haptoflow_silence;
enum {
    /* The voice is not silent. */
    HAPTOFLOW_SILENCE_NONE = 0,
    /* The tip touches nothing, or it does not slide. */
    HAPTOFLOW_SILENCE_REST = 1,
    /* No contact state was published for 100 ms. */
    HAPTOFLOW_SILENCE_STALE = 2,
    HAPTOFLOW_SILENCE_MUTED = 3,
    HAPTOFLOW_SILENCE_PAUSED = 4,
    /* A panic silenced this touch; the next touch sounds. */
    HAPTOFLOW_SILENCE_PANIC = 5,
    /* The device changed to a sample rate that the worker is still preparing for, or to one outside 8 to 192 kHz. */
    HAPTOFLOW_SILENCE_RATE = 6,
    HAPTOFLOW_SILENCE_CLOSING = 7,
    /* The engine's worker thread has ended: haptoflow_engine_last_failure says why. */
    HAPTOFLOW_SILENCE_WORKER_DEAD = 8,
    /* The voice's strength or ceiling is 0. */
    HAPTOFLOW_SILENCE_TURNED_DOWN = 9
};

/* Returns the message of the last call on this thread that failed; "" if none has failed. The text is valid until
 * the next call on this thread fails or the thread ends. Never fails. [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_last_message(void);

/* ------------------------------------------------------------------------------------------------- ONNX Runtime */

typedef struct haptoflow_runtime haptoflow_runtime;

/* Exactly one of ort_api_base and library_path must be set. */
typedef struct haptoflow_runtime_options {
    uint32_t struct_size;
    /* The pointer that OrtGetApiBase() of a loaded ONNX Runtime returned (const OrtApiBase*). That library must stay
     * loaded. */
    const void* ort_api_base;
    /* Or the path of an ONNX Runtime library, which then stays loaded until the process ends. */
    const char* library_path;
} haptoflow_runtime_options;

/* Makes ONNX Runtime available; one runtime is enough for a process. Close it with haptoflow_runtime_close. Errors:
 * RUNTIME_UNAVAILABLE, OUT_OF_MEMORY. [loader-thread] Blocks on disk while the library loads. */
HAPTOFLOW_API haptoflow_status haptoflow_runtime_open(const haptoflow_runtime_options* options,
                                                      haptoflow_runtime** runtime);

/* Closes *runtime and sets it to null; a null handle is allowed. Generators and engines created with it stay usable.
 * [loader-thread] Blocks while ONNX Runtime frees its memory. */
HAPTOFLOW_API haptoflow_status haptoflow_runtime_close(haptoflow_runtime** runtime);

/* ------------------------------------------------------------------------------------------------- cancellations */

/* Cancels running loads: those whose options contain it. It can serve several loads, also one after the other. */
typedef struct haptoflow_cancellation haptoflow_cancellation;

/* Creates a cancellation. Close it with haptoflow_cancellation_close. Errors: OUT_OF_MEMORY. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_cancellation_create(haptoflow_cancellation** cancellation);

/* Ends all present and future loads with this cancellation with HAPTOFLOW_CANCELLED. A running load ends at its next
 * operator, graph or part of a table; ONNX Runtime before 1.22 first finishes the graph that it is loading.
 * [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_cancellation_cancel(haptoflow_cancellation* cancellation);

/* Closes *cancellation and sets it to null; a null handle is allowed. Running loads continue. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_cancellation_close(haptoflow_cancellation** cancellation);

/* ------------------------------------------------------------------------------------------------------- models */

typedef struct haptoflow_model haptoflow_model;

/* Set either bytes and byte_count, or path. */
typedef struct haptoflow_model_options {
    uint32_t struct_size;
    /* The bytes of a whole .haptoflow file. They are copied. */
    const void* bytes;
    uint64_t byte_count;
    const char* path;
} haptoflow_model_options;

/* What a model's header says about the whole model. */
typedef struct haptoflow_model_info {
    uint32_t struct_size;
    /* All texts are valid until the model is closed. */
    const char* name;
    const char* description;
    /* Provenance: how it was trained, its recordings, their licence, the commit of the training code, and a date as
     * YYYY-MM-DD or an empty text. */
    const char* statement;
    const char* recordings;
    const char* licence;
    const char* commit;
    const char* created;
    /* The range of speeds in m/s, and of forces in N, that the model was trained on: lowest, highest. */
    double speed_mps[2];
    double force_newtons[2];
} haptoflow_model_info;

typedef struct haptoflow_label_info {
    uint32_t struct_size;
    /* 1 for a woven or ruled surface, which has a wavelength; 0 otherwise. */
    uint32_t is_periodic;
    /* Valid until the model is closed; for a registered material, until it is replaced or the engine is closed. */
    const char* name;
    const char* category;
    double stiffness_newtons_per_metre;
    double friction_coefficient;
    /* 0 unless the label is periodic. */
    double wavelength_metres;
} haptoflow_label_info;

typedef struct haptoflow_tier_info {
    uint32_t struct_size;
    /* The tier's own number of steps, 1 to 16. */
    int32_t steps;
    /* All texts are valid until the model is closed. */
    const char* name;
    /* "flow", "average-velocity", "direct", "skeleton" or "refine". */
    const char* kind;
    /* Measured figures as JSON objects; "{}" if nothing was measured. */
    const char* accuracy_json;
    const char* cost_json;
    /* The tier's own solver. */
    haptoflow_solver solver;
    /* 1 for the tier that is used when no tier is named, 0 otherwise. */
    uint32_t is_default;
    /* Number of weights of the tier's velocity field. */
    int64_t parameter_count;
} haptoflow_tier_info;

/* Reads a model and verifies all of its bytes. Close it with haptoflow_model_close. Errors: MODEL_UNREADABLE,
 * NOT_A_MODEL, MODEL_TRUNCATED, MODEL_TOO_NEW, MODEL_OVERSIZED, MODEL_DAMAGED, MODEL_INCONSISTENT, OUT_OF_MEMORY.
 * [loader-thread] Blocks on disk if a path is given; takes milliseconds per megabyte. */
HAPTOFLOW_API haptoflow_status haptoflow_model_open(const haptoflow_model_options* options, haptoflow_model** model);

/* Closes *model and sets it to null; a null handle is allowed. Generators created from it stay usable; texts that it
 * returned do not. [loader-thread] Blocks while memory is freed. */
HAPTOFLOW_API haptoflow_status haptoflow_model_close(haptoflow_model** model);

/* Sets *header_json to the file's JSON header (Documentation~/model-format.md), valid until the model is closed.
 * [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_header(const haptoflow_model* model, const char** header_json);

/* Fills info for the whole model. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_describe(const haptoflow_model* model, haptoflow_model_info* info);

/* Sets *count to the number of labels. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_label_count(const haptoflow_model* model, uint32_t* count);

/* Fills info for the label at index, 0 to count - 1. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_label(const haptoflow_model* model, uint32_t index,
                                                     haptoflow_label_info* info);

/* Writes the material embedding of the label at index: HAPTOFLOW_EMBEDDING_SIZE numbers. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_embedding(const haptoflow_model* model, uint32_t index,
                                                         float* embedding);

/* Sets *index to the label whose embedding is nearest to this one, HAPTOFLOW_EMBEDDING_SIZE numbers. Wave vectors,
 * the last four of them, are not compared. [any-thread] Takes microseconds. */
HAPTOFLOW_API haptoflow_status haptoflow_model_nearest_label(const haptoflow_model* model, const float* embedding,
                                                             uint32_t* index);

/* Sets *space to 8 hexadecimal digits that identify the model's embedding space. A material file works with every
 * model of the same space (Documentation~/own-materials.md). The text is valid until the model is closed.
 * [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_space(const haptoflow_model* model, const char** space);

/* Sets *count to the number of tiers. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_tier_count(const haptoflow_model* model, uint32_t* count);

/* Fills info for the tier at index, 0 to count - 1; the most accurate tier is the last. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_model_tier(const haptoflow_model* model, uint32_t index,
                                                    haptoflow_tier_info* info);

/* ---------------------------------------------------------------------------------------------------- materials */

/* The contents of a material file (Documentation~/own-materials.md). */
typedef struct haptoflow_material haptoflow_material;

typedef struct haptoflow_material_info {
    uint32_t struct_size;
    /* All texts are valid until the material is closed. */
    const char* name;
    const char* category;
    const char* description;
    /* The space of the models that it can be used with: see haptoflow_model_space. */
    const char* space;
    /* Provenance: how it was made, its recordings, their licence, and a date as YYYY-MM-DD or an empty text. */
    const char* statement;
    const char* recordings;
    const char* licence;
    const char* created;
    /* Duration of the recordings; 0 if unknown. */
    double seconds;
    double stiffness_newtons_per_metre;
    /* The material is louder than its level model says by this many dB, at every speed and force. */
    double level_offset_db;
    /* The lowest and the highest speed and force of the recordings. */
    double speed_mps[2];
    double force_newtons[2];
} haptoflow_material_info;

/* Reads the text of a material file, length bytes, and verifies every value of it, as
 * haptoflow_engine_register_material does. Close it with haptoflow_material_close. Errors: MATERIAL_INVALID (the
 * message names the key), OUT_OF_MEMORY. [any-thread] Takes less than a millisecond. */
HAPTOFLOW_API haptoflow_status haptoflow_material_read(const char* json, uint64_t length,
                                                       haptoflow_material** material);

/* Closes *material and sets it to null; a null handle is allowed. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_material_close(haptoflow_material** material);

/* Fills info for the material. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_material_describe(const haptoflow_material* material,
                                                           haptoflow_material_info* info);

/* Writes the material's embedding: HAPTOFLOW_EMBEDDING_SIZE numbers. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_material_embedding(const haptoflow_material* material, float* embedding);

/* --------------------------------------------------------------------------------------------------- generators */

/* One tier of a model that generates segments outside of real time: for rendering, measurements and previews. */
typedef struct haptoflow_generator haptoflow_generator;

typedef struct haptoflow_generator_options {
    uint32_t struct_size;
    /* Requests that one run of a graph computes, up to HAPTOFLOW_MAXIMUM_BATCH; 0 for 8. Larger batches are split. */
    uint32_t maximum_batch;
    /* Null for a tier of kind "skeleton", which needs none. */
    const haptoflow_runtime* runtime;
    const haptoflow_model* model;
    /* Name of the tier; null for the model's default. */
    const char* tier;
    /* Cancels the creation; null for none. */
    const haptoflow_cancellation* cancellation;
    /* Time limit of a trial run of each graph, for each 8 requests of maximum_batch, above 0 to 3600000 ms; 0 for
     * 10000 ms. A run is not interrupted within an operator. */
    double probe_limit_ms;
} haptoflow_generator_options;

/* `count` requests; each array holds their values one request after the other. The arrays are read during the call
 * only. */
typedef struct haptoflow_batch {
    uint32_t struct_size;
    uint32_t count;
    /* count * HAPTOFLOW_EMBEDDING_SIZE numbers. */
    const float* embeddings;
    /* count * HAPTOFLOW_MOTION_SIZE numbers: vx and vy along the surface in m/s and the force in N, inside the trained
     * range. */
    const float* motions;
    /* count * HAPTOFLOW_SEGMENT_SAMPLES samples in m/s^2 that precede each segment. */
    const float* previous_mps2;
    /* count * HAPTOFLOW_SEGMENT_SAMPLES standard normal numbers. */
    const float* noise;
    /* count * HAPTOFLOW_PHASES numbers: for the ribs along each of the embedding's two wave vectors and for stick-slip,
     * the phase at the segment's first sample in cycles from 0 to below 1, then its signed rate in Hz for each; null
     * for phases of zero and the rates at which the motion crosses the wave vectors. Used by tiers of the kinds
     * "skeleton" and "refine", and by graphs that have the input "phases". */
    const float* phases;
    /* count levels above 0, RMS in m/s^2, that replace those of the level graph; null to use the level graph. */
    const float* own_levels_mps2;
    /* The solver's starting points of a tier whose representation is latent: for each request as many standard normal
     * numbers as the tier's latent_shape has; null to derive them from `noise`. INVALID_ARGUMENT for any other tier. */
    const float* latent_noise;
} haptoflow_batch;

/* Loads the tier's graphs into ONNX Runtime, checks them and runs them once. Close it with
 * haptoflow_generator_close. Errors: MODEL_INCONSISTENT if a graph breaks a rule of the format, TIER_TOO_SLOW,
 * CANCELLED, OUT_OF_MEMORY. [loader-thread] Blocks while ONNX Runtime optimises the graphs. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_create(const haptoflow_generator_options* options,
                                                          haptoflow_generator** generator);

/* Closes *generator and sets it to null; a null handle is allowed. A running call on another thread finishes.
 * [loader-thread] Blocks while memory is freed. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_close(haptoflow_generator** generator);

/* Sets the solver and the number of steps (1 to 16) from the next batch on; HAPTOFLOW_SOLVER_OF_TIER with 0 steps
 * restores the tier's own. Tiers of kind "average-velocity" always use Euler steps, and those of kind "direct" take
 * one evaluation. [worker-thread] Blocks while another thread uses this generator. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_set_solver(haptoflow_generator* generator, haptoflow_solver solver,
                                                              int32_t steps);

/* Writes count * HAPTOFLOW_SEGMENT_SAMPLES samples in m/s^2 into segments_mps2. If the call fails, the content of
 * segments_mps2 is unspecified: do not play it. Errors: INFERENCE_FAILED, OUT_OF_MEMORY. [worker-thread] Blocks
 * while another thread uses this generator and while the graphs run. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_generate(haptoflow_generator* generator,
                                                            const haptoflow_batch* batch, float* segments_mps2);

/* ------------------------------------------------------------------------------------------------------- engines */

/* All voices of one model, with one worker thread that generates for them. The thread sleeps while no tip slides. */
typedef struct haptoflow_engine haptoflow_engine;

typedef int32_t haptoflow_quality;
enum {
    /* Measures the model's tiers on this machine while nothing touches and uses the most accurate one (by the figures
     * in the model's header) that fits the budget. Changes to a faster tier when the machine cannot keep up, and to a
     * more accurate one when it can again. Needs a worker: an engine without one refuses it with INVALID_ARGUMENT. */
    HAPTOFLOW_QUALITY_AUTO = 0,
    /* The tier "draft", or the model's first tier if it has no such tier. */
    HAPTOFLOW_QUALITY_DRAFT = 1,
    /* The tier "standard", or the model's default tier if it has no such tier. */
    HAPTOFLOW_QUALITY_STANDARD = 2,
    /* The tier "sketch", which plays without a network, or the model's first tier if it has no such tier. */
    HAPTOFLOW_QUALITY_SKETCH = 4
};

typedef struct haptoflow_engine_options {
    uint32_t struct_size;
    haptoflow_quality quality;
    /* Null where there is no ONNX Runtime: then only tiers of kind "skeleton" can be used, and HAPTOFLOW_QUALITY_AUTO
     * uses the most accurate of those. */
    const haptoflow_runtime* runtime;
    const haptoflow_model* model;
    /* Contact states per second, 1 to 10000; 0 for 72. Determines the budget and how fast tiers are measured. */
    double update_rate_hz;
    /* Share of the time between two contact states that inference may use, above 0 to 1; 0 for 0.25. */
    double budget_share;
    /* The acceleration in m/s^2 that corresponds to +-1 in the output, 0.001 to 1000000; 0 for
     * HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2. The limiter's curve begins at 0.7 of it. */
    double full_scale_mps2;
    /* Seed of all noise. */
    uint64_t seed;
    /* Voices that one run of a graph computes, 1 to 64; 0 for 8. More voices take several runs. */
    uint32_t batch_voices;
    /* 1 for an engine without a worker thread: the caller calls haptoflow_engine_step and sets a fixed quality. 0
     * otherwise. */
    uint32_t without_worker;
    /* Lead: the time from a contact state to the first sample generated from it, above 0 to 50 ms; 0 for the shortest
     * that the engine can keep on this machine. With a fixed lead, an engine without worker is deterministic. */
    double fixed_lead_ms;
    /* Cancels the creation; null for none. Used by haptoflow_engine_create only. */
    const haptoflow_cancellation* cancellation;
    /* Time limit of a trial run of each graph, for each 8 voices of batch_voices, above 0 to 3600000 ms; 0 for 10000
     * ms. A run is not interrupted within an operator. */
    double probe_limit_ms;
} haptoflow_engine_options;

/* How long one voice's segment takes on this machine, by the tier at an index of the model (haptoflow_model_tier). */
typedef struct haptoflow_tier_times {
    uint32_t struct_size;
    /* 1 for the tier that generates at present, 0 otherwise. */
    uint32_t is_current;
    /* Number of runs that the figures are based on, the last 128 at most; 0 if the tier was neither used nor measured.
     */
    uint64_t runs;
    double median_ms;
    double percentile_99_ms;
} haptoflow_tier_times;

typedef struct haptoflow_engine_statistics {
    uint32_t struct_size;
    /* Index of the tier that generates at present. */
    uint32_t tier;
    uint32_t voices;
    /* 1 while automatic quality is still measuring, 0 otherwise. */
    uint32_t is_measuring;
    /* Rounds of inference, segments generated in them, and rounds in which a graph failed. */
    uint64_t rounds;
    uint64_t segments;
    uint64_t failed_rounds;
    /* How often the worker was woken. */
    uint64_t wakes;
    /* How often automatic quality changed to a faster, and to a more accurate tier. */
    uint64_t quality_steps_down;
    uint64_t quality_steps_up;
    /* The time that a round may take, and the time that the last one took, for all its voices together. */
    double budget_ms;
    double last_round_ms;
    /* 0 after the worker has ended, also while the engine is being closed; 1 otherwise, and without worker. */
    uint32_t worker_is_alive;
    /* 1 if the system refused to raise the worker's priority; 0 otherwise. */
    uint32_t priority_was_refused;
} haptoflow_engine_statistics;

/* Loads every tier of the model that the runtime can run and starts the worker. Close it with
 * haptoflow_engine_close. Errors: MODEL_INCONSISTENT, INFERENCE_FAILED, TIER_TOO_SLOW, CANCELLED, OUT_OF_MEMORY.
 * [loader-thread] Blocks while ONNX Runtime optimises the graphs and while the levels of all labels are computed. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_create(const haptoflow_engine_options* options,
                                                       haptoflow_engine** engine);

/* Ends the worker, destroys the engine's voices as haptoflow_voice_destroy does and sets *engine to null; a null
 * handle is allowed. [loader-thread] Blocks for the present round of inference. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_close(haptoflow_engine** engine);

/* Sets the quality from the next segment on. Errors: also for a tier that needs the ONNX Runtime that the engine was
 * created without; the quality then does not change. [any-thread] Takes microseconds. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_set_quality(haptoflow_engine* engine, haptoflow_quality quality);

/* Maximum number of materials that one engine holds besides its model's labels. */
#define HAPTOFLOW_MAXIMUM_MATERIALS 64

/* Registers a material: json is the text of a material file (Documentation~/own-materials.md), length its number of
 * bytes. From then on contact states may refer to it by *index, which is the number of the model's labels plus that
 * of the materials registered before. It stays until the engine is closed. The sound of all other labels is
 * unchanged. Errors: INVALID_ARGUMENT (also if HAPTOFLOW_MAXIMUM_MATERIALS are registered), MATERIAL_INVALID (the
 * message names the key), MATERIAL_MISMATCH, OUT_OF_MEMORY; MODEL_INCONSISTENT, INFERENCE_FAILED and TIER_TOO_SLOW
 * if the material has no level of its own and the model's level graph fails. [loader-thread] Publishers, worker and
 * callbacks never wait for it. Takes milliseconds; the first material without a level of its own also loads the
 * model's level graph. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_register_material(haptoflow_engine* engine, const char* json,
                                                                  uint64_t length, uint32_t* index);

/* Replaces the registered material at index; the new one sounds from the next published state on. The old one is
 * freed. If the call fails, the old one stays. Errors: those of haptoflow_engine_register_material. [loader-thread]
 * Publishers, worker and callbacks never wait for it; it waits microseconds for running calls of publishers. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_replace_material(haptoflow_engine* engine, uint32_t index,
                                                                 const char* json, uint64_t length);

/* Returns the number of registered materials, without the model's labels. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_engine_material_count(const haptoflow_engine* engine, uint32_t* count);

/* Fills info for the registered material at index, the one that contact states use. [any-thread] Blocks while another
 * thread registers a material. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_material(const haptoflow_engine* engine, uint32_t index,
                                                         haptoflow_label_info* info);

/* Runs one round of inference for all voices that need a segment. Only for engines without worker.
 * [worker-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_engine_step(haptoflow_engine* engine);

/* Fills the engine's statistics. [any-thread] Never blocks for inference. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_get_statistics(const haptoflow_engine* engine,
                                                               haptoflow_engine_statistics* statistics);

/* Fills times for the tier at index, in the model's order. [any-thread] Never blocks for inference. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_tier_times(const haptoflow_engine* engine, uint32_t index,
                                                           haptoflow_tier_times* times);

/* Writes the message of the newest failure, of a round of inference or of the worker itself, into text: at most
 * capacity bytes including the final zero byte; "" if nothing has failed. *length receives the length of the whole
 * message without that byte. text may be null if capacity is 0. Errors: OUT_OF_MEMORY. [any-thread] Blocks while the
 * worker records a failure. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_last_failure(const haptoflow_engine* engine, char* text,
                                                             uint64_t capacity, uint64_t* length);

/* -------------------------------------------------------------------------------------------------------- voices */

/* The signal of one stylus tip. A number that is never reused; 0 is no voice. At most HAPTOFLOW_MAXIMUM_VOICES exist at
 * a time in a process, over all its engines. */
typedef uint64_t haptoflow_voice;

#define HAPTOFLOW_MAXIMUM_VOICES 64
#define HAPTOFLOW_MAXIMUM_BLEND 4
/* All channels, in place of a channel's number. */
#define HAPTOFLOW_ALL_CHANNELS (-1)

/* The effects of a voice, in the order of the signal except for the last five. An effect that is not requested costs
 * nothing. */
typedef int32_t haptoflow_effect;
enum {
    /* The vibration while the tip slides. */
    HAPTOFLOW_EFFECT_TEXTURE = 0,
    /* The impact of a landing: decaying sinusoids of the label, with an amplitude proportional to the approach
     * speed. */
    HAPTOFLOW_EFFECT_IMPACT = 1,
    /* Crossing a rim of a surface, or sliding to a label of another level. */
    HAPTOFLOW_EFFECT_EDGE = 2,
    HAPTOFLOW_EFFECT_DELAY = 3,
    HAPTOFLOW_EFFECT_COMPENSATION = 4,
    HAPTOFLOW_EFFECT_EXPOSURE_GUARD = 5,
    /* The filter of a material's tone and of a surface's tone_db_per_octave; directly after the texture. */
    HAPTOFLOW_EFFECT_TONE = 6,
    /* The sine of a latency study, which replaces texture, impact, edge and relief: haptoflow_voice_set_signal. */
    HAPTOFLOW_EFFECT_SIGNAL = 7,
    /* Louder and brighter for ears: haptoflow_voice_set_listen. */
    HAPTOFLOW_EFFECT_LISTEN = 8,
    /* The heights of a map under the tip, where impact and edge are added: haptoflow_relief_create. */
    HAPTOFLOW_EFFECT_RELIEF = 9,
    /* An author's clip, with or without contact, where impact and edge are added: haptoflow_voice_play_clip. */
    HAPTOFLOW_EFFECT_CLIP = 10
};

#define HAPTOFLOW_EFFECT_COUNT 11
/* The heights of a surface, which the tip follows: a number that is never 0 and never used again. */
typedef uint32_t haptoflow_relief;

typedef struct haptoflow_relief_options {
    uint32_t struct_size;
    /* The map's texels, 1 to 3 * 2^20 in all. */
    uint32_t columns;
    uint32_t rows;
    /* 1 if the map goes on at its rims with the opposite one; 0 if the rim's heights go on. */
    uint32_t is_tiled;
    /* columns * rows heights in metres, row by row; the first row is at 0. Limited to 0 to depth_metres. Copied. */
    const float* heights_metres;
    /* Length of the map along its columns and its rows where its objects have their usual size, and the range of its
     * heights; all above 0. */
    float size_metres[2];
    float depth_metres;
    /* Radius of the tip's ball, 0 to 0.05 m: it does not reach the bottom of a groove that is narrower. 0 for a
     * point; 0.0005 is a pen's. */
    float tip_radius_metres;
} haptoflow_relief_options;

/* Makes a relief of heights: a pen's tip of 15 g on a spring of 1500 N/m follows them wherever a contact state names
 * the relief, in every voice and engine. 1024 x 1024 texels take half a second and 5.6 MB. Errors: INVALID_ARGUMENT
 * (the message says which number), OUT_OF_MEMORY. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_relief_create(const haptoflow_relief_options* options,
                                                       haptoflow_relief* relief);

/* Destroys the relief and sets *relief to 0; 0 is allowed. A voice that plays it goes on until its next contact state.
 * [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_relief_destroy(haptoflow_relief* relief);

/* Writes the heights in metres of a normal map, columns * rows, row by row, of which the lowest is 0. normals: three
 * numbers for each texel, of any length: along the columns, along the rows, out of the surface. size_metres: length of
 * the map along its columns and its rows. The heights are those whose slopes differ least from the normals' (Frankot
 * and Chellappa 1988); a map that is not tiled is mirrored at its rims for that. Errors: OUT_OF_MEMORY. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_relief_heights_of_normals(const float* normals, uint32_t columns,
                                                                   uint32_t rows, const float* size_metres,
                                                                   uint32_t is_tiled, float* heights_metres);

/* Sets of effects: one bit for each, and one for the empty set. */
#define HAPTOFLOW_ASKS_FOR_TEXTURE 0x1u
#define HAPTOFLOW_ASKS_FOR_IMPACT 0x2u
#define HAPTOFLOW_ASKS_FOR_EDGE 0x4u
#define HAPTOFLOW_ASKS_FOR_RELIEF 0x200u
#define HAPTOFLOW_ASKS_FOR_NOTHING 0x80000000u

/* What the tip does now. engine::ContactState and the C# ContactState have the same fields in the same order, so that
 * nothing converts between them. */
typedef struct haptoflow_contact_state {
    uint32_t struct_size;
    /* 1 while the tip touches a surface, 0 otherwise. */
    uint32_t touching;
    /* Incremented at each touch-down, so that a touch that began and ended between two states is still rendered. A
     * touch begins with another number, or with `touching` after a state that did not touch: it has an onset and an
     * impact of approach_speed_mps, and it ends a panic. If `touching` returns while the number stays the same and is
     * not 0, the touch was only interrupted, say by a surface without a material, and has no second impact. A caller
     * that does not count leaves it at 0: each return of `touching` then has its impact. */
    uint32_t touch_counter;
    /* Used entries of labels and weights, 0 to HAPTOFLOW_MAXIMUM_BLEND. */
    uint32_t label_count;
    /* Indices of the model's labels and of registered materials; unknown ones are ignored. An empty blend is the
     * model's first label. */
    uint32_t labels[HAPTOFLOW_MAXIMUM_BLEND];
    /* 0 to 1 each; they need not sum to 1. */
    float weights[HAPTOFLOW_MAXIMUM_BLEND];
    /* Velocity of the tip relative to the surface, along two axes fixed to it. Limited to 20 m/s each. */
    float velocity_mps[2];
    /* Force along the surface's normal, 0 to 1000 N. */
    float force_newtons;
    /* Speed into the surface at the newest landing. */
    float approach_speed_mps;
    /* The requested effects: HAPTOFLOW_ASKS_FOR_TEXTURE, _IMPACT, _EDGE and _RELIEF combined; 0 for the texture
     * alone. */
    uint32_t effects;
    /* Incremented each time the tip crosses or slides off a rim, and the height of the newest rim, 0 to 1 m. A change
     * of label is not counted: the voice detects it. */
    uint32_t edge_counter;
    float edge_height_metres;
    /* Incremented at each landing on another surface, or on another face of the same one, while the tip keeps touching.
     * A touch-down is not counted here. */
    uint32_t landing_counter;
    /* Size of the surface's features relative to the material's: at 2, ribs are twice as far apart and all frequencies
     * are those at half the speed; the level does not change. 0 for 1; other values are limited to 0.25 to 4. */
    float spatial_scale;
    /* Tilt of the spectrum about 150 Hz, -12 to 12 dB per octave: brighter above 0, darker below; 0 for none. It is
     * added to the material's own tone. */
    float tone_db_per_octave;
    /* 1 if the four fields below say where the tip is; 0 if that is unknown: the voice then adds up velocity_mps from
     * the touch-down on, and a place that is left and found again feels the same within that touch only. */
    uint32_t has_place;
    /* Names the surface: the same place of the same surface feels the same in every touch and every session, and
     * surfaces with different numbers differ. */
    uint32_t surface_seed;
    /* The contact point in metres, in a frame that is fixed to the surface: while the surface moves and turns, the
     * coordinates of a point on it stay the same. */
    float place_metres[3];
    /* The two axes of velocity_mps in that frame, of length 1. */
    float first_axis[3];
    float second_axis[3];
    /* How much this object differs from other objects with the same labels, 0 to 1: at 0 all of them are the labels'
     * mean, at 1 they differ as the recorded pieces of the labels did. surface_seed, with or without a place, says
     * which of the possible objects this one is, the same in every session. Without effect on registered materials and
     * with models that do not tell pieces apart. A single label changes in spectrum and level, a blend in spectrum. */
    float variation;
    /* The relief under the tip (haptoflow_relief_create); 0, or one that was destroyed, for none. */
    haptoflow_relief relief;
    /* Where the contact point lies in its map: 0 to 1 along columns and along rows, as texture coordinates are; a tiled
     * map goes on beyond. The tip leads straight from the place of one state to that of the next, so what is felt of
     * the relief is one state late. */
    float relief_place[2];
    /* The share of the full scale that the relief may reach, 0 to 1: what is small beside it is played as it is, and
     * what is large approaches it, so that the texture keeps the rest. */
    float relief_share;
} haptoflow_contact_state;

/* The work of one effect for a voice. All values are 0 for an effect that was never requested. */
typedef struct haptoflow_effect_statistics {
    uint32_t struct_size;
    /* 1 while the effect is requested; impact, edge and tone are requested by the newest contact state. */
    uint32_t is_asked_for;
    /* How often the effect was prepared, the blocks that it ran for, the samples in them (texture and tone at 2 kHz,
     * the others at the output's rate), and the total time that they took. */
    uint64_t prepared;
    uint64_t runs;
    uint64_t samples;
    double microseconds;
    /* Impacts or edges that were rendered; for the signal, how often it started. */
    uint64_t events;
} haptoflow_effect_statistics;

typedef struct haptoflow_voice_statistics {
    uint32_t struct_size;
    /* The lead: waveform samples from the end of what sounds now to the start of a new segment; 2 samples are 1 ms. */
    uint32_t lead_samples;
    /* Contact states published; segments generated; states that no segment was generated for. */
    uint64_t updates;
    uint64_t inferences;
    uint64_t skipped;
    /* Touches that began to sound, without resumptions, and those of them that ended within one block. */
    uint64_t onsets;
    uint64_t taps;
    /* Underruns: blocks for which no segment provided the samples; a model with a skeleton has none. Late segments.
     * Segments that were not used. */
    uint64_t underruns;
    uint64_t late;
    uint64_t dropped;
    /* Failed runs of a graph. */
    uint64_t failures;
    /* Fields of contact states that were not finite or out of range, and were corrected. */
    uint64_t sanitised;
    /* Touches silenced because no contact state came for 100 ms. */
    uint64_t stale_stops;
    /* Samples that were not finite (replaced by 0), and samples that the limiter reduced. */
    uint64_t non_finite_samples;
    uint64_t limited_samples;
    /* Frames rendered; changes of the output's sample rate; calls refused because another thread was using the voice,
     * and blocks refused because another mixer effect plays this voice. */
    uint64_t rendered_frames;
    uint64_t rate_changes;
    uint64_t refused_calls;
    /* Total time of this voice's inferences in milliseconds; voices that share a run share its time. */
    double inference_ms;
    /* How often a touch resumed after a silence within it: a pause, a mute, a rate change or missing states. */
    uint64_t resumptions;
    /* Blocks at a sample rate outside 8 to 192 kHz; they are silent. */
    uint64_t unsupported_rate_blocks;
    /* Sample rate of the newest block; 0 before the first. */
    double device_rate_hz;
    /* Why the newest block is silent; HAPTOFLOW_SILENCE_NONE if it is not. */
    haptoflow_silence silence;
    /* 0 if the newest block's rate is outside 8 to 192 kHz, 1 otherwise. */
    uint32_t is_rate_supported;
    /* Impacts and edges that were lost, because more than 64 were published between two blocks; the strongest sound. */
    uint64_t lost_contact_events;
    /* Blocks in which the skeleton sounded alone: until the network's first segment of a touch, and while inference is
     * late or fails. 0 for a model without a skeleton. */
    uint64_t sketched;
} haptoflow_voice_statistics;

/* Creates a voice. sample_rate_hz is that of the output, 8000 to 192000; 0 for 48000. It may change later: see
 * haptoflow_voice_render. Errors: INVALID_ARGUMENT (also if there are too many voices), OUT_OF_MEMORY.
 * [loader-thread] Blocks while another voice is created or destroyed, never for inference. */
HAPTOFLOW_API haptoflow_status haptoflow_voice_create(haptoflow_engine* engine, double sample_rate_hz,
                                                      haptoflow_voice* voice);

/* Ends the voice and sets *voice to 0; 0 is allowed. A voice that sounds fades within a block and 5 ms: for as long,
 * haptoflow_voice_render and haptoflow_voices_render still take its number, and every other function refuses it. Its
 * memory is freed by a later call that creates or destroys a voice or closes an engine. [loader-thread] Blocks while
 * another voice is created or destroyed; never for a block, a fade or inference. */
HAPTOFLOW_API haptoflow_status haptoflow_voice_destroy(haptoflow_voice* voice);

/* Publishes what the tip does now: once a frame, also while nothing touches. A touch sounds from the next block on
 * and falls silent after 100 ms of output without a new state. All impacts and edges published between two blocks
 * sound: the first at once, the others at their distance from it, for which states are taken to come evenly. Values
 * that are not finite or out of range are corrected and counted. Errors: BUSY. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_publish(haptoflow_voice voice, const haptoflow_contact_state* state);

/* Writes frame_count frames of the voice into one channel of interleaved samples, or into all channels with
 * HAPTOFLOW_ALL_CHANNELS; other channels are not changed. Samples are within +-1. channel_count is 1 to 64. If
 * sample_rate_hz differs from the last block's, the voice fades within 5 ms and is silent until the worker has
 * prepared for the new rate; a touch that still continues then sounds again, according to its newest state. At a
 * rate outside 8 to 192 kHz the voice stays silent and its statistics report the rate. For a voice that is not open
 * and has faded, or that another thread is rendering, zeros are written. Errors: BUSY; this function sets no
 * message. [audio-callback] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_render(haptoflow_voice voice, float* interleaved, uint32_t frame_count,
                                                      uint32_t channel_count, int32_t channel, double sample_rate_hz);

/* Writes the sum of the voices as haptoflow_voice_render writes one voice, also for none. The sum passes the
 * limiter's curve once, below the lowest ceiling above 0 of the voices; a single voice sounds as
 * haptoflow_voice_render gives it. Sets voices[i] to 0 if that voice is not open and has faded. BUSY if another
 * thread is rendering one of the voices, which is then missing in the sum. Errors: BUSY; this function sets no
 * message. [audio-callback] */
HAPTOFLOW_API haptoflow_status haptoflow_voices_render(haptoflow_voice* voices, uint32_t voice_count,
                                                       float* interleaved, uint32_t frame_count, uint32_t channel_count,
                                                       int32_t channel, double sample_rate_hz);

/* Sets the gain of the output before the limiter, 0 to 1. It changes within 10 ms while the voice sounds, delayed
 * sound included; set while the voice is silent, it applies from the first sample of the next touch. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_strength(haptoflow_voice voice, float strength);

/* Sets the maximum magnitude of the output, 0 to 1; no sample ever exceeds it. The limiter's curve begins at 0.7 of
 * the ceiling and approaches it smoothly. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_ceiling(haptoflow_voice voice, float ceiling);

/* Mutes (1) or unmutes (0) the voice. A muted voice falls silent within a block and 5 ms and needs no inference.
 * [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_muted(haptoflow_voice voice, uint32_t muted);

/* Pauses the voice, for an application that is suspended; like muting, and independent of it. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_paused(haptoflow_voice voice, uint32_t paused);

/* Silences the touch that was published last by the end of the next block, whatever the block's length. The next
 * touch-down published after this call sounds: another touch_counter, or touching after a state that did not touch.
 * [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_panic(haptoflow_voice voice);

/* haptoflow_voice_panic for every voice of the process. Never fails. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_panic(void);

/* Fills the voice's statistics. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_get_statistics(haptoflow_voice voice,
                                                              haptoflow_voice_statistics* statistics);

/* Fills the statistics of one effect of the voice. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_effect_statistics(haptoflow_voice voice, haptoflow_effect effect,
                                                                 haptoflow_effect_statistics* statistics);

/* Delays the whole signal, for studies and slow displays: 0 to 0.5 s, 0 for no delay. A change fades within 20 ms.
 * Lift-off closes the texture before the delay; strength, ceiling, mute, pause, panic and missing states act after
 * it, at once. Errors: OUT_OF_MEMORY. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_delay(haptoflow_voice voice, double seconds);

/* Sets a sine for studies of latency. While it is set, the voice plays only this sine (no texture, impact or edge,
 * and no inference) whenever the newest contact state touches and moves at 5 mm/s or more along the surface,
 * independently of force and speed. It starts and stops within 2 ms on a raised cosine, starts at phase 0 after
 * silence, and keeps its phase continuous while it sounds, also when the frequency changes. Strength, delay,
 * compensation, exposure guard, mute, pause, panic and missing states act on it as on the other effects.
 * frequency_hz: 20 to 500; it is ignored if the amplitude is 0. amplitude_mps2: the peak amplitude, 0 to 60. An
 * amplitude of 0 switches the signal off, and the texture sounds again with the next state. Both values take effect
 * with the next block; a change of amplitude takes 10 ms. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_signal(haptoflow_voice voice, double frequency_hz,
                                                          double amplitude_mps2);

/* How often contact states have started and stopped the signal, and the latency of these changes. The latency runs from
 * haptoflow_voice_publish of the first state that causes the change to the start of the block in which the change
 * begins. It includes the voice's delay, but not the delay of compensation and device. Changes caused by mute, pause,
 * panic, missing states or haptoflow_voice_set_signal are not counted. All values are zero before the first change. */
typedef struct haptoflow_signal_statistics {
    uint32_t struct_size;
    uint64_t starts;
    uint64_t stops;
    double last_start_latency_seconds;
    double last_stop_latency_seconds;
    /* Means over all counted changes. */
    double mean_start_latency_seconds;
    double mean_stop_latency_seconds;
} haptoflow_signal_statistics;

/* Fills the statistics of the signal. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_signal_statistics(haptoflow_voice voice,
                                                                 haptoflow_signal_statistics* statistics);

/* Sets the actuator that plays the voice, so that its resonances and weak bands are compensated: an actuator profile
 * as JSON of length bytes, or the name of a built-in profile ("flat", "voice-coil"); null for no compensation. The
 * worker prepares the filter for the output's rate; the change then fades over 10 ms. Errors: INVALID_ARGUMENT (the
 * message names the key), OUT_OF_MEMORY. [loader-thread] Parses the profile. */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_actuator(haptoflow_voice voice, const char* profile,
                                                            uint64_t length);

/* is_on: 1 switches the exposure guard on, which slowly lowers a level that stays high for too long, but never to
 * silence; 0 switches it off. Switched off it measures on, and switched on again it knows the exposure of the whole
 * day since it was first on. actuator_gain: acceleration at the hand per m/s^2 of the voice, above 0 to 1000; 0 for
 * 1. Documentation~/effects-and-outputs.md gives the law. The guard is not a medical device. Errors: OUT_OF_MEMORY.
 * [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_exposure_guard(haptoflow_voice voice, uint32_t is_on,
                                                                  float actuator_gain);

/* Why the exposure guard lowers the level of a voice. */
typedef int32_t haptoflow_exposure_reason;
enum {
    HAPTOFLOW_EXPOSURE_NONE = 0,
    /* A high level for minutes. */
    HAPTOFLOW_EXPOSURE_SHORT_TERM = 1,
    /* The daily exposure, weighted according to ISO 5349-1. */
    HAPTOFLOW_EXPOSURE_DOSE = 2
};

/* State of the exposure guard after the newest block. Without a guard that is on, all values are zero and the gain is
 * 1. */
typedef struct haptoflow_exposure {
    uint32_t struct_size;
    haptoflow_exposure_reason reason;
    /* The gain that the guard applies to the voice. */
    double gain;
    /* The equivalent level of the last minutes before the guard's gain, and the daily exposure A(8) at the hand, both
     * in m/s^2; and the time for which the level has been lowered. */
    double short_term_mps2;
    double daily_mps2;
    double lowered_seconds;
} haptoflow_exposure;

/* Fills the state of the voice's exposure guard. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_exposure(haptoflow_voice voice, haptoflow_exposure* exposure);

/* Returns the voice's slot, 0 to HAPTOFLOW_MAXIMUM_VOICES - 1, to which the parameter "Voice" of Unity's mixer
 * effect refers. Slots are reused. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_place(haptoflow_voice voice, uint32_t* place);

/* -------------------------------------------------------------------------------------------------------- clips */

/* A vibration as the tools of the field describe one: amplitude and frequency of a carrier over time, and transients.
 * Its amplitude is a share of a device's range by the loudness law of devices with amplitude and frequency:
 * haptoflow_device_share. Documentation~/effects-and-outputs.md says what each format loses. */
typedef struct haptoflow_clip haptoflow_clip;

typedef int32_t haptoflow_clip_format;
enum {
    /* .haptic 1.0.0 of Meta and Lofelt, .ahap of Apple, .hjif of MPEG-I haptics (ISO/IEC 23090-31); all are JSON. */
    HAPTOFLOW_CLIP_HAPTIC = 0,
    HAPTOFLOW_CLIP_AHAP = 1,
    HAPTOFLOW_CLIP_HJIF = 2
};

typedef struct haptoflow_clip_options {
    uint32_t struct_size;
    /* Sample rate of the wave: a multiple of 2000 up to 192000; 0 for 2000. */
    uint32_t sample_rate_hz;
    /* In m/s^2; samples that are not finite count as 0. At most 600 s. */
    const float* wave_mps2;
    uint64_t sample_count;
    /* 1 for a wave that goes on at its beginning. */
    uint32_t is_loop;
    /* What files say of the clip, in UTF-8; each may be null. */
    const char* title;
    const char* description;
    const char* source;
} haptoflow_clip_options;

typedef struct haptoflow_clip_info {
    uint32_t struct_size;
    haptoflow_clip_format format;
    double duration_seconds;
    uint32_t amplitude_points;
    uint32_t frequency_points;
    uint32_t transients;
    /* 0 to 1. */
    float largest_amplitude;
    /* Valid as long as the clip. `omitted` says in words what the file has and the clip has not; empty for nothing. */
    const char* title;
    const char* description;
    const char* editor;
    const char* omitted;
} haptoflow_clip_info;

/* Makes the clip of a wave. Close it with haptoflow_clip_close. Errors: OUT_OF_MEMORY. [any-thread] Takes about 2 us
 * per ms of wave. */
HAPTOFLOW_API haptoflow_status haptoflow_clip_create(const haptoflow_clip_options* options, haptoflow_clip** clip);

/* Reads a clip file's text of length bytes; the format is recognised by its keys. Close the clip with
 * haptoflow_clip_close. Errors: INVALID_ARGUMENT (the message names the key), OUT_OF_MEMORY. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_clip_read(const char* text, uint64_t length, haptoflow_clip** clip);

/* Closes *clip and sets it to null; a null handle is allowed. A voice that plays it plays on. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_clip_close(haptoflow_clip** clip);

/* Fills the clip's figures; `format` is that of a read clip's file. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_clip_describe(const haptoflow_clip* clip, haptoflow_clip_info* info);

/* Writes the clip in a format to text of *length bytes, at most capacity, without a final zero; with a capacity of 0
 * only *length is set. date: YYYY-MM-DD of the file's creation, which .hjif names. Points are left out while amplitudes
 * stay within 0.5 dB and there are at most 100 a second. Errors: INVALID_ARGUMENT (also for too small a capacity),
 * OUT_OF_MEMORY. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_clip_write(const haptoflow_clip* clip, haptoflow_clip_format format,
                                                    const char* date, char* text, uint64_t capacity, uint64_t* length);

/* Reads amplitude (0 to 1) and frequency (Hz) at `count` times, evenly from the clip's start to its end; either array
 * may be null. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_clip_curves(const haptoflow_clip* clip, uint32_t count, float* amplitude,
                                                     float* frequency_hz);

/* The clip as a vibration in m/s^2 at sample_rate_hz, 2000 to 192000: *sample_count samples, at most capacity; with a
 * capacity of 0 only *sample_count is set. Errors: INVALID_ARGUMENT (also for too small a capacity), OUT_OF_MEMORY.
 * [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_clip_wave(const haptoflow_clip* clip, double sample_rate_hz, float* wave_mps2,
                                                   uint64_t capacity, uint64_t* sample_count);

/* Plays a clip on a voice beside its texture, with or without contact, from its next block on; null ends it. gain: 0 to
 * 4. is_loop: 1 to play it until another one or null. A voice plays one clip at a time. Strength, delay, compensation,
 * exposure guard and limiter act on it as on the other effects; mute, pause, panic, missing states and a change of the
 * device's rate end it; while the voice is silent for one of these, or plays a signal, a clip is not played. Errors:
 * OUT_OF_MEMORY, BUSY (another thread publishes on this voice now). [publisher] The first play of a clip takes about 1
 * us per ms of it. */
HAPTOFLOW_API haptoflow_status haptoflow_voice_play_clip(haptoflow_voice voice, const haptoflow_clip* clip, float gain,
                                                         uint32_t is_loop);

/* ------------------------------------------------------------------------------------------------ wave features */

/* Converts a wave to frames for a motor or a device with a single carrier, after Intensity Segment Modulation: each
 * frame has the same perceived intensity as the wave. */
typedef struct haptoflow_wave_features haptoflow_wave_features;

typedef struct haptoflow_wave_features_options {
    uint32_t struct_size;
    /* Sample rate of the wave: a multiple of 2000 up to 192000; 0 for 2000. Above 2000 a low-pass adds 1.5 ms of
     * delay. */
    uint32_t sample_rate_hz;
    /* Length of a frame, 0.002 to 0.032; 0 for 0.005. Need not be a whole number of samples. */
    double frame_seconds;
    /* Range of the device, above 0 to 1000; 0 for 60 and 400. Equal values for a motor with a single frequency. */
    double minimum_frequency_hz;
    double maximum_frequency_hz;
} haptoflow_wave_features_options;

/* One frame. This struct has no struct_size and will not change. */
typedef struct haptoflow_wave_frame {
    /* Number of the first sample at 2000 Hz since the features were created or reset, including the low-pass's
     * delay. */
    uint64_t first_sample;
    uint32_t sample_count;
    /* Perceived intensity; 1 is the detection threshold. Smoothed with a time constant of 15 ms, except where it is
     * sudden. */
    float intensity;
    /* Mean frequency of the part of the spectrum that exceeds the threshold; the last one while the wave is silent. */
    float centroid_hz;
    /* The carrier: the centroid mapped to the device's range, and the amplitude (peak, m/s^2) at which a sinusoid of
     * that frequency has the same intensity. */
    float frequency_hz;
    float amplitude_mps2;
    /* The onset of a tap or an edge: its time in seconds from the start of the frame, and the carrier with the
     * intensity of its peak; an amplitude of 0 if there is none. */
    float transient_offset_seconds;
    float transient_amplitude_mps2;
    float transient_frequency_hz;
} haptoflow_wave_frame;

/* Creates wave features. Close them with haptoflow_wave_features_close. Errors: OUT_OF_MEMORY. [any-thread]
 * Allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_create(const haptoflow_wave_features_options* options,
                                                              haptoflow_wave_features** features);

/* Closes *features and sets it to null; a null handle is allowed. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_close(haptoflow_wave_features** features);

/* Clears the history of the wave; the next sample is the first one. [any-thread] Blocks while another thread uses
 * these features. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_reset(haptoflow_wave_features* features);

/* Sets the range of the device from the next frame on, above 0 to 1000 Hz each. [any-thread] Blocks while another
 * thread uses these features. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_set_range(haptoflow_wave_features* features,
                                                                 double minimum_frequency_hz,
                                                                 double maximum_frequency_hz);

/* Processes the next sample_count samples of the wave, in m/s^2, and writes the frames that they complete;
 * *frame_count receives the number of frames. A frame is complete 4 ms after its end. A capacity of sample_count /
 * (rate * frame_seconds) + 1 frames is always enough; frames beyond capacity are lost. Samples that are not finite
 * count as 0. [any-thread] Blocks while another thread uses these features; takes about 2 us per ms of wave. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_process(haptoflow_wave_features* features,
                                                               const float* wave_mps2, uint64_t sample_count,
                                                               haptoflow_wave_frame* frames, uint64_t capacity,
                                                               uint64_t* frame_count);

/* --------------------------------------------------------------------------------------------------- recordings */

/* A recording of one material, read from a table (CSV) or a WAV file and the files beside it: NAME.json,
 * recordings.json and the motion's table. Documentation~/own-materials.md describes them. */
typedef struct haptoflow_recording haptoflow_recording;

/* A file that is part of an application. */
typedef struct haptoflow_recording_file {
    /* Name with ending, without a folder. */
    const char* name;
    const void* bytes;
    uint64_t byte_count;
} haptoflow_recording_file;

typedef struct haptoflow_recording_options {
    uint32_t struct_size;
    /* 0 for files on disk. */
    uint32_t file_count;
    /* Path of the .csv, .wav or .w64 file in UTF-8, or its name among `files`. */
    const char* path;
    /* The recording and what lies beside it; read during the call only. */
    const haptoflow_recording_file* files;
    /* The acceleration in m/s^2, above 0, that a sample of +-1 in a WAV file stands for. It replaces the sidecar's; 0
     * leaves it to the sidecar. */
    double full_scale_mps2;
    /* 1 to read the sidecar and the names of the columns only: there are texts, and no samples. */
    uint32_t without_samples;
    /* 1 to refuse a recording whose motion or force is unknown. */
    uint32_t needs_motion_and_force;
} haptoflow_recording_options;

/* Readings of one sensor at increasing times of its own. */
typedef struct haptoflow_track {
    const double* seconds;
    /* `width` numbers for each time. */
    const double* values;
    uint64_t count;
    uint64_t width;
} haptoflow_track;

/* Pointers are valid until the recording is closed; null where there is nothing. */
typedef struct haptoflow_recording_info {
    uint32_t struct_size;
    /* Axes of the acceleration: 1 or 3, interleaved. */
    uint32_t axis_count;
    /* 1000 to 192000. */
    double sample_rate_hz;
    /* Of the first 300 s. */
    uint64_t sample_count;
    /* sample_count * axis_count numbers in m/s^2, with or without gravity. A gap is not finite. */
    const float* acceleration_mps2;
    /* vx and vy for each sample; null for constant_velocity_mps. */
    const float* velocity_mps;
    /* The force for each sample; null for constant_force_newtons. */
    const float* force_newtons;
    /* Not finite where unknown or not constant. */
    double constant_velocity_mps[2];
    double constant_force_newtons;
    /* The whole recording as measured: m/s^2; m/s, or m where motion_is_position; N. */
    haptoflow_track acceleration;
    haptoflow_track motion;
    haptoflow_track force;
    uint32_t motion_is_position;
    uint32_t reserved;
    /* Of the sidecar; empty where unknown. */
    const char* label;
    const char* licence;
    const char* source;
    /* Path of the motion's table; empty for none. */
    const char* motion_path;
    /* What was ignored, corrected or looks odd, one sentence on each line; empty for nothing. */
    const char* notes;
    /* The name and the provenance of a material that is learnt from it. */
    const char* material_name;
    const char* provenance;
} haptoflow_recording_info;

/* Reads a recording. Close *recording with haptoflow_recording_close. Errors: RECORDING_UNUSABLE (the message names the
 * file, the line and column or the key, what was found and what is expected), OUT_OF_MEMORY. [loader-thread] Blocks for
 * the disk; allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_recording_read(const haptoflow_recording_options* options,
                                                        haptoflow_recording** recording);

/* Copies a recording from memory: the samples, the constants and the texts of *info; its tracks are not read. Close
 * *recording with haptoflow_recording_close. Errors: OUT_OF_MEMORY. [any-thread] Allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_recording_create(const haptoflow_recording_info* info,
                                                          haptoflow_recording** recording);

/* Fills *info. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_recording_get_info(const haptoflow_recording* recording,
                                                            haptoflow_recording_info* info);

/* Combines the beginning of a recording into one axis of 10 to 1000 Hz at 2000 Hz, as learning does before it removes
 * the noise. Writes wave_count samples in m/s^2, zeros beyond the end of the recording. Errors: OUT_OF_MEMORY.
 * [any-thread] Allocates; takes about 10 ms per second of wave. */
HAPTOFLOW_API haptoflow_status haptoflow_recording_wave(const haptoflow_recording* recording, float* wave_mps2,
                                                        uint64_t wave_count);

/* Where the noise of a recording's sensor was found. */
typedef int32_t haptoflow_noise_source;
enum {
    /* No part of the recording shows it, or it is too weak to matter. */
    HAPTOFLOW_NOISE_NONE = 0,
    /* Where the tip rests for 0.2 s or more, on the surface or in the air. */
    HAPTOFLOW_NOISE_REST = 1,
    /* Where the tip moves so slowly that the level no longer follows the speed. */
    HAPTOFLOW_NOISE_QUIET_PART = 2
};

/* Removes the noise of the sensor from a wave of one axis at 2 kHz in m/s^2, in place, as learning does: its power is
 * subtracted at every time and frequency. The wave keeps every bit where no noise is found. A number that is not finite
 * separates two recordings of one sensor. velocity_mps: vx and vy for each sample; force_newtons: one for each. Sets
 * *source to where the noise was found, and *noise_mps2 to the RMS of what was removed. Errors: RECORDING_UNUSABLE (the
 * wave is no stronger where the tip slides than where it rests, so it holds only noise), OUT_OF_MEMORY. [any-thread]
 * Never blocks; allocates; takes about 0.5 ms per second of recording. */
HAPTOFLOW_API haptoflow_status haptoflow_recording_remove_noise(float* vibration_mps2, const float* velocity_mps,
                                                                const float* force_newtons, uint64_t sample_count,
                                                                haptoflow_noise_source* source, double* noise_mps2);

/* Resamples a waveform without delay: flat to 95 % of half of the lower rate, -66 dB 5 % above it. Both rates: 1000 to
 * 192000 Hz. Writes wave_count samples, zeros beyond the end. Errors: OUT_OF_MEMORY. [any-thread] Never blocks;
 * allocates; takes about 10 ms per second of waveform at 48 kHz. */
HAPTOFLOW_API haptoflow_status haptoflow_resample(const float* samples, uint64_t sample_count, double sample_rate_hz,
                                                  float* wave, uint64_t wave_count, double wave_rate_hz);

/* Closes *recording and sets it to null; a null handle is allowed. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_recording_close(haptoflow_recording** recording);

/* ----------------------------------------------------------------------------------------------------- learning */

/* Learns a material from a recording of one surface: at least 10 s of sliding at slow and fast speeds, in all
 * directions of interest. The result is the text of a material file for haptoflow_engine_register_material. */
typedef struct haptoflow_learning haptoflow_learning;

/* Receives the completed share, 0 to 1, and a description of the present step, which is valid during the call. Called
 * on the thread that learns, a few times per second; it must return. */
typedef void (*haptoflow_progress_callback)(void* context, double share, const char* doing);

typedef struct haptoflow_learning_options {
    uint32_t struct_size;
    uint32_t reserved;
    /* With motion and force; the first 300 s are used. A sample that is not finite excludes the samples around it. */
    const haptoflow_recording* recording;
    /* The speed in m/s along the first axis and the force in N of a recording that has none; 0 for none. */
    double speed_mps;
    double force_newtons;
    const haptoflow_runtime* runtime;
    /* The material will work with this model and with others of the same embedding space. */
    const haptoflow_model* model;
    /* Name of the tier; null for the model's default. */
    const char* tier;
    /* The material's name: lower case like a label's, 1 to 128 bytes; null or empty for the recording's. */
    const char* name;
    /* Defaults for null or empty: the category of the start label; no description; the recording's licence. */
    const char* category;
    const char* description;
    const char* licence;
    /* Equal options give equal bytes, unless seconds_limit ends the fit early. */
    uint64_t seed;
    /* Seconds of the calling thread's processor time after which the fit ends with its best result; 0 for 20. A fit
     * takes about 8. */
    double seconds_limit;
    /* Null for no progress reports. */
    haptoflow_progress_callback progress;
    void* progress_context;
    /* Null for none. */
    const haptoflow_cancellation* cancellation;
    /* The wave vectors k1x, k1y, k2x, k2y in cycles per millimetre along the recording's axes, zeros for a surface
     * without ribs; null to find them in the recording. */
    const float* wave_vectors;
    /* Null or empty to learn a new material. A label of the model: the material keeps its embedding and wave vectors,
     * in the recording's own frame, and only level and tone are fitted to the recording. */
    const char* label;
} haptoflow_learning_options;

/* Learns a material and returns when it is done. Close *learning with haptoflow_learning_close. Errors:
 * RECORDING_UNUSABLE (no speed or no force, too short, silent, nothing but noise, clipped, not finite, no motion, or a
 * speed, force or level that no hand reaches: the message says which), CANCELLED, MODEL_INCONSISTENT, INFERENCE_FAILED,
 * TIER_TOO_SLOW, OUT_OF_MEMORY. [loader-thread] Blocks for seconds; allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_learn_material(const haptoflow_learning_options* options,
                                                        haptoflow_learning** learning);

/* Sets *material to the text of the material file and *report to a JSON object with the results: start_label (whose
 * render is nearest to the recording: the search began there), start_distance_db, nearest_label (of
 * haptoflow_model_nearest_label for the learnt embedding), fitted_distance_db, spectral_distance_db, other_tiers (the
 * same distance on each other tier, and whether it is further_off), level_error_db, spectra and levels (of recording,
 * material and nearest label, over speed and force: see Documentation~/own-materials.md), sliding_seconds, speed_mps,
 * force_newtons, level_exponents, wave_vectors, turn_degrees (from the recording's first axis to the material's first
 * axis, which is perpendicular to its most distinct ribs), sensor_noise (mps2, and from: "rest", "quiet part" or
 * "none"; it was removed before), seeds (only of a model without a skeleton), segments, seconds, stopped_early,
 * record_next, warnings and more. Both are valid until the learning is closed. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_learning_results(const haptoflow_learning* learning, const char** material,
                                                          const char** report);

/* Closes *learning and sets it to null; a null handle is allowed. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_learning_close(haptoflow_learning** learning);

/* Finds the wave vectors of ribs or threads in a wave of one axis at 2 kHz. Ribs are lines of the spectrum whose
 * frequency grows with the speed across them. vibration_mps2: sample_count numbers; a number that is not finite
 * separates two recordings. velocity_mps: vx and vy for each sample. Writes four numbers, k1x, k1y, k2x, k2y, to
 * wave_vectors, in cycles per millimetre along the axes of the velocity, the most distinct vector first, zeros for
 * none. Errors: OUT_OF_MEMORY. [loader-thread] Computes for about a second per minute of recording; allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_find_wave_vectors(const float* vibration_mps2, const float* velocity_mps,
                                                           uint64_t sample_count, double* wave_vectors);

/* --------------------------------------------------------------------------------------- loudness of outputs */

/* How a device in the hand takes a vibration. Each kind has a level of its own. */
typedef int32_t haptoflow_device_kind;
enum {
    /* One amplitude at a time, for a motor. */
    HAPTOFLOW_DEVICE_MOTOR = 0,
    /* Amplitude and frequency over time. */
    HAPTOFLOW_DEVICE_PARAMETRIC = 1,
    /* The waveform itself. */
    HAPTOFLOW_DEVICE_WAVEFORM = 2
};

/* Sets *share to the part of the device's range, 0 to below 1, at which an acceleration amplitude (peak, m/s^2) is
 * played: the loudness law of Documentation~/effects-and-outputs.md, which keeps the order of any two amplitudes. An
 * amplitude that is not above 0 gives 0. [any-thread] Never blocks; allocates only to report an error. */
HAPTOFLOW_API haptoflow_status haptoflow_device_share(haptoflow_device_kind kind, float amplitude_mps2, float* share);

/* Applies the loudness law of HAPTOFLOW_DEVICE_WAVEFORM to a wave, by a gain that follows its envelope; delays the wave
 * by 1 ms. */
typedef struct haptoflow_device_wave haptoflow_device_wave;

/* Creates a device wave for a sample rate of 2000 to 192000 Hz. Close it with haptoflow_device_wave_close. Errors:
 * OUT_OF_MEMORY. [any-thread] Allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_device_wave_create(double sample_rate_hz, haptoflow_device_wave** wave);

/* Closes *wave and sets it to null; a null handle is allowed. [any-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_device_wave_close(haptoflow_device_wave** wave);

/* Continues with silence. [any-thread] Blocks while another thread uses this wave. */
HAPTOFLOW_API haptoflow_status haptoflow_device_wave_reset(haptoflow_device_wave* wave);

/* Replaces the next sample_count samples, +-1 at full_scale_mps2, by those for the device, within +-1. Samples that
 * are not finite count as 0. [any-thread] Blocks while another thread uses this wave. */
HAPTOFLOW_API haptoflow_status haptoflow_device_wave_process(haptoflow_device_wave* wave, float* samples,
                                                             uint64_t sample_count, float full_scale_mps2);

/* Makes a voice audible on loudspeakers (is_on 1): louder, and brighter from 150 Hz on, after every other effect and
 * before the limiter; delays it by 1 ms. For ears only: 0 for an output that feeds an actuator. The worker prepares
 * the effect; the change then fades over 10 ms. Errors: OUT_OF_MEMORY. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_listen(haptoflow_voice voice, uint32_t is_on);

/* ---------------------------------------------------------------------------------------------------- agreement */

/* Sets *bytes to the size with which the library was built of a struct of this header, for example of
 * "haptoflow_engine_options". A caller that declares the structs itself, in another language, compares its own sizes
 * with these before the first call that passes one. Errors: also for a name that this library's header does not
 * have. [any-thread] Never blocks; allocates only to report an error. */
HAPTOFLOW_API haptoflow_status haptoflow_struct_size(const char* name, uint32_t* bytes);

#ifdef __cplusplus
}
#endif

#endif
