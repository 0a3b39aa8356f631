/* Slides over the model's first label for half a second and prints the level. */
#include <haptoflow/haptoflow.h>

#include <math.h>
#include <stdio.h>
#include <string.h>

enum { sampleRateHz = 48000, blockFrames = 256, blocks = 94 };

static int fail(const char* what) {
    fprintf(stderr, "%s: %s\n", what, haptoflow_last_message());
    return 1;
}

static int slide(haptoflow_engine* engine, haptoflow_voice voice, double* levelOfFullScale) {
    haptoflow_contact_state state;
    double sum = 0.0;
    memset(&state, 0, sizeof state);
    state.struct_size = sizeof state;
    state.touching = 1;
    state.touch_counter = 1;
    state.label_count = 1;
    state.weights[0] = 1.0F;
    state.velocity_mps[0] = 0.2F;
    state.force_newtons = 1.0F;

    for (int block = 0; block < blocks; ++block) {
        float samples[blockFrames] = {0.0F};
        if (haptoflow_voice_publish(voice, &state) != HAPTOFLOW_OK || haptoflow_engine_step(engine) != HAPTOFLOW_OK) {
            return fail("publish or step");
        }
        if (haptoflow_voice_render(voice, samples, blockFrames, 1, 0, sampleRateHz) != HAPTOFLOW_OK) {
            return fail("render");
        }
        for (int frame = 0; frame < blockFrames; ++frame) {
            sum += (double)samples[frame] * (double)samples[frame];
        }
    }
    *levelOfFullScale = sqrt(sum / (blocks * blockFrames));
    return 0;
}

int main(int argc, char** argv) {
    haptoflow_runtime_options runtimeOptions;
    haptoflow_model_options modelOptions;
    haptoflow_engine_options engineOptions;
    haptoflow_runtime* runtime = NULL;
    haptoflow_model* model = NULL;
    haptoflow_engine* engine = NULL;
    haptoflow_voice voice = 0;
    double level = 0.0;
    int result;

    if (argc != 2) {
        fprintf(stderr, "usage: touch ONNXRUNTIME_LIBRARY\n");
        return 2;
    }
    memset(&runtimeOptions, 0, sizeof runtimeOptions);
    runtimeOptions.struct_size = sizeof runtimeOptions;
    runtimeOptions.library_path = argv[1];
    memset(&modelOptions, 0, sizeof modelOptions);
    modelOptions.struct_size = sizeof modelOptions;
    modelOptions.path = DEFAULT_MODEL;
    memset(&engineOptions, 0, sizeof engineOptions);
    engineOptions.struct_size = sizeof engineOptions;
    engineOptions.quality = HAPTOFLOW_QUALITY_STANDARD;
    engineOptions.without_worker = 1;
    engineOptions.fixed_lead_ms = 8.0;

    if (haptoflow_runtime_open(&runtimeOptions, &runtime) != HAPTOFLOW_OK ||
        haptoflow_model_open(&modelOptions, &model) != HAPTOFLOW_OK) {
        return fail("open");
    }
    engineOptions.runtime = runtime;
    engineOptions.model = model;
    if (haptoflow_engine_create(&engineOptions, &engine) != HAPTOFLOW_OK ||
        haptoflow_voice_create(engine, sampleRateHz, &voice) != HAPTOFLOW_OK) {
        return fail("create");
    }
    result = slide(engine, voice, &level);
    if (haptoflow_voice_destroy(&voice) != HAPTOFLOW_OK || haptoflow_engine_close(&engine) != HAPTOFLOW_OK ||
        haptoflow_model_close(&model) != HAPTOFLOW_OK || haptoflow_runtime_close(&runtime) != HAPTOFLOW_OK) {
        return fail("close");
    }
    if (result == 0) {
        printf("HaptoFlow %s: %.4f of full scale\n", haptoflow_version(), level);
        result = isfinite(level) && level > 1e-4 ? 0 : 1;
    }
    return result;
}
