#include "engine/stream_parameters.hpp"

#include "dsp/sample_rates.hpp"
#include "inference/segment_generator.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/gaussian_noise.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <numbers>
#include <span>
#include <utility>

namespace haptoflow::engine {
namespace {

constexpr std::uint64_t waves = 12;
constexpr std::uint64_t numbersPerWave = 4;
constexpr double octaves = 0.5;
// A surface cuts the waves at an angle, which makes them longer. This restores the mean square slope that waves within
// the surface have: 2/3 of a direction's square lies in a plane, half of it along a path.
const double shortening = std::sqrt(1.5);

// The distance between slips is proportional to the force raised to this power. A force below the lightest counts as
// the lightest, so that the distance stays above zero.
constexpr double slipForceExponent = 0.4;
constexpr double lightestSlipNewtons = 0.05;
// From the noise to the vibration: two samples of the resampler and one of the filters (measured).
constexpr double outputDelaySamples = 3.0;
constexpr double maximumSecondsAhead = 0.25;

constexpr std::size_t slipFamily = skeleton::ribCount;
constexpr double millimetresPerMetre = 1000.0;
// A surface counts as flat if its axes turn by less than 1e-3 over 5 mm: its radius of curvature is above 5 m. The
// limit is rounded to single precision because the axes are.
constexpr double steadyTurn = static_cast<double>(1e-3F);
constexpr double flatMetres = 0.005;

double difference(const std::array<float, 3>& left, const std::array<float, 3>& right) noexcept {
    return static_cast<double>(std::hypot(left[0] - right[0], left[1] - right[1], left[2] - right[2]));
}

double dot(const std::array<double, 3>& vector, const std::array<float, 3>& axis) noexcept {
    return vector[0] * static_cast<double>(axis[0]) + vector[1] * static_cast<double>(axis[1]) +
           vector[2] * static_cast<double>(axis[2]);
}

/// Whether the network is told the tip's own velocity.
bool isInsideRange(const PublishedContact& contact) noexcept {
    const auto& motion = contact.ranged.motion;
    const float told = std::hypot(motion[0], motion[1]) * contact.state.spatialScale;
    return contact.ranged.readingRate == 1.0 && std::abs(told - contact.state.speedMps()) <= 1e-3F * told;
}

/// The field that one family follows.
WanderPoint wanderOf(std::size_t family, double wavelengthMetres, std::uint64_t surface,
                     const skeleton::SurfacePath& path) noexcept {
    constexpr std::uint64_t step = 0x9E3779B97F4A7C15U;
    return surfaceWander(surface + step * (family + 1U), wavelengthMetres, path);
}

/// What a label says of one of its wave vectors; nothing if the label does not have it.
model::RibWander wanderIn(const PreparedMaterial& material, const skeleton::WaveVector& vector) noexcept {
    const skeleton::WaveVectors own = waveVectorsOf(material.embedding);
    for (std::size_t slot = 0; slot < own.size() && slot < material.label->ribWander.size(); ++slot) {
        if (own[slot] == vector) {
            return material.label->ribWander[slot];
        }
    }
    return {};
}

/// Ribs keep what their own material says of them.
model::RibWander ribWanderOf(const Ingredients& ingredients, const skeleton::WaveVector& vector) noexcept {
    for (const Ingredient& each : ingredients.all()) {
        if (const model::RibWander wander = wanderIn(*each.material, vector); wander.cycles != 0.0) {
            return wander;
        }
    }
    return {};
}

/// Slips are those of the heaviest material that slips; without length if none does.
model::StickSlip slipOf(const Ingredients& ingredients) noexcept {
    model::StickSlip slip{};
    double heaviest = 0.0;
    for (const Ingredient& each : ingredients.all()) {
        if (each.material->label->stickSlip && each.weight > heaviest) {
            slip = *each.material->label->stickSlip;
            heaviest = each.weight;
        }
    }
    return slip;
}

skeleton::SkeletonParameters parametersOf(const skeleton::Skeleton& skeleton,
                                          std::span<const float, model::embeddingSize> embedding,
                                          const std::array<float, 3>& motion,
                                          const std::array<double, skeleton::familyCount>& ratesHz,
                                          float impulseGain) noexcept {
    skeleton::Phases phases{};
    std::ranges::transform(ratesHz, phases.begin() + skeleton::familyCount,
                           [](double rateHz) { return static_cast<float>(rateHz); });
    return skeleton.parametersFor(skeleton::conditionOf(embedding, motion, phases), ratesHz, impulseGain);
}

}  // namespace

WanderPoint surfaceWander(std::uint64_t key, double wavelengthMetres, const skeleton::SurfacePath& path) noexcept {
    constexpr double wholeTurn = 2.0 * std::numbers::pi;
    const double size = std::sqrt(2.0 / static_cast<double>(waves));
    WanderPoint point;
    for (std::uint64_t wave = 0; wave < waves; ++wave) {
        std::array<double, numbersPerWave> drawn{};
        for (std::size_t number = 0; number < numbersPerWave; ++number) {
            drawn[number] = skeleton::fractionOf(key, wave * numbersPerWave + number);
        }
        // Uniform on the sphere: height and angle are independent.
        const double height = 2.0 * drawn[0] - 1.0;
        const double across = std::sqrt(1.0 - height * height);
        const double turn = wholeTurn * drawn[1];
        const double cycles = shortening * std::exp2(octaves * (2.0 * drawn[2] - 1.0)) / wavelengthMetres;
        const std::array<double, 3> direction{across * std::cos(turn), across * std::sin(turn), height};
        double phase = drawn[3];
        double step = 0.0;
        for (std::size_t axis = 0; axis < direction.size(); ++axis) {
            phase += cycles * direction[axis] * path.startMetres[axis];
            step += cycles * direction[axis] * path.stepMetres[axis];
        }
        const double angle = wholeTurn * (phase - std::floor(phase));
        point.value += size * std::cos(angle);
        point.changePerSample -= size * wholeTurn * step * std::sin(angle);
    }
    return point;
}

double slipsHz(const model::StickSlip& slip, const std::array<float, 3>& motion, double wander) noexcept {
    if (!(slip.lengthMetres > 0.0)) {
        return 0.0;
    }
    const double pressed = std::pow(std::max(static_cast<double>(motion[2]), lightestSlipNewtons), slipForceExponent);
    const double wayMetres = slip.lengthMetres * pressed * std::exp(slip.wander * wander);
    return std::hypot(static_cast<double>(motion[0]), static_cast<double>(motion[1])) / wayMetres;
}

double samplesSincePublished(double samples, double readingRate, double sincePublishedSeconds) noexcept {
    const double samplesPerSecond = dsp::waveformRateHz * readingRate;
    const double seconds = (samples + outputDelaySamples) / samplesPerSecond + sincePublishedSeconds;
    return std::clamp(seconds, 0.0, maximumSecondsAhead) * samplesPerSecond;
}

StreamParameterMaker::StreamParameterMaker(skeleton::NativeParts native, std::uint64_t seed,
                                           std::uint32_t voice) noexcept
    : native_(std::move(native)), seed_(seed), voice_(voice) {}

skeleton::StreamParameters StreamParameterMaker::make(const PublishedContact& contact, const MaterialInputs& material,
                                                      const Ingredients& ingredients, double renderedSeconds,
                                                      const std::array<double, 2>& seedPhase) noexcept {
    const std::array<float, 3>& motion = contact.ranged.motion;
    skeleton::StreamParameters parameters;
    parameters.surface = surfaceOf(contact);
    parameters.path = pathOf(contact, renderedSeconds);
    parameters.isPlaced = contact.state.hasPlace != 0;
    parameters.ribs = waveVectorsOf(material.embedding);
    const bool isRibPlaced = isFlat(contact) && isInsideRange(contact);
    const double along = dot(parameters.path.startMetres, contact.state.firstAxis) * millimetresPerMetre;
    const double across = dot(parameters.path.startMetres, contact.state.secondAxis) * millimetresPerMetre;
    const auto ribsHz =
        skeleton::ribRatesHz(material.embedding, static_cast<double>(motion[0]), static_cast<double>(motion[1]));
    for (std::size_t rib = 0; rib < skeleton::ribCount; ++rib) {
        const skeleton::WaveVector& vector = parameters.ribs[rib];
        WanderPoint point;
        const model::RibWander wander = vector.isNone() ? model::RibWander{} : ribWanderOf(ingredients, vector);
        if (wander.cycles > 0.0 && wander.wavelengthMetres > 0.0) {
            point = wanderOf(rib, wander.wavelengthMetres, parameters.surface, parameters.path);
        }
        const double placed = static_cast<double>(vector.x) * along + static_cast<double>(vector.y) * across;
        parameters.families[rib] = {
            .phase = {.cycles = isRibPlaced ? placed + wander.cycles * point.value : seedPhase[rib],
                      .rateHz = ribsHz[rib] + wander.cycles * point.changePerSample * dsp::waveformRateHz},
            .isPlaced = isRibPlaced};
    }
    const model::StickSlip slip = slipOf(ingredients);
    const double slipWander = slip.wanderMetres > 0.0
                                  ? wanderOf(slipFamily, slip.wanderMetres, parameters.surface, parameters.path).value
                                  : 0.0;
    parameters.families[slipFamily].phase.rateHz = slipsHz(slip, motion, slipWander);

    parameters.levelMps2 = levelOf(contact, material);
    if (native_.skeleton != nullptr) {
        std::array<double, skeleton::familyCount> ratesHz{};
        std::ranges::transform(parameters.families, ratesHz.begin(),
                               [](const auto& each) { return each.phase.rateHz; });
        parameters.skeleton =
            parametersOf(*native_.skeleton, material.embedding, motion, ratesHz, material.impulseGain);
        if (ingredients.isBlend()) {
            parameters.levelMps2 *= balanceOf(contact, ingredients, logPowerOf(parameters.skeleton, ratesHz));
        }
    }
    return parameters;
}

float StreamParameterMaker::balanceOf(const PublishedContact& contact, const Ingredients& ingredients,
                                      double logPower) const noexcept {
    constexpr double largestLogGain = 0.7;
    const std::array<float, 3>& motion = contact.ranged.motion;
    for (const Ingredient& each : ingredients.all()) {
        const auto embedding = embeddingOf(
            *each.material, {.surfaceSeed = contact.state.surfaceSeed, .variation = contact.state.variation});
        const auto ribsHz =
            skeleton::ribRatesHz(embedding, static_cast<double>(motion[0]), static_cast<double>(motion[1]));
        const std::array<double, skeleton::familyCount> ratesHz{
            ribsHz[0], ribsHz[1], slipsHz(each.material->label->stickSlip.value_or(model::StickSlip{}), motion, 0.0)};
        const skeleton::SkeletonParameters own =
            parametersOf(*native_.skeleton, embedding, motion, ratesHz, each.material->label->impulseGain);
        logPower -= each.weight / ingredients.totalWeight() * logPowerOf(own, ratesHz);
    }
    return static_cast<float>(std::exp(std::clamp(-0.5 * logPower, -largestLogGain, largestLogGain)));
}

float StreamParameterMaker::levelOf(const PublishedContact& contact, const MaterialInputs& material) const noexcept {
    if (native_.level == nullptr) {
        return contact.levelMps2;
    }
    if (material.level.levelMps2) {
        return *material.level.levelMps2;
    }
    const float logLevel = native_.level->logLevel(material.embedding, material.level.motion);
    constexpr auto limit = static_cast<float>(inference::maximumLogLevel);
    // What is not a number is silent.
    const float limited = std::isfinite(logLevel) ? std::clamp(logLevel, -limit, limit) : -limit;
    return std::exp(limited) * material.level.gain;
}

std::uint64_t StreamParameterMaker::surfaceOf(const PublishedContact& contact) const noexcept {
    const ContactState& state = contact.state;
    // Without a place every touch begins at the same coordinates, so each touch of each voice gets a field of its own;
    // otherwise all touches would sound alike.
    const std::uint64_t surface = state.hasPlace != 0
                                      ? state.surfaceSeed
                                      : (std::uint64_t{1} << 63U) + (std::uint64_t{voice_} << 32U) + contact.touch;
    return seed_ * 0x9E3779B97F4A7C15U + surface;
}

skeleton::SurfacePath StreamParameterMaker::pathOf(const PublishedContact& contact, double renderedSeconds) noexcept {
    const ContactState& state = contact.state;
    const double scale = state.spatialScale;
    const double samplesPerSecond = dsp::waveformRateHz * contact.ranged.readingRate;
    std::array<double, 3> velocityMps{static_cast<double>(state.velocityMps[0]) / scale,
                                      static_cast<double>(state.velocityMps[1]) / scale, 0.0};
    skeleton::SurfacePath path;
    if (state.hasPlace != 0) {
        const auto [first, second] = std::pair{velocityMps[0], velocityMps[1]};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            velocityMps[axis] = first * static_cast<double>(state.firstAxis[axis]) +
                                second * static_cast<double>(state.secondAxis[axis]);
            path.startMetres[axis] = static_cast<double>(state.placeMetres[axis]) / scale;
        }
    } else {
        const bool isNewTouch = std::exchange(touch_, contact.touch) != contact.touch;
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const double way = velocityMps_[axis] * (renderedSeconds - placeSeconds_);
            placeMetres_[axis] = isNewTouch ? 0.0 : placeMetres_[axis] + way;
        }
        path.startMetres = placeMetres_;
        velocityMps_ = velocityMps;
        placeSeconds_ = renderedSeconds;
    }
    for (std::size_t axis = 0; axis < 3; ++axis) {
        path.stepMetres[axis] = velocityMps[axis] / samplesPerSecond;
    }
    return path;
}

bool StreamParameterMaker::isFlat(const PublishedContact& contact) noexcept {
    const ContactState& state = contact.state;
    if (state.hasPlace == 0 || std::exchange(onset_, contact.onset) != contact.onset) {
        anchor_.reset();
    }
    if (state.hasPlace == 0) {
        return false;
    }
    const Anchor here{.surfaceSeed = state.surfaceSeed,
                      .placeMetres = state.placeMetres,
                      .firstAxis = state.firstAxis,
                      .secondAxis = state.secondAxis};
    if (!anchor_) {
        anchor_ = here;
        isFlat_ = true;
        return true;
    }
    const bool hasTurned = difference(anchor_->firstAxis, state.firstAxis) > steadyTurn ||
                           difference(anchor_->secondAxis, state.secondAxis) > steadyTurn;
    if (hasTurned || anchor_->surfaceSeed != state.surfaceSeed) {
        anchor_ = here;
        isFlat_ = false;
    } else if (difference(anchor_->placeMetres, state.placeMetres) > flatMetres) {
        isFlat_ = true;
    }
    return isFlat_;
}

}  // namespace haptoflow::engine
