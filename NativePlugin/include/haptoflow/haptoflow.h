/*
 * HaptoFlow's C interface: the one public header of the library audioplugin_haptoflow.
 *
 * Conventions
 *
 * - Every function that can fail returns a haptoflow_status; after one other than HAPTOFLOW_OK,
 *   haptoflow_last_message() says what was wrong, on the thread that made the call. Outputs are untouched by a call
 *   that fails, unless its comment says otherwise.
 * - Every descriptor begins with struct_size, which the caller sets to sizeof the struct it was compiled with. A
 *   shorter struct (an older caller) leaves the later fields at their defaults, zero; fields that this library does not
 *   know (a newer caller) are ignored. A struct that the library fills is filled up to the smaller of the caller's and
 *   the library's size, and its struct_size then says how many bytes that is: fields behind it were not filled. Set
 *   struct_size anew before each call.
 * - Handles are opaque and never used twice: a call with a handle that was closed, or with anything else that is not an
 *   open handle of that kind, returns HAPTOFLOW_INVALID_ARGUMENT. An open handle keeps alive what it was made from.
 * - Text is UTF-8 and ends with a zero byte. Text that the library returns belongs to the library.
 * - Units are in the names: m/s^2 (mps2), m/s (mps), newtons, ms. Waveforms run at 2000 samples per second.
 * - No C++ exception leaves the library.
 *
 * Thread tags, one on every function
 *
 * [any-thread]     May be called from any thread, at any time, also at the same time as other calls.
 * [loader-thread]  May be called from any thread that can wait: it reads files, allocates memory, or builds networks.
 *                  Never call it from an audio callback, and from a main thread only while something loads.
 * [worker-thread]  May be called from any thread that can wait for a network: it allocates inside ONNX Runtime and
 *                  takes up to milliseconds. Never call it from an audio callback. Calls on one generator queue up.
 * [publisher]      May be called from any thread that is not an audio callback; takes microseconds and waits for
 *                  nobody. Two threads must not publish on one voice at the same time: the second is refused.
 * [audio-callback] Made for the audio callback: takes microseconds, never allocates, locks, logs or enters the kernel.
 *                  May be called from any thread; two must not render one voice at the same time: the second is refused
 *                  and gets silence.
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

/* The version of this header, that of package.json. haptoflow_version() is the loaded library's. */
#define HAPTOFLOW_VERSION_MAJOR 0
#define HAPTOFLOW_VERSION_MINOR 1
#define HAPTOFLOW_VERSION_PATCH 0
#define HAPTOFLOW_VERSION_TEXT "0.1.0"

/* Samples of a segment and of the previous waveform; numbers of a material embedding, a motion and a rib phase. */
#define HAPTOFLOW_SEGMENT_SAMPLES 200
#define HAPTOFLOW_EMBEDDING_SIZE 64
#define HAPTOFLOW_MOTION_SIZE 3
#define HAPTOFLOW_RIB_COUNT 2

/* The acceleration in m/s^2 that is +-1 in the output unless options say otherwise. */
#define HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2 200.0
#define HAPTOFLOW_MAXIMUM_BATCH 256

typedef int32_t haptoflow_status;
enum {
    HAPTOFLOW_OK = 0,
    /* A null pointer, a handle that is not open, an index or a number out of range, a name that is not there. */
    HAPTOFLOW_INVALID_ARGUMENT = 1,
    HAPTOFLOW_OUT_OF_MEMORY = 2,
    /* A defect of this library. */
    HAPTOFLOW_INTERNAL_ERROR = 3,
    /* Another thread is publishing on, or rendering, this voice. */
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
    /* A checksum does not match: the file was changed or broken on its way. */
    HAPTOFLOW_MODEL_DAMAGED = 15,
    /* The file is intact and breaks a rule of its format, or one of its graphs does. */
    HAPTOFLOW_MODEL_INCONSISTENT = 16,
    /* The material was learnt for another model: its space is not this model's. */
    HAPTOFLOW_MATERIAL_MISMATCH = 17,
    /* The text is not a material file; the message names the key. */
    HAPTOFLOW_MATERIAL_INVALID = 18,
    /* Nothing can be learnt from the recording; the message says why. */
    HAPTOFLOW_RECORDING_UNUSABLE = 19,
    /* No ONNX Runtime of version 1.16 or newer at the given place. */
    HAPTOFLOW_RUNTIME_UNAVAILABLE = 20,
    /* A graph failed while running, or returned numbers that are not finite. */
    HAPTOFLOW_INFERENCE_FAILED = 21,
    /* A load ended because its haptoflow_cancellation was cancelled. */
    HAPTOFLOW_CANCELLED = 22,
    /* A probe run of a tier took longer than probe_limit_ms; the message names the tier. */
    HAPTOFLOW_TIER_TOO_SLOW = 23
};

typedef int32_t haptoflow_solver;
enum {
    /* The solver and the number of steps that the tier names as its own. */
    HAPTOFLOW_SOLVER_OF_TIER = 0,
    HAPTOFLOW_SOLVER_EULER = 1,
    HAPTOFLOW_SOLVER_MIDPOINT = 2,
    HAPTOFLOW_SOLVER_HEUN = 3
};

/* ------------------------------------------------------------------------------------------------------ library */

/* The library's version, for example "0.1.0". Lives as long as the process. Never fails.
 * [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_version(void);

/* A status's name, for example "HAPTOFLOW_OK"; "HAPTOFLOW_UNKNOWN_STATUS" for a number that is none. Lives as long as
 * the process. Never fails.
 * [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_status_name(haptoflow_status status);

/* Why a voice is silent. Where several reasons hold, the one that lasts longest. */
typedef int32_t haptoflow_silence;
enum {
    /* It sounds. */
    HAPTOFLOW_SILENCE_NONE = 0,
    /* Nothing touches, or the tip does not slide. */
    HAPTOFLOW_SILENCE_REST = 1,
    /* No contact state was published for 100 ms. */
    HAPTOFLOW_SILENCE_STALE = 2,
    HAPTOFLOW_SILENCE_MUTED = 3,
    HAPTOFLOW_SILENCE_PAUSED = 4,
    /* A panic silenced this touch; the next one sounds. */
    HAPTOFLOW_SILENCE_PANIC = 5,
    /* The device changed to a sample rate that the worker is still preparing for, or to one outside 8 to 192 kHz. */
    HAPTOFLOW_SILENCE_RATE = 6,
    HAPTOFLOW_SILENCE_CLOSING = 7,
    /* The thread that generates has ended: haptoflow_engine_last_failure says why. */
    HAPTOFLOW_SILENCE_WORKER_DEAD = 8
};

