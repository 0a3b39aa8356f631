#include "capi/boundary.hpp"
#include "inference/gaussian_noise.hpp"

#include <algorithm>
#include <array>
#include <iterator>
#include <span>
#include <string>
#include <string_view>

using namespace haptoflow;
using namespace haptoflow::capi;

static_assert(std::string_view(HAPTOFLOW_VERSION_TEXT) == HAPTOFLOW_VERSION,
              "the version macros of haptoflow.h differ from package.json");

namespace {

struct StructSize {
    std::string_view name;
    uint32_t bytes;
};

template <typename Struct>
constexpr StructSize sizeOf(std::string_view name) {
    return {name, static_cast<uint32_t>(sizeof(Struct))};
}

/// Every struct of haptoflow.h; a test compares the names with the header.
constexpr std::array structSizes{
    sizeOf<haptoflow_runtime_options>("haptoflow_runtime_options"),
    sizeOf<haptoflow_model_options>("haptoflow_model_options"),
    sizeOf<haptoflow_model_info>("haptoflow_model_info"),
    sizeOf<haptoflow_label_info>("haptoflow_label_info"),
    sizeOf<haptoflow_tier_info>("haptoflow_tier_info"),
    sizeOf<haptoflow_material_info>("haptoflow_material_info"),
    sizeOf<haptoflow_generator_options>("haptoflow_generator_options"),
    sizeOf<haptoflow_batch>("haptoflow_batch"),
    sizeOf<haptoflow_engine_options>("haptoflow_engine_options"),
    sizeOf<haptoflow_tier_times>("haptoflow_tier_times"),
    sizeOf<haptoflow_engine_statistics>("haptoflow_engine_statistics"),
    sizeOf<haptoflow_contact_state>("haptoflow_contact_state"),
    sizeOf<haptoflow_effect_statistics>("haptoflow_effect_statistics"),
    sizeOf<haptoflow_voice_statistics>("haptoflow_voice_statistics"),
    sizeOf<haptoflow_signal_statistics>("haptoflow_signal_statistics"),
    sizeOf<haptoflow_exposure>("haptoflow_exposure"),
    sizeOf<haptoflow_wave_features_options>("haptoflow_wave_features_options"),
    sizeOf<haptoflow_wave_frame>("haptoflow_wave_frame"),
    sizeOf<haptoflow_recording_file>("haptoflow_recording_file"),
    sizeOf<haptoflow_recording_options>("haptoflow_recording_options"),
    sizeOf<haptoflow_track>("haptoflow_track"),
    sizeOf<haptoflow_recording_info>("haptoflow_recording_info"),
    sizeOf<haptoflow_learning_options>("haptoflow_learning_options"),
};

}  // namespace

const char* haptoflow_version(void) {
    return HAPTOFLOW_VERSION_TEXT;
}

