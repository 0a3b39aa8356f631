#include "capi/handles.hpp"

#include "inference/load_limits.hpp"
#include "inference/tier_generator.hpp"
#include "model/material_file.hpp"
#include "model/model_error.hpp"
#include "recordings/recording.hpp"

#include <array>
#include <new>
#include <stdexcept>

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

haptoflow_status statusOf(model::ModelStatus status) noexcept {
    switch (status) {
        case model::ModelStatus::unreadable:
            return HAPTOFLOW_MODEL_UNREADABLE;
        case model::ModelStatus::notAModel:
            return HAPTOFLOW_NOT_A_MODEL;
        case model::ModelStatus::truncated:
            return HAPTOFLOW_MODEL_TRUNCATED;
        case model::ModelStatus::tooNew:
            return HAPTOFLOW_MODEL_TOO_NEW;
        case model::ModelStatus::oversized:
            return HAPTOFLOW_MODEL_OVERSIZED;
        case model::ModelStatus::damaged:
            return HAPTOFLOW_MODEL_DAMAGED;
        case model::ModelStatus::inconsistent:
            return HAPTOFLOW_MODEL_INCONSISTENT;
    }
    return HAPTOFLOW_INTERNAL_ERROR;
}

}  // namespace

haptoflow_status reportCurrentException() noexcept {
    try {
        throw;
    } catch (const model::ModelError& error) {
        return report(statusOf(error.status()), error.what());
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
    info.speed_level_exponent = label.speedLevelExponent;
    info.force_level_exponent = label.forceLevelExponent;
    info.frequency_exponent = label.frequencyExponent;
    return info;
}

}  // namespace haptoflow::capi
