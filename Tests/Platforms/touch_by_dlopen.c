/* Opens the plugin as Unity does, by dlopen, slides over the model's first label for half a second with the worker's
 * thread, and prints the level. scripts/lib/old_glibc.mjs compiles and runs it in a Debian 11, whose glibc is 2.31. */
#define _GNU_SOURCE
#include <haptoflow/haptoflow.h>

#include <dlfcn.h>
#include <gnu/libc-version.h>
#include <math.h>
#include <stdio.h>
#include <string.h>
#include <time.h>

enum { sampleRateHz = 48000, blockFrames = 256, blocks = 94 };

/* A pointer to a function of the header, by its name. */
#define TAKE(name)                                             \
    __typeof__(&name) call_##name;                             \
    *(void**)(&call_##name) = dlsym(library, #name);           \
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
    const struct timespec block = {.tv_nsec = 1000000000L * blockFrames / sampleRateHz};
    haptoflow_runtime* runtime = NULL;
    haptoflow_model* model = NULL;
    haptoflow_engine* engine = NULL;
    haptoflow_voice voice = 0;
    double sum = 0.0;

    if (argc != 4) {
        fprintf(stderr, "usage: touch_by_dlopen LIBRARY ONNXRUNTIME_LIBRARY MODEL\n");
        return 2;
    }
    void* const library = dlopen(argv[1], RTLD_NOW | RTLD_LOCAL);
    if (library == NULL) {
        fprintf(stderr, "%s\n", dlerror());
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
        nanosleep(&block, NULL);
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
    printf("glibc %s, HaptoFlow %s: %.4f of full scale\n", gnu_get_libc_version(), call_haptoflow_version(), level);
    return isfinite(level) && level > 1e-4 ? 0 : 1;
}
