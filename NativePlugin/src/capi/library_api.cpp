#include "capi/boundary.hpp"
#include "inference/gaussian_noise.hpp"

#include <span>
#include <string_view>

using namespace haptoflow;
using namespace haptoflow::capi;

static_assert(std::string_view(HAPTOFLOW_VERSION_TEXT) == HAPTOFLOW_VERSION,
              "the version macros of haptoflow.h differ from package.json");

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