const char* haptoflow_status_name(haptoflow_status status) {
    switch (status) {
        case HAPTOFLOW_OK:
            return "HAPTOFLOW_OK";
        case HAPTOFLOW_INVALID_ARGUMENT:
            return "HAPTOFLOW_INVALID_ARGUMENT";
        case HAPTOFLOW_OUT_OF_MEMORY:
            return "HAPTOFLOW_OUT_OF_MEMORY";
        case HAPTOFLOW_INTERNAL_ERROR:
            return "HAPTOFLOW_INTERNAL_ERROR";
        case HAPTOFLOW_BUSY:
            return "HAPTOFLOW_BUSY";
        case HAPTOFLOW_MODEL_UNREADABLE:
            return "HAPTOFLOW_MODEL_UNREADABLE";
        case HAPTOFLOW_NOT_A_MODEL:
            return "HAPTOFLOW_NOT_A_MODEL";
        case HAPTOFLOW_MODEL_TRUNCATED:
            return "HAPTOFLOW_MODEL_TRUNCATED";
        case HAPTOFLOW_MODEL_TOO_NEW:
            return "HAPTOFLOW_MODEL_TOO_NEW";
        case HAPTOFLOW_MODEL_OVERSIZED:
            return "HAPTOFLOW_MODEL_OVERSIZED";
        case HAPTOFLOW_MODEL_DAMAGED:
            return "HAPTOFLOW_MODEL_DAMAGED";
        case HAPTOFLOW_MODEL_INCONSISTENT:
            return "HAPTOFLOW_MODEL_INCONSISTENT";
        case HAPTOFLOW_MATERIAL_MISMATCH:
            return "HAPTOFLOW_MATERIAL_MISMATCH";
        case HAPTOFLOW_MATERIAL_INVALID:
            return "HAPTOFLOW_MATERIAL_INVALID";
        case HAPTOFLOW_RECORDING_UNUSABLE:
            return "HAPTOFLOW_RECORDING_UNUSABLE";
        case HAPTOFLOW_RUNTIME_UNAVAILABLE:
            return "HAPTOFLOW_RUNTIME_UNAVAILABLE";
        case HAPTOFLOW_INFERENCE_FAILED:
            return "HAPTOFLOW_INFERENCE_FAILED";
        case HAPTOFLOW_CANCELLED:
            return "HAPTOFLOW_CANCELLED";
        case HAPTOFLOW_TIER_TOO_SLOW:
            return "HAPTOFLOW_TIER_TOO_SLOW";
        default:
            return "HAPTOFLOW_UNKNOWN_STATUS";
    }
}

const char* haptoflow_silence_name(haptoflow_silence silence) {
    switch (silence) {
        case HAPTOFLOW_SILENCE_NONE:
            return "HAPTOFLOW_SILENCE_NONE";
        case HAPTOFLOW_SILENCE_REST:
            return "HAPTOFLOW_SILENCE_REST";
        case HAPTOFLOW_SILENCE_STALE:
            return "HAPTOFLOW_SILENCE_STALE";
        case HAPTOFLOW_SILENCE_MUTED:
            return "HAPTOFLOW_SILENCE_MUTED";
        case HAPTOFLOW_SILENCE_PAUSED:
            return "HAPTOFLOW_SILENCE_PAUSED";
        case HAPTOFLOW_SILENCE_PANIC:
            return "HAPTOFLOW_SILENCE_PANIC";
        case HAPTOFLOW_SILENCE_RATE:
            return "HAPTOFLOW_SILENCE_RATE";
        case HAPTOFLOW_SILENCE_CLOSING:
            return "HAPTOFLOW_SILENCE_CLOSING";
        case HAPTOFLOW_SILENCE_WORKER_DEAD:
            return "HAPTOFLOW_SILENCE_WORKER_DEAD";
        case HAPTOFLOW_SILENCE_TURNED_DOWN:
            return "HAPTOFLOW_SILENCE_TURNED_DOWN";
        default:
            return "HAPTOFLOW_UNKNOWN_SILENCE";
    }
}

const char* haptoflow_last_message(void) {
    return lastMessage();
}

haptoflow_status haptoflow_noise_fill(uint64_t seed, uint32_t voice, uint64_t segment, float* noise, uint64_t count) {
    return guarded([&] {
        if (count > uint64_t{1} << 32U) {
            throw std::invalid_argument("count is above 2^32");
        }
        const std::span<float> target(require(noise, "noise"), static_cast<std::size_t>(count));
        inference::fillStandardNormal({seed, voice, segment}, target);
    });
}

haptoflow_status haptoflow_struct_size(const char* name, uint32_t* bytes) {
    return guarded([&] {
        const std::string_view wanted(require(name, "name"));
        const auto entry = std::ranges::find(structSizes, wanted, &StructSize::name);
        if (entry == std::end(structSizes)) {
            throw std::invalid_argument("the header of this library has no struct \"" + std::string(wanted) + "\"");
        }
        *require(bytes, "bytes") = entry->bytes;
    });
}
