#include "capi/handles.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <string>
#include <string_view>

using namespace haptoflow;
using namespace haptoflow::capi;

haptoflow_status haptoflow_cancellation_create(haptoflow_cancellation** cancellation) {
    return guarded([&] {
        (void)require(cancellation, "cancellation");
        *cancellation = cancellations().open(std::make_shared<inference::Cancellation>());
    });
}

haptoflow_status haptoflow_cancellation_cancel(haptoflow_cancellation* cancellation) {
    return guarded([&] { cancellations().get(cancellation)->cancel(); });
}

haptoflow_status haptoflow_cancellation_close(haptoflow_cancellation** cancellation) {
    return guarded([&] { closeHandle(cancellations(), cancellation, "cancellation"); });
}

namespace {}  // namespace

haptoflow_status haptoflow_runtime_open(const haptoflow_runtime_options* options, haptoflow_runtime** runtime) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(runtime, "runtime");
        if ((given.ort_api_base == nullptr) == (given.library_path == nullptr)) {
            throw std::invalid_argument("options: exactly one of ort_api_base and library_path must be set");
        }
        const auto log =
            given.log != nullptr ? std::make_shared<inference::LogSink>(given.log, given.log_context) : nullptr;
        *runtime = runtimes().open(
            given.ort_api_base != nullptr
                ? inference::Runtime::fromApiBase(static_cast<const OrtApiBase*>(given.ort_api_base), log)
                : inference::Runtime::open(utf8Path(given.library_path), log));
    });
}

haptoflow_status haptoflow_runtime_close(haptoflow_runtime** runtime) {
    return guarded([&] {
        if (*require(runtime, "runtime") == nullptr) {
            return;
        }
        const auto open = runtimes().get(*runtime);
        closeHandle(runtimes(), runtime, "runtime");
        if (open->log() != nullptr) {
            open->log()->close();
        }
    });
}

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

struct NamedStatus {
    haptoflow_status number;
    const char* name;
};

// A constant of haptoflow.h with its name.
#define HAPTOFLOW_NAMED(constant) \
    { constant, #constant }

constexpr auto statusNames = std::to_array<NamedStatus>({
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

}  // namespace

const char* haptoflow_version(void) {
    return HAPTOFLOW_VERSION_TEXT;
}

const char* haptoflow_status_name(haptoflow_status status) {
    const auto* entry = std::ranges::find(statusNames, status, &NamedStatus::number);
    return entry == std::end(statusNames) ? "HAPTOFLOW_UNKNOWN_STATUS" : entry->name;
}

const char* haptoflow_last_message(void) {
    return lastMessage();
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
