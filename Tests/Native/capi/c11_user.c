/* Uses the header from a program compiled as C11, as C users do. */
#include "c11_user.h"

#include "haptoflow/haptoflow.h"

#include <string.h>

int generateOneSegmentFromC(const char* onnxRuntimePath, const char* modelPath, float* segmentMps2) {
    haptoflow_runtime_options runtimeOptions;
    haptoflow_model_options modelOptions;
    haptoflow_generator_options generatorOptions;
    haptoflow_batch batch;
    haptoflow_runtime* runtime = NULL;
    haptoflow_model* model = NULL;
    haptoflow_generator* generator = NULL;
    float embedding[HAPTOFLOW_EMBEDDING_SIZE];
    float motion[HAPTOFLOW_MOTION_SIZE] = {0.1F, 0.0F, 1.0F};
    float previous[HAPTOFLOW_SEGMENT_SAMPLES] = {0.0F};
    float noise[HAPTOFLOW_SEGMENT_SAMPLES] = {0.0F};
    haptoflow_status status;

    memset(&runtimeOptions, 0, sizeof runtimeOptions);
    runtimeOptions.struct_size = sizeof runtimeOptions;
    runtimeOptions.library_path = onnxRuntimePath;
    memset(&modelOptions, 0, sizeof modelOptions);
    modelOptions.struct_size = sizeof modelOptions;
    modelOptions.path = modelPath;
    memset(&generatorOptions, 0, sizeof generatorOptions);
    generatorOptions.struct_size = sizeof generatorOptions;
    memset(&batch, 0, sizeof batch);
    batch.struct_size = sizeof batch;
    batch.count = 1;
    batch.embeddings = embedding;
    batch.motions = motion;
    batch.previous_mps2 = previous;
    batch.noise = noise;

    status = haptoflow_runtime_open(&runtimeOptions, &runtime);
    if (status == HAPTOFLOW_OK) {
        status = haptoflow_model_open(&modelOptions, &model);
    }
    if (status == HAPTOFLOW_OK) {
        status = haptoflow_model_embedding(model, 0, embedding);
    }
    if (status == HAPTOFLOW_OK) {
        generatorOptions.runtime = runtime;
        generatorOptions.model = model;
        status = haptoflow_generator_create(&generatorOptions, &generator);
    }
    if (status == HAPTOFLOW_OK) {
        status = haptoflow_generator_generate(generator, &batch, segmentMps2);
    }
    (void)haptoflow_generator_close(&generator);
    (void)haptoflow_model_close(&model);
    (void)haptoflow_runtime_close(&runtime);
    return status;
}