/* A reason's name, for example "HAPTOFLOW_SILENCE_STALE"; "HAPTOFLOW_UNKNOWN_SILENCE" for a number that is none. Lives
 * as long as the process. Never fails.
 * [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_silence_name(haptoflow_silence silence);

/* What was wrong in the last call on this thread that failed; "" before the first. Stays valid until the next call on
 * this thread that fails, and at most as long as the thread. Never fails.
 * [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_last_message(void);

/* ------------------------------------------------------------------------------------------------- ONNX Runtime */

typedef struct haptoflow_runtime haptoflow_runtime;

/* How grave a message is: ONNX Runtime's own numbers. */
enum { HAPTOFLOW_LOG_WARNING = 2, HAPTOFLOW_LOG_ERROR = 3, HAPTOFLOW_LOG_FATAL = 4 };

/* Gets a warning or an error. message is valid during the call only. Called from threads that load and from workers,
 * several at the same time, never from an audio callback. Must not call this library. */
typedef void (*haptoflow_log_callback)(void* context, int32_t severity, const char* message);

/* Exactly one of ort_api_base and library_path must be set. */
typedef struct haptoflow_runtime_options {
    uint32_t struct_size;
    /* What OrtGetApiBase() of a loaded ONNX Runtime returned (const OrtApiBase*). That library must stay loaded. */
    const void* ort_api_base;
    /* Or the file of an ONNX Runtime library, which then stays loaded until the process ends. */
    const char* library_path;
    /* Gets what ONNX Runtime has to say of the graphs that this runtime loads and runs; null for its usual place, the
     * standard error stream. Never called again once haptoflow_runtime_close has returned. ONNX Runtime 1.16 has one
     * log for the process, that of whoever used it first. */
    haptoflow_log_callback log;
    /* Handed to log. */
    void* log_context;
} haptoflow_runtime_options;

/* Makes ONNX Runtime available; one for the whole process is enough. Close it with haptoflow_runtime_close.
 * Errors: INVALID_ARGUMENT, RUNTIME_UNAVAILABLE, OUT_OF_MEMORY.
 * [loader-thread] Blocks on disk while the library loads. */
HAPTOFLOW_API haptoflow_status haptoflow_runtime_open(const haptoflow_runtime_options* options,
                                                      haptoflow_runtime** runtime);

/* Closes *runtime and sets it to null; a null handle is fine. Generators and engines made with it stay usable. Its log
 * callback is not called again after this call returns. Errors: INVALID_ARGUMENT.
 * [loader-thread] Blocks while ONNX Runtime lets go of its memory and while a call of the log is under way. */
HAPTOFLOW_API haptoflow_status haptoflow_runtime_close(haptoflow_runtime** runtime);

/* ------------------------------------------------------------------------------------------------- cancellations */

/* Ends loads that are under way: those whose options name it. One may serve any number of loads, also later ones. */
typedef struct haptoflow_cancellation haptoflow_cancellation;

/* Close it with haptoflow_cancellation_close. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_cancellation_create(haptoflow_cancellation** cancellation);

/* Loads with this cancellation end with HAPTOFLOW_CANCELLED, those under way at their next operator, graph or part of a
 * table; for good. ONNX Runtime before 1.22 finishes the graph that it is loading. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_cancellation_cancel(haptoflow_cancellation* cancellation);

/* Closes *cancellation and sets it to null; a null handle is fine. Loads that are under way go on.
 * Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_cancellation_close(haptoflow_cancellation** cancellation);

/* ------------------------------------------------------------------------------------------------------- models */

typedef struct haptoflow_model haptoflow_model;

/* Either bytes with byte_count, or path. */
typedef struct haptoflow_model_options {
    uint32_t struct_size;
    /* The bytes of a whole .haptoflow file; copied, not kept. */
    const void* bytes;
    uint64_t byte_count;
    const char* path;
} haptoflow_model_options;

typedef struct haptoflow_label_info {
    uint32_t struct_size;
    /* 1 for a woven or ruled surface, which has a wavelength; 0 otherwise. */
    uint32_t is_periodic;
    /* Lives until the model is closed; of a registered material, until that is replaced or the engine closed. */
    const char* name;
    const char* category;
    double stiffness_newtons_per_metre;
    double friction_coefficient;
    /* 0 unless the label is periodic. */
    double wavelength_metres;
    /* Beyond the trained range: level exponents of speed and force, and of the waveform's rate. */
    double speed_level_exponent;
    double force_level_exponent;
    double frequency_exponent;
} haptoflow_label_info;

typedef struct haptoflow_tier_info {
    uint32_t struct_size;
    /* The tier's own number of steps, 1 to 16. */
    int32_t steps;
    /* Each text lives until the model is closed. */
    const char* name;
    /* "flow", "average-velocity" or "direct". */
    const char* kind;
    /* Measured figures as JSON objects; "{}" where nothing was measured. */
    const char* accuracy_json;
    const char* cost_json;
    /* The tier's own solver. */
    haptoflow_solver solver;
    /* 1 for the tier that is used when nobody asks for one, 0 otherwise. */
    uint32_t is_default;
    /* Weights of the field graph. */
    int64_t parameter_count;
} haptoflow_tier_info;

/* Reads and verifies a model down to its last byte. Close it with haptoflow_model_close.
 * Errors: INVALID_ARGUMENT, MODEL_UNREADABLE, NOT_A_MODEL, MODEL_TRUNCATED, MODEL_TOO_NEW, MODEL_OVERSIZED,
 * MODEL_DAMAGED, MODEL_INCONSISTENT, OUT_OF_MEMORY.
 * [loader-thread] Blocks on disk when a path is given; takes milliseconds for each megabyte. */
