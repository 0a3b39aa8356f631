/* Opens the plugin as Unity does, by its file, slides over the model's first label for half a second with the worker's
 * thread, and prints the level. scripts/lib/old_glibc.mjs compiles and runs it in a Debian 11, whose glibc is 2.31, and
 * scripts/lib/committed_touch.mjs for Windows and arm64. */
#define _GNU_SOURCE
#include <haptoflow/haptoflow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { sampleRateHz = 48000, blockFrames = 256, blocks = 94 };

#ifdef _WIN32
#include <windows.h>

static void printSystem(void) {
    printf("Windows");
}

static void* openLibrary(const char* file) {
    void* const library = LoadLibraryA(file);
    if (library == NULL) {
        fprintf(stderr, "%s: error %lu\n", file, GetLastError());
    }
    return library;
}

static void* findSymbol(void* library, const char* name) {
    return (void*)GetProcAddress(library, name);
}

static void waitForBlock(void) {
    Sleep(1000 * blockFrames / sampleRateHz);
}
#else
#include <dlfcn.h>
#include <gnu/libc-version.h>
#include <time.h>

static void printSystem(void) {
    printf("glibc %s", gnu_get_libc_version());
}

static void* openLibrary(const char* file) {
    void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
    }
    return library;
}

static void* findSymbol(void* library, const char* name) {
    return dlsym(library, name);
}

static void waitForBlock(void) {
    const struct timespec block = {.tv_nsec = 1000000000L * blockFrames / sampleRateHz};
    nanosleep(&block, NULL);
}
#endif

/* A pointer to a function of the header, by its name. */
#define TAKE(name)                                             \
    __typeof__(&name) call_##name;                             \
    *(void**)(&call_##name) = findSymbol(library, #name);      \
    if (call_##name == NULL) {                                 \
        fprintf(stderr, "%s: is not in the library\n", #name); \
        return 1;                                              \
    }

#define EXPECT_OK(call)                                                    \
    if ((call) != HAPTOFLOW_OK) {                                          \
        fprintf(stderr, "%s: %s\n", #call, call_haptoflow_last_message()); \
        return 1;                                                          \
    }

int main(int argc, char** argv) {
    haptoflow_runtime_options runtimeOptions = {.struct_size = sizeof runtimeOptions};
    haptoflow_model_options modelOptions = {.struct_size = sizeof modelOptions};
    haptoflow_engine_options engineOptions = {.struct_size = sizeof engineOptions};
    haptoflow_contact_state state = {.struct_size = sizeof state};
    haptoflow_runtime* runtime = NULL;
    haptoflow_model* model = NULL;
    haptoflow_engine* engine = NULL;
    haptoflow_voice voice = 0;
    double sum = 0.0;

    if (argc != 4) {
        fprintf(stderr, "usage: touch LIBRARY ONNXRUNTIME_LIBRARY MODEL\n");
        return 2;
    }
    void* const library = openLibrary(argv[1]);
    if (library == NULL) {
        return 1;
    }
    TAKE(haptoflow_last_message)
    TAKE(haptoflow_version)
    TAKE(haptoflow_runtime_open)
    TAKE(haptoflow_runtime_close)
    TAKE(haptoflow_model_open)
    TAKE(haptoflow_model_close)
    TAKE(haptoflow_engine_create)
    TAKE(haptoflow_engine_close)
    TAKE(haptoflow_voice_create)
    TAKE(haptoflow_voice_destroy)
    TAKE(haptoflow_voice_publish)
    TAKE(haptoflow_voice_render)

    runtimeOptions.library_path = argv[2];
    modelOptions.path = argv[3];
    EXPECT_OK(call_haptoflow_runtime_open(&runtimeOptions, &runtime))
    EXPECT_OK(call_haptoflow_model_open(&modelOptions, &model))
    engineOptions.runtime = runtime;
    engineOptions.model = model;
    engineOptions.quality = HAPTOFLOW_QUALITY_STANDARD;
    EXPECT_OK(call_haptoflow_engine_create(&engineOptions, &engine))
    EXPECT_OK(call_haptoflow_voice_create(engine, sampleRateHz, &voice))

    state.touching = 1;
    state.touch_counter = 1;
    state.label_count = 1;
    state.weights[0] = 1.0F;
    state.velocity_mps[0] = 0.2F;
    state.force_newtons = 1.0F;
    for (int index = 0; index < blocks; ++index) {
        float samples[blockFrames] = {0.0F};
        EXPECT_OK(call_haptoflow_voice_publish(voice, &state))
        waitForBlock();
        EXPECT_OK(call_haptoflow_voice_render(voice, samples, blockFrames, 1, 0, sampleRateHz))
        for (int frame = 0; frame < blockFrames; ++frame) {
            sum += (double)samples[frame] * (double)samples[frame];
        }
    }
    EXPECT_OK(call_haptoflow_voice_destroy(&voice))
    EXPECT_OK(call_haptoflow_engine_close(&engine))
    EXPECT_OK(call_haptoflow_model_close(&model))
    EXPECT_OK(call_haptoflow_runtime_close(&runtime))

    const double level = sqrt(sum / (blocks * blockFrames));
    printSystem();
    printf(", HaptoFlow %s: %.4f of full scale\n", call_haptoflow_version(), level);
    return isfinite(level) && level > 1e-4 ? 0 : 1;
}
