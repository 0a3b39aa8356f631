#include "capi/handles.hpp"

#include "inference/load_limits.hpp"
#include "inference/tier_generator.hpp"
#include "model/material_file.hpp"
#include "model/model_error.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <array>
#include <cstddef>
#include <iterator>
#include <new>
#include <stdexcept>
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

haptoflow_status haptoflow_runtime_open(const haptoflow_runtime_options* options, haptoflow_runtime** runtime) {
    return guarded([&] {
        const auto given = readDescriptor(options, "options");
        (void)require(runtime, "runtime");
        if ((given.ort_api_base == nullptr) == (given.library_path == nullptr)) {
            throw std::invalid_argument("options: exactly one of ort_api_base and library_path must be set");
        }
        *runtime =
            runtimes().open(given.ort_api_base != nullptr
                                ? inference::Runtime::fromApiBase(static_cast<const OrtApiBase*>(given.ort_api_base))
                                : inference::Runtime::open(utf8Path(given.library_path)));
    });
}

haptoflow_status haptoflow_runtime_close(haptoflow_runtime** runtime) {
    return guarded([&] { closeHandle(runtimes(), runtime, "runtime"); });
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
    HAPTOFLOW_SIZE(haptoflow_runtime_options),   HAPTOFLOW_SIZE(haptoflow_model_options),
    HAPTOFLOW_SIZE(haptoflow_model_info),        HAPTOFLOW_SIZE(haptoflow_label_info),
    HAPTOFLOW_SIZE(haptoflow_tier_info),         HAPTOFLOW_SIZE(haptoflow_material_info),
    HAPTOFLOW_SIZE(haptoflow_generator_options), HAPTOFLOW_SIZE(haptoflow_batch),
    HAPTOFLOW_SIZE(haptoflow_engine_options),    HAPTOFLOW_SIZE(haptoflow_tier_times),
    HAPTOFLOW_SIZE(haptoflow_engine_statistics), HAPTOFLOW_SIZE(haptoflow_relief_options),
    HAPTOFLOW_SIZE(haptoflow_contact_state),     HAPTOFLOW_SIZE(haptoflow_effect_statistics),
    HAPTOFLOW_SIZE(haptoflow_voice_statistics),  HAPTOFLOW_SIZE(haptoflow_signal_statistics),
    HAPTOFLOW_SIZE(haptoflow_exposure),          HAPTOFLOW_SIZE(haptoflow_wave_features_options),
    HAPTOFLOW_SIZE(haptoflow_clip_options),      HAPTOFLOW_SIZE(haptoflow_clip_info),
    HAPTOFLOW_SIZE(haptoflow_wave_frame),        HAPTOFLOW_SIZE(haptoflow_recording_file),
    HAPTOFLOW_SIZE(haptoflow_recording_options), HAPTOFLOW_SIZE(haptoflow_track),
    HAPTOFLOW_SIZE(haptoflow_recording_info),    HAPTOFLOW_SIZE(haptoflow_learning_options),
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

namespace haptoflow::capi {
namespace {

// Its size is fixed, because reporting that memory is exhausted must not allocate.
thread_local std::array<char, 1024> message{};

haptoflow_status report(haptoflow_status status, const char* text) noexcept {
    std::size_t length = 0;
    // Texts of files may be in it, and consoles obey control characters; escaping allocates, so copy byte by byte.
    for (; *text != '\0' && length + 1 < message.size(); ++text) {
        const auto code = static_cast<unsigned char>(*text);
        message[length++] = code == '\n' ? ' ' : code < 0x20U || code == 0x7FU ? '?' : *text;
    }
    message[length] = '\0';
    return status;
}

static_assert(HAPTOFLOW_MODEL_UNREADABLE + static_cast<int>(model::ModelStatus::inconsistent) ==
              HAPTOFLOW_MODEL_INCONSISTENT);

}  // namespace

haptoflow_status reportCurrentException() noexcept {
    try {
        throw;
    } catch (const model::ModelError& error) {
        return report(HAPTOFLOW_MODEL_UNREADABLE + static_cast<int>(error.status()), error.what());
    } catch (const model::MaterialError& error) {
        return report(HAPTOFLOW_MATERIAL_INVALID, error.what());
    } catch (const model::MaterialMismatch& error) {
        return report(HAPTOFLOW_MATERIAL_MISMATCH, error.what());
    } catch (const recordings::RecordingUnusable& error) {
        return report(HAPTOFLOW_RECORDING_UNUSABLE, error.what());
    } catch (const inference::RuntimeUnavailable& error) {
        return report(HAPTOFLOW_RUNTIME_UNAVAILABLE, error.what());
    } catch (const inference::InferenceError& error) {
        return report(HAPTOFLOW_INFERENCE_FAILED, error.what());
    } catch (const inference::LoadCancelled& error) {
        return report(HAPTOFLOW_CANCELLED, error.what());
    } catch (const inference::TierTooSlow& error) {
        return report(HAPTOFLOW_TIER_TOO_SLOW, error.what());
    } catch (const std::invalid_argument& error) {
        return report(HAPTOFLOW_INVALID_ARGUMENT, error.what());
    } catch (const std::bad_alloc&) {
        return report(HAPTOFLOW_OUT_OF_MEMORY, "out of memory");
    } catch (const std::exception& error) {
        return report(HAPTOFLOW_INTERNAL_ERROR, error.what());
    } catch (...) {
        return report(HAPTOFLOW_INTERNAL_ERROR, "an exception of an unknown type");
    }
}

const char* lastMessage() noexcept {
    return message.data();
}

std::shared_ptr<const inference::Runtime> runtimeOf(const haptoflow_runtime* runtime) {
    return runtime != nullptr ? runtimes().get(runtime) : nullptr;
}

const model::Tier& tierNamed(const model::ModelFile& model, const char* name) {
    if (name == nullptr) {
        return model.header().tiers[model.header().defaultTier];
    }
    const model::Tier* tier = model.findTier(name);
    if (tier == nullptr) {
        throw std::invalid_argument(std::string("options: the model has no tier \"") + name + '"');
    }
    return *tier;
}

inference::LoadLimits loadLimits(const haptoflow_cancellation* cancellation, double probeLimitMs) {
    inference::LoadLimits limits;
    if (probeLimitMs != 0.0) {
        if (!(probeLimitMs > 0.0 && probeLimitMs <= inference::maximumProbeLimitMs)) {
            throw std::invalid_argument("options: probe_limit_ms is " + std::to_string(probeLimitMs) +
                                        "; expected above 0 to 3600000, or 0 for 10000");
        }
        limits.probeLimitMs = probeLimitMs;
    }
    if (cancellation != nullptr) {
        limits.cancellation = cancellations().get(cancellation);
    }
    return limits;
}

haptoflow_label_info describe(const model::Label& label) {
    haptoflow_label_info info{};
    info.is_periodic = label.wavelengthMetres ? 1 : 0;
    info.name = label.name.c_str();
    info.category = label.category.c_str();
    info.stiffness_newtons_per_metre = label.stiffnessNewtonsPerMetre;
    info.friction_coefficient = label.frictionCoefficient;
    info.wavelength_metres = label.wavelengthMetres.value_or(0.0);
    return info;
}

}  // namespace haptoflow::capi