HAPTOFLOW_API haptoflow_status haptoflow_model_open(const haptoflow_model_options* options, haptoflow_model** model);

/* Closes *model and sets it to null; a null handle is fine. Generators made from it stay usable; texts that it returned
 * do not. Errors: INVALID_ARGUMENT.
 * [loader-thread] Blocks while memory is freed. */
HAPTOFLOW_API haptoflow_status haptoflow_model_close(haptoflow_model** model);

/* The JSON header as the file has it (Documentation~/model-format.md). Lives until the model is closed.
 * Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_model_header(const haptoflow_model* model, const char** header_json);

/* Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_model_label_count(const haptoflow_model* model, uint32_t* count);

/* Fills info for the label at index, 0 to count - 1. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_model_label(const haptoflow_model* model, uint32_t index,
                                                     haptoflow_label_info* info);

/* Writes the material embedding of the label at index: HAPTOFLOW_EMBEDDING_SIZE numbers. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_model_embedding(const haptoflow_model* model, uint32_t index,
                                                         float* embedding);

/* *space becomes 8 hexadecimal digits that say which embeddings the model's networks understand: a material file of the
 * same space sounds under this model (Documentation~/own-materials.md). Lives until the model is closed.
 * Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_model_space(const haptoflow_model* model, const char** space);

/* Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_model_tier_count(const haptoflow_model* model, uint32_t* count);

/* Fills info for the tier at index, 0 to count - 1; the most accurate tier comes last. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_model_tier(const haptoflow_model* model, uint32_t index,
                                                    haptoflow_tier_info* info);

/* --------------------------------------------------------------------------------------------------- generators */

/* One tier of a model, ready to generate segments outside of real time: for rendering, measuring, previews. */
typedef struct haptoflow_generator haptoflow_generator;

typedef struct haptoflow_generator_options {
    uint32_t struct_size;
    /* HAPTOFLOW_SOLVER_OF_TIER, or a solver with `steps`. */
    haptoflow_solver solver;
    const haptoflow_runtime* runtime;
    const haptoflow_model* model;
    /* Name of the tier; null for the model's default. */
    const char* tier;
    /* 1 to 16; must be 0 with HAPTOFLOW_SOLVER_OF_TIER. */
    int32_t steps;
    /* Requests that one run of a graph takes, up to HAPTOFLOW_MAXIMUM_BATCH; 0 for 8. Longer batches go in parts. */
    uint32_t maximum_batch;
    /* Ends the creation early; null for none. */
    const haptoflow_cancellation* cancellation;
    /* What a probe run of each graph may take for each 8 requests of maximum_batch, above 0 to 3600000 ms; 0 for
     * 10000 ms. A single operator is always finished. */
    double probe_limit_ms;
} haptoflow_generator_options;

/* `count` requests, each array holding them one after the other. The arrays are read during the call only. */
typedef struct haptoflow_batch {
    uint32_t struct_size;
    uint32_t count;
    /* count * HAPTOFLOW_EMBEDDING_SIZE. */
    const float* embeddings;
    /* count * HAPTOFLOW_MOTION_SIZE: vx and vy in m/s along the surface, force in N, inside the trained range. */
    const float* motions;
    /* count * HAPTOFLOW_SEGMENT_SAMPLES: the samples before each segment in m/s^2. Not needed for levels. */
    const float* previous_mps2;
    /* count * HAPTOFLOW_SEGMENT_SAMPLES standard normal numbers. Not needed for levels. */
    const float* noise;
    /* count * HAPTOFLOW_RIB_COUNT: how far the tip has travelled along each of the embedding's wave vectors at the
     * segment's first sample, in turns from 0 to below 1; null for zeros. Not needed for levels. Only graphs with the
     * input "rib_phase" read it. */
    const float* rib_phases;
    /* count levels, RMS in m/s^2 above 0, used instead of the level graph's; null for the graph's. */
    const float* own_levels_mps2;
} haptoflow_batch;

/* Loads the tier's graphs into ONNX Runtime, checks and runs them. Close it with haptoflow_generator_close.
 * Errors: INVALID_ARGUMENT, MODEL_INCONSISTENT where a graph is not what the format says, TIER_TOO_SLOW, CANCELLED,
 * OUT_OF_MEMORY.
 * [loader-thread] Blocks while ONNX Runtime optimises the graphs. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_create(const haptoflow_generator_options* options,
                                                          haptoflow_generator** generator);

/* Closes *generator and sets it to null; a null handle is fine. A call that is under way on another thread finishes.
 * Errors: INVALID_ARGUMENT.
 * [loader-thread] Blocks while memory is freed. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_close(haptoflow_generator** generator);

/* Changes solver and steps (1 to 16) from the next batch on; HAPTOFLOW_SOLVER_OF_TIER with 0 steps goes back to the
 * tier's own. Tiers of kind "average-velocity" are always stepped by Euler, kind "direct" takes one evaluation.
 * Errors: INVALID_ARGUMENT.
 * [worker-thread] Blocks while another thread uses this generator. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_set_solver(haptoflow_generator* generator, haptoflow_solver solver,
                                                              int32_t steps);

/* Writes count * HAPTOFLOW_SEGMENT_SAMPLES samples in m/s^2 into segments_mps2. When it fails, what segments_mps2 holds
 * is unspecified: do not play it. Errors: INVALID_ARGUMENT, INFERENCE_FAILED, OUT_OF_MEMORY.
 * [worker-thread] Blocks while another thread uses this generator and for the runs themselves. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_generate(haptoflow_generator* generator,
                                                            const haptoflow_batch* batch, float* segments_mps2);

/* Writes the level that the model expects for each request into levels_mps2: count numbers, RMS in m/s^2. Reads
 * embeddings and motions only. When it fails, what levels_mps2 holds is unspecified.
 * Errors: INVALID_ARGUMENT, INFERENCE_FAILED, OUT_OF_MEMORY.
 * [worker-thread] Blocks while another thread uses this generator and for the runs themselves. */
