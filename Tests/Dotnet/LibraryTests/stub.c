/* A stand-in for audioplugin_haptoflow: says what the tests tell it about its version and its structs, and counts every
 * other call, of which there may be none. */
#include <stdint.h>
#include <string.h>

static char version[32];
static char names[64][64];
static uint32_t sizes[64];
static int count;
static int calls;

void stub_become(const char* text) {
    strncpy(version, text, sizeof(version) - 1);
    count = 0;
    calls = 0;
}

void stub_add_struct(const char* name, uint32_t bytes) {
    strncpy(names[count], name, sizeof(names[count]) - 1);
    sizes[count++] = bytes;
}

int stub_calls(void) { return calls; }

const char* haptoflow_version(void) { return version; }

int32_t haptoflow_struct_size(const char* name, uint32_t* bytes) {
    for (int index = 0; index < count; ++index) {
        if (strcmp(names[index], name) == 0) {
            *bytes = sizes[index];
            return 0;
        }
    }
    return 1;
}

int32_t haptoflow_runtime_open(const void* options, void** runtime) { return ++calls; }
int32_t haptoflow_model_open(const void* options, void** model) { return ++calls; }
int32_t haptoflow_wave_features_create(const void* options, void** features) { return ++calls; }
int32_t haptoflow_cancellation_create(void** cancellation) { return ++calls; }
int32_t haptoflow_panic(void) { return 0; }
