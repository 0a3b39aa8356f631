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
 *   know (a newer caller) are ignored. Structs filled by the library are filled up to the caller's struct_size.
 * - Handles are opaque and never used twice: a call with a handle that was closed, or with anything else that is not an
 *   open handle of that kind, returns HAPTOFLOW_INVALID_ARGUMENT. An open handle keeps alive what it was made from.
 * - Text is UTF-8 and ends with a zero byte. Text that the library returns belongs to the library.
 * - Units are in the names: m/s^2 (mps2), m/s (mps), newtons. Waveforms run at 2000 samples per second.
 * - No C++ exception leaves the library.
 *
 * Thread tags, one on every function
 *
 * [any-thread]     May be called from any thread, at any time, also at the same time as other calls.
 * [loader-thread]  May be called from any thread that can wait: it reads files, allocates memory, or builds networks.
 *                  Never call it from an audio callback, and from a main thread only while something loads.
 * [worker-thread]  May be called from any thread that can wait for a network: it allocates inside ONNX Runtime and
 *                  takes up to milliseconds. Never call it from an audio callback. Calls on one generator queue up.
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

/* Samples of a segment and of the previous waveform; numbers of a material embedding and of a motion. */
#define HAPTOFLOW_SEGMENT_SAMPLES 200
#define HAPTOFLOW_EMBEDDING_SIZE 64
#define HAPTOFLOW_MOTION_SIZE 3
#define HAPTOFLOW_MAXIMUM_BATCH 256

typedef int32_t haptoflow_status;
enum {
    HAPTOFLOW_OK = 0,
    /* A null pointer, a handle that is not open, an index or a number out of range, a name that is not there. */
    HAPTOFLOW_INVALID_ARGUMENT = 1,
    HAPTOFLOW_OUT_OF_MEMORY = 2,
    /* A defect of this library. */
    HAPTOFLOW_INTERNAL_ERROR = 3,
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
    /* No ONNX Runtime of version 1.16 or newer at the given place. */
    HAPTOFLOW_RUNTIME_UNAVAILABLE = 20,
    /* A graph failed while running, or returned numbers that are not finite. */
    HAPTOFLOW_INFERENCE_FAILED = 21
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

/* What was wrong in the last call on this thread that failed; "" before the first. Stays valid until the next call on
 * this thread that fails, and at most as long as the thread. Never fails.
 * [any-thread] Never blocks. */
HAPTOFLOW_API const char* haptoflow_last_message(void);

/* ------------------------------------------------------------------------------------------------- ONNX Runtime */

typedef struct haptoflow_runtime haptoflow_runtime;

/* Exactly one of the two pointers must be set. */
typedef struct haptoflow_runtime_options {
    uint32_t struct_size;
    /* What OrtGetApiBase() of a loaded ONNX Runtime returned (const OrtApiBase*). That library must stay loaded. */
    const void* ort_api_base;
    /* Or the file of an ONNX Runtime library, which then stays loaded until the process ends. */
    const char* library_path;
} haptoflow_runtime_options;

/* Makes ONNX Runtime available; one for the whole process is enough. Close it with haptoflow_runtime_close.
 * Errors: INVALID_ARGUMENT, RUNTIME_UNAVAILABLE, OUT_OF_MEMORY.
 * [loader-thread] Blocks on disk while the library loads. */
HAPTOFLOW_API haptoflow_status haptoflow_runtime_open(const haptoflow_runtime_options* options,
                                                      haptoflow_runtime** runtime);

/* Closes *runtime and sets it to null; a null handle is fine. Generators made with it stay usable.
 * Errors: INVALID_ARGUMENT.
 * [loader-thread] Blocks while ONNX Runtime lets go of its memory. */
HAPTOFLOW_API haptoflow_status haptoflow_runtime_close(haptoflow_runtime** runtime);

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
    /* Lives until the model is closed. */
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
} haptoflow_batch;

/* Loads the tier's graphs into ONNX Runtime, checks and runs them once. Close it with haptoflow_generator_close.
 * Errors: INVALID_ARGUMENT, MODEL_INCONSISTENT where a graph is not what the format says, OUT_OF_MEMORY.
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

/* -------------------------------------------------------------------------------------------------------- noise */

/* Fills noise with count standard normal numbers that depend on seed, voice and segment alone and are the same bytes on
 * every platform. count is at most 2^32. Errors: INVALID_ARGUMENT.
 * [any-thread] Never blocks; allocates only to report an error. */
HAPTOFLOW_API haptoflow_status haptoflow_noise_fill(uint64_t seed, uint32_t voice, uint64_t segment, float* noise,
                                                    uint64_t count);

#ifdef __cplusplus
}
#endif

#endif