HAPTOFLOW_API haptoflow_status haptoflow_generator_levels(haptoflow_generator* generator, const haptoflow_batch* batch,
                                                          float* levels_mps2);

/* ------------------------------------------------------------------------------------------------------- engines */

/* All voices of one model, and the one thread that generates for them. The thread sleeps while nothing slides. */
typedef struct haptoflow_engine haptoflow_engine;

typedef int32_t haptoflow_quality;
enum {
    /* Measures the model's tiers on this machine while nothing touches, takes the most accurate that fits the budget
     * (by the figures in the model's header), a faster one when the machine cannot keep up, and a more accurate one
     * when it can again. */
    HAPTOFLOW_QUALITY_AUTO = 0,
    /* The tier "draft", or the model's first tier if it has no such tier. */
    HAPTOFLOW_QUALITY_DRAFT = 1,
    /* The tier "standard", or the model's default tier if it has no such tier. */
    HAPTOFLOW_QUALITY_STANDARD = 2,
    /* The tier "fine", or the model's most accurate tier if it has no such tier. */
    HAPTOFLOW_QUALITY_FINE = 3
};

typedef struct haptoflow_engine_options {
    uint32_t struct_size;
    /* Only the tier of this quality is loaded. HAPTOFLOW_QUALITY_AUTO loads every tier of the model. */
    haptoflow_quality quality;
    const haptoflow_runtime* runtime;
    const haptoflow_model* model;
    /* Contact states a second, 1 to 10000; 0 for 72. Sets the budget and the pace of measuring, nothing else. */
    double update_rate_hz;
    /* Share of the time between two contact states that inference may take, above 0 to 1; 0 for 0.25. */
    double budget_share;
    /* What acceleration is +-1 in the output, 0.001 to 1000000; 0 for HAPTOFLOW_DEFAULT_FULL_SCALE_MPS2. A soft knee
     * begins at 0.7 of it. */
    double full_scale_mps2;
    /* Key of all noise. */
    uint64_t seed;
    /* Voices that one run of a graph takes, 1 to 64; 0 for 8. More voices are served in several runs. */
    uint32_t batch_voices;
    /* 1 for an engine without a thread of its own: the caller calls haptoflow_engine_step. 0 otherwise. */
    uint32_t without_worker;
    /* From a contact state to the first sample generated from it, above 0 to 50 ms; 0 for the shortest that the engine
     * finds to hold on this machine. Fixed, an engine without worker is deterministic. */
    double fixed_lead_ms;
    /* Ends the creation early; null for none. Read by haptoflow_engine_create only. */
    const haptoflow_cancellation* cancellation;
    /* What a probe run of each graph may take for each 8 voices of batch_voices, above 0 to 3600000 ms; 0 for 10000 ms.
     * A single operator is always finished. */
    double probe_limit_ms;
} haptoflow_engine_options;

/* Times of the tier at an index of the model (haptoflow_model_tier), for one voice's segment on this machine. */
typedef struct haptoflow_tier_times {
    uint32_t struct_size;
    /* 1 for the tier that generates at present, 0 otherwise. */
    uint32_t is_current;
    /* Runs behind the figures; 0 where the tier was not loaded, or neither used nor measured. At most the last 128
     * count. */
    uint64_t runs;
    double median_ms;
    double percentile_99_ms;
} haptoflow_tier_times;

typedef struct haptoflow_engine_statistics {
    uint32_t struct_size;
    /* Index of the tier that generates at present. */
    uint32_t tier;
    uint32_t voices;
    /* 1 while automatic quality still measures, 0 otherwise. */
    uint32_t is_measuring;
    /* Rounds of inference, segments in them, rounds in which a graph failed. */
    uint64_t rounds;
    uint64_t segments;
    uint64_t failed_rounds;
    /* How often the worker was woken, for whatever reason. */
    uint64_t wakes;
    /* How often automatic quality went to a cheaper, and to a more accurate tier. */
    uint64_t quality_steps_down;
    uint64_t quality_steps_up;
    /* What a round may take, and what the last one took, all its voices together. */
    double budget_ms;
    double last_round_ms;
    /* 0 once the worker has ended, also for an engine that is being closed; 1 otherwise and without worker. */
    uint32_t worker_is_alive;
    /* 1 where the system did not let the worker run at a raised priority; 0 otherwise. */
    uint32_t priority_was_refused;
} haptoflow_engine_statistics;

/* Loads the tiers that the quality asks for and starts the worker. Close it with haptoflow_engine_close.
 * Errors: INVALID_ARGUMENT, MODEL_INCONSISTENT, INFERENCE_FAILED, TIER_TOO_SLOW, CANCELLED, OUT_OF_MEMORY.
 * [loader-thread] Blocks while ONNX Runtime optimises the graphs, and for the levels of all labels. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_create(const haptoflow_engine_options* options,
                                                       haptoflow_engine** engine);

/* Ends the worker, destroys the engine's voices as haptoflow_voice_destroy does and sets *engine to null; a null handle
 * is fine. Errors: INVALID_ARGUMENT.
 * [loader-thread] Blocks for the present round of inference, the present blocks and, while voices sound, their fade. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_close(haptoflow_engine** engine);

/* From the next segment on. Tiers that this quality asks for and that are not loaded yet are loaded first, by the
 * calling thread, while the engine goes on with its present one; they stay loaded. Where that fails, the quality stays
 * as it was. Errors: INVALID_ARGUMENT, MODEL_INCONSISTENT, TIER_TOO_SLOW, OUT_OF_MEMORY. [loader-thread] Blocks while
 * ONNX Runtime optimises the graphs of such a tier; takes microseconds where all are loaded. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_set_quality(haptoflow_engine* engine, haptoflow_quality quality);

/* Materials that one engine can hold beside its model's labels. */
#define HAPTOFLOW_MAXIMUM_MATERIALS 64

