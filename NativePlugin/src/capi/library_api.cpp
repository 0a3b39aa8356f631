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

// A struct of haptoflow.h with its name.
#define HAPTOFLOW_SIZE(type) \
    { #type, sizeof(type) }

/// Every struct of haptoflow.h; a test compares the names with the header.
constexpr auto structSizes = std::to_array<StructSize>({
    HAPTOFLOW_SIZE(haptoflow_runtime_options),
    HAPTOFLOW_SIZE(haptoflow_model_options),
    HAPTOFLOW_SIZE(haptoflow_model_info),
    HAPTOFLOW_SIZE(haptoflow_label_info),
    HAPTOFLOW_SIZE(haptoflow_tier_info),
    HAPTOFLOW_SIZE(haptoflow_material_info),
    HAPTOFLOW_SIZE(haptoflow_generator_options),
    HAPTOFLOW_SIZE(haptoflow_batch),
    HAPTOFLOW_SIZE(haptoflow_engine_options),
    HAPTOFLOW_SIZE(haptoflow_tier_times),
    HAPTOFLOW_SIZE(haptoflow_engine_statistics),
    HAPTOFLOW_SIZE(haptoflow_contact_state),
    HAPTOFLOW_SIZE(haptoflow_effect_statistics),
    HAPTOFLOW_SIZE(haptoflow_voice_statistics),
    HAPTOFLOW_SIZE(haptoflow_signal_statistics),
    HAPTOFLOW_SIZE(haptoflow_exposure),
    HAPTOFLOW_SIZE(haptoflow_wave_features_options),
    HAPTOFLOW_SIZE(haptoflow_wave_frame),
    HAPTOFLOW_SIZE(haptoflow_recording_file),
    HAPTOFLOW_SIZE(haptoflow_recording_options),
    HAPTOFLOW_SIZE(haptoflow_track),
    HAPTOFLOW_SIZE(haptoflow_recording_info),
    HAPTOFLOW_SIZE(haptoflow_learning_options),
});

struct NamedNumber {
    int32_t number;
    const char* name;
};

// A constant of haptoflow.h with its name.
#define HAPTOFLOW_NAMED(constant) \
    { constant, #constant }

constexpr auto statusNames = std::to_array<NamedNumber>({
    HAPTOFLOW_NAMED(HAPTOFLOW_OK),
    HAPTOFLOW_NAMED(HAPTOFLOW_INVALID_ARGUMENT),
    HAPTOFLOW_NAMED(HAPTOFLOW_OUT_OF_MEMORY),
    HAPTOFLOW_NAMED(HAPTOFLOW_INTERNAL_ERROR),
    HAPTOFLOW_NAMED(HAPTOFLOW_BUSY),
    HAPTOFLOW_NAMED(HAPTOFLOW_MODEL_UNREADABLE),
    HAPTOFLOW_NAMED(HAPTOFLOW_NOT_A_MODEL),
    HAPTOFLOW_NAMED(HAPTOFLOW_MODEL_TRUNCATED),
    HAPTOFLOW_NAMED(HAPTOFLOW_MODEL_TOO_NEW),
    HAPTOFLOW_NAMED(HAPTOFLOW_MODEL_OVERSIZED),
    HAPTOFLOW_NAMED(HAPTOFLOW_MODEL_DAMAGED),
    HAPTOFLOW_NAMED(HAPTOFLOW_MODEL_INCONSISTENT),
    HAPTOFLOW_NAMED(HAPTOFLOW_MATERIAL_MISMATCH),
    HAPTOFLOW_NAMED(HAPTOFLOW_MATERIAL_INVALID),
    HAPTOFLOW_NAMED(HAPTOFLOW_RECORDING_UNUSABLE),
    HAPTOFLOW_NAMED(HAPTOFLOW_RUNTIME_UNAVAILABLE),
    HAPTOFLOW_NAMED(HAPTOFLOW_INFERENCE_FAILED),
    HAPTOFLOW_NAMED(HAPTOFLOW_CANCELLED),
    HAPTOFLOW_NAMED(HAPTOFLOW_TIER_TOO_SLOW),
});

constexpr auto silenceNames = std::to_array<NamedNumber>({
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_NONE),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_REST),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_STALE),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_MUTED),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_PAUSED),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_PANIC),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_RATE),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_CLOSING),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_WORKER_DEAD),
    HAPTOFLOW_NAMED(HAPTOFLOW_SILENCE_TURNED_DOWN),
});

const char* nameIn(std::span<const NamedNumber> names, int32_t number, const char* otherwise) {
    const auto entry = std::ranges::find(names, number, &NamedNumber::number);
    return entry == names.end() ? otherwise : entry->name;
}

}  // namespace

const char* haptoflow_version(void) {
    return HAPTOFLOW_VERSION_TEXT;
}

const char* haptoflow_status_name(haptoflow_status status) {
    return nameIn(statusNames, status, "HAPTOFLOW_UNKNOWN_STATUS");
}

const char* haptoflow_silence_name(haptoflow_silence silence) {
    return nameIn(silenceNames, silence, "HAPTOFLOW_UNKNOWN_SILENCE");
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