/* Registers a material: json is the text of a material file (Documentation~/own-materials.md), length bytes of it. From
 * then on contact states may name it by *index, which is the number of the model's labels and of the materials
 * registered before. It stays until the engine is closed. No other label sounds different for it. Errors:
 * INVALID_ARGUMENT (also where HAPTOFLOW_MAXIMUM_MATERIALS are registered), MATERIAL_INVALID (the message names the
 * key), MATERIAL_MISMATCH, OUT_OF_MEMORY; MODEL_INCONSISTENT, INFERENCE_FAILED and TIER_TOO_SLOW where the material has
 * no level of its own and the model's level graph fails. [loader-thread] Publishers, worker and callbacks never wait
 * for it. Takes milliseconds; the first material without a level of its own also loads the model's level graph. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_register_material(haptoflow_engine* engine, const char* json,
                                                                  uint64_t length, uint32_t* index);

/* Puts another material in the place of the registered one at index: the next state that is published sounds like it.
 * What was there before is freed. Where this fails, it stays as it was. Errors: as above.
 * [loader-thread] Publishers, worker and callbacks never wait for it; it waits the microseconds that publishers who are
 * at work still take. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_replace_material(haptoflow_engine* engine, uint32_t index,
                                                                 const char* json, uint64_t length);

/* How many materials are registered, the model's labels not counted. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_material_count(const haptoflow_engine* engine, uint32_t* count);

/* Fills info for the registered material at index, by which contact states name it. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle, or registers a material. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_material(const haptoflow_engine* engine, uint32_t index,
                                                         haptoflow_label_info* info);

/* One round of inference for all voices that want one. Engines without worker only. Errors: INVALID_ARGUMENT.
 * [worker-thread] */
HAPTOFLOW_API haptoflow_status haptoflow_engine_step(haptoflow_engine* engine);

/* Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle, never for inference. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_get_statistics(const haptoflow_engine* engine,
                                                               haptoflow_engine_statistics* statistics);

/* Figures of the tier at index, in the model's order. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle, never for inference. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_tier_times(const haptoflow_engine* engine, uint32_t index,
                                                           haptoflow_tier_times* times);

/* Writes the text of the newest failure, of a round of inference or of the worker itself, into text: at most capacity
 * bytes, the zero byte at the end included; "" before the first failure. *length becomes the whole text's length
 * without that byte. text may be null where capacity is 0. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. [any-thread] Blocks
 * for as long as another thread opens or closes a handle, or the worker notes a failure. */
HAPTOFLOW_API haptoflow_status haptoflow_engine_last_failure(const haptoflow_engine* engine, char* text,
                                                             uint64_t capacity, uint64_t* length);

/* -------------------------------------------------------------------------------------------------------- voices */

/* The signal of one stylus tip. A number, never used twice; 0 is none. At most HAPTOFLOW_MAXIMUM_VOICES at a time, all
 * engines of the process together. */
typedef uint64_t haptoflow_voice;

#define HAPTOFLOW_MAXIMUM_VOICES 64
#define HAPTOFLOW_MAXIMUM_BLEND 4
/* As a channel: all of them. */
#define HAPTOFLOW_ALL_CHANNELS (-1)

/* What a voice's signal can go through, in this order but for the last two. A scene pays only for what it asks for. */
typedef int32_t haptoflow_effect;
enum {
    /* What the network generates while the tip slides. */
    HAPTOFLOW_EFFECT_TEXTURE = 0,
    /* The blow of a landing: decaying sinusoids of the label, as loud as the approach was fast. */
    HAPTOFLOW_EFFECT_IMPACT = 1,
    /* The crossing of a rim, or to a label of another level. */
    HAPTOFLOW_EFFECT_EDGE = 2,
    HAPTOFLOW_EFFECT_DELAY = 3,
    HAPTOFLOW_EFFECT_COMPENSATION = 4,
    HAPTOFLOW_EFFECT_EXPOSURE_GUARD = 5,
    /* What a material, or a surface's tone_db_per_octave, does to the texture's spectrum; right behind the texture. */
    HAPTOFLOW_EFFECT_TONE = 6,
    /* A study's sine, which sounds instead of texture, impact and edge: haptoflow_voice_set_signal. */
    HAPTOFLOW_EFFECT_SIGNAL = 7
};

#define HAPTOFLOW_EFFECT_COUNT 8
/* Sets of effects: one bit each, and one for none of them. */
#define HAPTOFLOW_ASKS_FOR_TEXTURE 0x1u
#define HAPTOFLOW_ASKS_FOR_IMPACT 0x2u
#define HAPTOFLOW_ASKS_FOR_EDGE 0x4u
#define HAPTOFLOW_ASKS_FOR_NOTHING 0x80000000u

typedef struct haptoflow_contact_state {
    uint32_t struct_size;
    /* 1 while the tip touches a surface, 0 otherwise. */
    uint32_t touching;
    /* One more at each touch-down: a touch that came and went since the last state is still felt. */
    uint32_t touch_counter;
    /* Entries used of labels and weights, 0 to HAPTOFLOW_MAXIMUM_BLEND. */
    uint32_t label_count;
    /* Indices into the model's labels, and of registered materials; unknown ones are left out. A blend of none is the
     * model's first label. */
    uint32_t labels[HAPTOFLOW_MAXIMUM_BLEND];
    /* 0 to 1 each; they need not sum to one. */
    float weights[HAPTOFLOW_MAXIMUM_BLEND];
    /* Along two axes fixed to the surface, relative to its own motion. Limited to 20 m/s each. */
    float velocity_mps[2];
    /* Along the surface's normal, 0 to 1000 N. */
    float force_newtons;
    /* Into the surface, at the newest landing. */
    float approach_speed_mps;
    /* What the surface asks for: HAPTOFLOW_ASKS_FOR_TEXTURE, _IMPACT and _EDGE together; 0 for the texture alone. */
    uint32_t effects;
    /* One more at each rim that the tip crosses or slides off, and how high the newest one is, 0 to 1 m. A change of
     * label needs no count: the voice sees it. */
    uint32_t edge_counter;
    float edge_height_metres;
    /* One more at each landing on another surface, or on another face of the same, while the tip goes on touching. A
     * touch-down is a landing that needs no count. */
    uint32_t landing_counter;
    /* How many times as large the surface's features are as the material's: at 2, ribs are twice as far apart, and all
     * frequencies are those of half the speed; the level stays. 0 for 1; else limited to 0.25 to 4. */
    float spatial_scale;
    /* Brighter above 0, darker below: a tilt of the spectrum about 150 Hz, -12 to 12 dB an octave; 0 for none. Comes on
     * top of the material's own tone. */
    float tone_db_per_octave;
} haptoflow_contact_state;

/* What one effect has done for a voice. Of an effect that nobody asks for, everything is 0. */
typedef struct haptoflow_effect_statistics {
    uint32_t struct_size;
    /* 1 while the voice asks for it: of impact, edge and tone, its newest contact state. */
    uint32_t is_asked_for;
    /* How often it was made ready, blocks that it ran for, samples in them (of texture and tone at 2 kHz, of the others
     * at the output's rate), and what they took in all. */
    uint64_t prepared;
    uint64_t runs;
    uint64_t samples;
    double microseconds;
    /* Blows, of impact and edge; how often it began to sound, of the signal. */
    uint64_t events;
} haptoflow_effect_statistics;

typedef struct haptoflow_voice_statistics {
    uint32_t struct_size;
    /* Waveform samples by which a new segment leads what sounds; 2 samples are 1 ms. */
    uint32_t lead_samples;
    /* Contact states published; segments generated; states for which nothing was generated. */
    uint64_t updates;
    uint64_t inferences;
    uint64_t skipped;
    /* Touches that began to sound, resumptions not counted, and those of them that were over within one block. */
    uint64_t onsets;
    uint64_t taps;
    /* Blocks that wanted samples which no segment covered; segments that came late; that came for nothing. */
    uint64_t underruns;
    uint64_t late;
    uint64_t dropped;
    /* Runs that failed. */
    uint64_t failures;
    /* Fields of contact states that were not finite or out of range, and were made so. */
    uint64_t sanitised;
    /* Touches silenced because no contact state came for 100 ms. */
    uint64_t stale_stops;
    /* Samples that were not finite (and became 0), and samples bent by the limiter. */
    uint64_t non_finite_samples;
    uint64_t limited_samples;
    /* Frames rendered; changes of the output's sample rate; calls refused because another thread was inside, and blocks
     * refused because another mixer effect plays this voice. */
    uint64_t rendered_frames;
    uint64_t rate_changes;
    uint64_t refused_calls;
    /* Milliseconds that this voice's inferences took in all; voices that share a run share its time. */
    double inference_ms;
    /* How often a touch sounded again after a silence within it: a pause, a mute, a rate change, missing states. */
    uint64_t resumptions;
    /* Blocks asked for at a sample rate outside 8 to 192 kHz: all of them are silent. */
    uint64_t unsupported_rate_blocks;
    /* The sample rate of the newest block; 0 before the first. */
    double device_rate_hz;
    /* Why the newest block is silent; HAPTOFLOW_SILENCE_NONE where it sounds. */
    haptoflow_silence silence;
    /* 0 while the newest block's rate is outside 8 to 192 kHz, 1 otherwise. */
    uint32_t is_rate_supported;
} haptoflow_voice_statistics;

/* sample_rate_hz is the output's, 8000 to 192000; 0 for 48000. It may change later: see haptoflow_voice_render.
 * Errors: INVALID_ARGUMENT (also when there are too many voices), OUT_OF_MEMORY.
 * [loader-thread] Blocks while another voice is opened or destroyed, never for inference. */
HAPTOFLOW_API haptoflow_status haptoflow_voice_create(haptoflow_engine* engine, double sample_rate_hz,
                                                      haptoflow_voice* voice);

/* Fades the voice, destroys it and sets *voice to 0; 0 is fine. Errors: INVALID_ARGUMENT.
 * [loader-thread] Blocks for calls on this voice that are under way and, while the voice sounds, for the block that
 * fades it, at most 48 ms; never for inference. */
HAPTOFLOW_API haptoflow_status haptoflow_voice_destroy(haptoflow_voice* voice);

/* What the tip does now: once a frame, also while nothing touches. A touch sounds with the next block; a touch without
 * news for 100 ms of output falls silent. Values that are not finite or out of range are made so and counted.
 * Errors: INVALID_ARGUMENT, BUSY.
 * [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_publish(haptoflow_voice voice, const haptoflow_contact_state* state);

/* Writes frame_count frames of the voice into one channel of interleaved samples, or into all with
 * HAPTOFLOW_ALL_CHANNELS; other channels stay as they are. Samples are +-1. channel_count is 1 to 64.
 * Where sample_rate_hz is not what it was, the voice fades within 5 ms, is silent until the worker has prepared for the
 * new rate, and a touch that still goes on sounds again, as its newest state asks. At a rate outside 8 to 192 kHz it
 * stays silent, and the voice's statistics say so. A voice that is not open, or busy, writes zeros. Errors:
 * INVALID_ARGUMENT, BUSY; the message is not set by this function. [audio-callback] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_render(haptoflow_voice voice, float* interleaved, uint32_t frame_count,
                                                      uint32_t channel_count, int32_t channel, double sample_rate_hz);

/* Gain of the output before the limiter, 0 to 1; glides within 10 ms while the voice sounds. Set while it is silent, it
 * holds from the first sample of the next touch. Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_strength(haptoflow_voice voice, float strength);

/* Largest magnitude of the output, 0 to 1: whatever else happens, no sample is above it. The limiter's curve bends from
 * 0.7 of the ceiling on and approaches it without a corner. Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_ceiling(haptoflow_voice voice, float ceiling);

/* Muted (1) a voice falls silent within a block and 5 ms and costs no inference. Errors: INVALID_ARGUMENT. [publisher]
 */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_muted(haptoflow_voice voice, uint32_t muted);

/* The same for an application that is suspended: independent of muting. Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_paused(haptoflow_voice voice, uint32_t paused);

/* Silence at the end of the next block, whatever its length, for the touch that was published last. The next touch-down
 * sounds again: another touch_counter, or touching after a state that did not touch, published after this call.
 * Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_panic(haptoflow_voice voice);

/* Panic for every voice of the process. Never fails. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_panic(void);

/* Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_get_statistics(haptoflow_voice voice,
                                                              haptoflow_voice_statistics* statistics);

/* Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_effect_statistics(haptoflow_voice voice, haptoflow_effect effect,
                                                                 haptoflow_effect_statistics* statistics);

/* Everything comes this much later, for studies and slow displays; 0 to 0.5 s, 0 for no delay. A change fades within
 * 20 ms. A lift-off closes the texture before the delay; mute, pause and panic act behind it, at once.
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_delay(haptoflow_voice voice, double seconds);

/* A sine for studies of latency: while it is set, the voice plays it wherever the newest contact state touches and
 * moves at 5 mm/s or more along the surface, whatever force and speed are, and nothing else: no texture, no impact, no
 * edge, no inference. It begins and ends within 2 ms on a raised cosine, at phase 0 out of silence, and its phase goes
 * on while it sounds, also where the frequency changes. Strength, delay, compensation, exposure guard, mute, pause,
 * panic and missing states act on it as on everything.
 * frequency_hz: 20 to 500; it is ignored if the amplitude is 0. amplitude_mps2: the peak amplitude, 0 to 60. An
 * amplitude of 0 switches the signal off, and the texture sounds again with the next state. Both values take effect
 * with the next block; a change of amplitude takes 10 ms. Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_signal(haptoflow_voice voice, double frequency_hz,
                                                          double amplitude_mps2);

/* How often contact states have started and stopped the signal, and the latency of these changes. The latency runs from
 * haptoflow_voice_publish of the first state that asks for the change to the start of the block in which the change
 * begins. It includes the voice's delay, but not the delay of compensation and device. Changes that mute, pause, panic,
 * missing states or set_signal cause are not counted. All values are zero before the first change. */
typedef struct haptoflow_signal_statistics {
    uint32_t struct_size;
    uint64_t starts;
    uint64_t stops;
    double last_start_latency_seconds;
    double last_stop_latency_seconds;
    /* Of all that were counted. */
    double mean_start_latency_seconds;
    double mean_stop_latency_seconds;
} haptoflow_signal_statistics;

/* Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_signal_statistics(haptoflow_voice voice,
                                                                 haptoflow_signal_statistics* statistics);

/* What plays the voice, so that its resonances and weak bands are evened out: an actuator profile as JSON, length bytes
 * of it, or the name of one that the library brings along ("flat", "voice-coil"); null for no compensation. Prepared by
 * the worker for the output's rate; the hand-over takes 10 ms.
 * Errors: INVALID_ARGUMENT (the message names the key), OUT_OF_MEMORY. [loader-thread] Reads the profile. */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_actuator(haptoflow_voice voice, const char* profile,
                                                            uint64_t length);

/* is_on: 1 switches the exposure guard on, which slowly lowers a level that stays high for too long, but never to
 * silence; 0 switches it off. actuator_gain: acceleration at the hand for each m/s^2 of the voice, above 0 to 1000; 0
 * for 1. Documentation~/effects-and-outputs.md gives the law. The guard is no medical device.
 * Errors: INVALID_ARGUMENT, OUT_OF_MEMORY. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_set_exposure_guard(haptoflow_voice voice, uint32_t is_on,
                                                                  float actuator_gain);

/* Why the exposure guard lowers a voice. */
typedef int32_t haptoflow_exposure_reason;
enum {
    HAPTOFLOW_EXPOSURE_NONE = 0,
    /* Minutes at a high level. */
    HAPTOFLOW_EXPOSURE_SHORT_TERM = 1,
    /* The day's dose, weighted as ISO 5349-1 does. */
    HAPTOFLOW_EXPOSURE_DOSE = 2
};

/* What the exposure guard has measured, as the newest block left it; all zero, and a gain of 1, without one. */
typedef struct haptoflow_exposure {
    uint32_t struct_size;
    haptoflow_exposure_reason reason;
    /* What the voice is multiplied by. */
    double gain;
    /* The equivalent level of the last minutes without the guard, and the daily exposure A(8) that reached the hand,
     * m/s^2; for how long the level has been lowered. */
    double short_term_mps2;
    double daily_mps2;
    double lowered_seconds;
} haptoflow_exposure;

/* Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_exposure(haptoflow_voice voice, haptoflow_exposure* exposure);

/* The voice's place among the process's voices, 0 to HAPTOFLOW_MAXIMUM_VOICES - 1: what the parameter "Voice" of
 * Unity's mixer effect names. Places are used again. Errors: INVALID_ARGUMENT. [publisher] */
HAPTOFLOW_API haptoflow_status haptoflow_voice_place(haptoflow_voice voice, uint32_t* place);

/* ------------------------------------------------------------------------------------------------ wave features */

/* What a motor or a device with one carrier has to do to feel like a wave, frame by frame, after Intensity Segment
 * Modulation: each frame is as intense to the hand as the wave was. */
typedef struct haptoflow_wave_features haptoflow_wave_features;

typedef struct haptoflow_wave_features_options {
    uint32_t struct_size;
    /* Of the wave: a multiple of 2000 up to 192000; 0 for 2000. Above 2000 a low-pass delays all by 1.5 ms. */
    uint32_t sample_rate_hz;
    /* 0.002 to 0.032; 0 for 0.005. Need not be a whole number of samples. */
    double frame_seconds;
    /* What the device can play, above 0 to 1000; 0 for 60 and 400. Both the same for a motor of one frequency. */
    double minimum_frequency_hz;
    double maximum_frequency_hz;
} haptoflow_wave_features_options;

/* One frame. This struct has no struct_size and will not change. */
typedef struct haptoflow_wave_frame {
    /* In samples of 2000 a second since the features were made or reset, the low-pass's delay included. */
    uint64_t first_sample;
    uint32_t sample_count;
    /* How strong it feels: 1 is just felt. */
    float intensity;
    /* Where its energy is, as the hand weighs it; the last place that was felt while the wave is silent. */
    float centroid_hz;
    /* The carrier: the centroid, limited to the device's range, and the amplitude (peak, m/s^2) that feels as strong
     * at that frequency. */
    float frequency_hz;
    float amplitude_mps2;
    /* The onset of a tap or an edge: seconds from the start of the frame, and the carrier as intense as its peak;
     * amplitude 0 for none. */
    float transient_offset_seconds;
    float transient_amplitude_mps2;
    float transient_frequency_hz;
} haptoflow_wave_frame;

/* Close it with haptoflow_wave_features_close. Errors: INVALID_ARGUMENT, OUT_OF_MEMORY.
 * [any-thread] Blocks for as long as another thread opens or closes a handle; allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_create(const haptoflow_wave_features_options* options,
                                                              haptoflow_wave_features** features);

/* Closes *features and sets it to null; a null handle is fine. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_close(haptoflow_wave_features** features);

/* Forgets the wave; the next sample is the first. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks while another thread uses these features. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_reset(haptoflow_wave_features* features);

/* What the device can play from the next frame on, above 0 to 1000 Hz each. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks while another thread uses these features. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_set_range(haptoflow_wave_features* features,
                                                                 double minimum_frequency_hz,
                                                                 double maximum_frequency_hz);

/* Takes the next sample_count samples of the wave, in m/s^2, and writes the frames that they complete; *frame_count
 * receives the number of frames. A frame is complete 4 ms after its end. A capacity of
 * sample_count / (rate * frame_seconds) + 1 frames is always enough; frames beyond capacity are lost. Samples that are
 * not finite count as 0. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks while another thread uses these features; takes about 2 us for each ms of wave. */
HAPTOFLOW_API haptoflow_status haptoflow_wave_features_process(haptoflow_wave_features* features,
                                                               const float* wave_mps2, uint64_t sample_count,
                                                               haptoflow_wave_frame* frames, uint64_t capacity,
                                                               uint64_t* frame_count);

/* -------------------------------------------------------------------------------------------------------- noise */

/* Fills noise with count standard normal numbers that depend on seed, voice and segment alone and are the same bytes on
 * every platform. count is at most 2^32. Errors: INVALID_ARGUMENT.
 * [any-thread] Never blocks; allocates only to report an error. */
HAPTOFLOW_API haptoflow_status haptoflow_noise_fill(uint64_t seed, uint32_t voice, uint64_t segment, float* noise,
                                                    uint64_t count);

/* ----------------------------------------------------------------------------------------------------- learning */

/* Makes a material of a recording of one surface: at least 10 s of sliding, from slow to fast, in the directions that
 * matter. What comes of it is the text of a material file for haptoflow_engine_register_material. */
typedef struct haptoflow_learning haptoflow_learning;

/* Told the share that is done, 0 to 1, and what is being done; the text lives during the call. Called on the thread
 * that learns, some times a second; it must return. */
typedef void (*haptoflow_progress_callback)(void* context, double share, const char* doing);

typedef struct haptoflow_learning_options {
    uint32_t struct_size;
    /* Of the acceleration: 1 or 3, interleaved. */
    uint32_t axis_count;
    const haptoflow_runtime* runtime;
    /* The material will sound under this model and others of its space. */
    const haptoflow_model* model;
    /* Null for the model's default. */
    const char* tier;
    /* The material's name, as a label's: lower case, 1 to 128 bytes. */
    const char* name;
    /* Null or empty: category, that of the nearest label; description, none; licence, "unknown". */
    const char* category;
    const char* description;
    const char* licence;
    /* sample_count * axis_count numbers in m/s^2, with gravity or without. A sample that is not finite costs its
     * neighbourhood. The first 300 s are read. */
    const float* acceleration_mps2;
    uint64_t sample_count;
    /* 1000 to 192000. */
    double sample_rate_hz;
    /* vx, vy for each sample, or null for constant_velocity_mps. */
    const float* velocity_mps;
    double constant_velocity_mps[2];
    /* One for each sample, or null for constant_force_newtons. */
    const float* force_newtons;
    double constant_force_newtons;
    /* Equal options give equal bytes, unless seconds_limit ends the fit. */
    uint64_t seed;
    /* Seconds of the calling thread's work after which the fit ends with what it has; 0 for 20. A fit takes about 8. */
    double seconds_limit;
    /* Null for nobody. */
    haptoflow_progress_callback progress;
    void* progress_context;
    /* Null for one that nobody cancels. */
    const haptoflow_cancellation* cancellation;
    /* k1x, k1y, k2x, k2y in cycles per millimetre along the recording's axes, zeros for a surface without ribs; null to
     * find them in the recording. */
    const float* wave_vectors;
} haptoflow_learning_options;

/* Learns, and returns when it is done; *learning is closed with haptoflow_learning_close. Errors: INVALID_ARGUMENT,
 * RECORDING_UNUSABLE (too short, silent, clipped, not finite, no motion, a speed, force or level that no hand makes:
 * the message says which), CANCELLED, MODEL_INCONSISTENT, INFERENCE_FAILED, TIER_TOO_SLOW, OUT_OF_MEMORY.
 * [loader-thread] Blocks for seconds; allocates. */
HAPTOFLOW_API haptoflow_status haptoflow_learn_material(const haptoflow_learning_options* options,
                                                        haptoflow_learning** learning);

/* *json becomes the text of the material file. Lives until the learning is closed. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_learning_material(const haptoflow_learning* learning, const char** json);

/* *json becomes a JSON object with what was learnt in figures: nearest_label, nearest_distance_db, fitted_distance_db,
 * spectral_distance_db, level_error_db, sliding_seconds, speed_mps, force_newtons, level_exponents, wave_vectors,
 * turn_degrees (from the recording's first axis to the material's, which lies across its clearest ribs), seeds,
 * segments, seconds, stopped_early, warnings and more. Lives until the learning is closed. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_learning_report(const haptoflow_learning* learning, const char** json);

/* Closes *learning and sets it to null; a null handle is fine. Errors: INVALID_ARGUMENT.
 * [any-thread] Blocks for as long as another thread opens or closes a handle. */
HAPTOFLOW_API haptoflow_status haptoflow_learning_close(haptoflow_learning** learning);

#ifdef __cplusplus
}
#endif

#endif
