#include "skeleton/excitation.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace haptoflow::skeleton {
namespace {

constexpr std::array<double, 6> ringsHz{50.0, 90.0, 160.0, 280.0, 500.0, 800.0};
constexpr double ringDecay = 0.4;
constexpr float largestGain = 8.0F;
constexpr auto lowestThreshold = static_cast<float>(model::SkeletonHeader::impulseThresholds.front());
static_assert(atomCount == 1 + 2 * ringsHz.size());

/// Standard deviation of sign(n) max(|n| - threshold, 0) of standard normal n: E = 2 [(1 + t^2) Q(t) - t p(t)].
double excessDeviation(double threshold) noexcept {
    const double tail = 0.5 * std::erfc(threshold / std::numbers::sqrt2);
    const double density = std::exp(-0.5 * threshold * threshold) / std::sqrt(2.0 * std::numbers::pi);
    return std::sqrt(2.0 * ((1.0 + threshold * threshold) * tail - threshold * density));
}

/// Of unit energy: the damped cosine or sine of a ring.
template <typename Sinusoid>
std::array<float, TailImpulses::taps> ringing(double ringHz, Sinusoid sinusoid) noexcept {
    std::array<double, TailImpulses::taps> atom{};
    double energy = 0.0;
    for (std::size_t n = 0; n < atom.size(); ++n) {
        const double turn = 2.0 * std::numbers::pi * ringHz * static_cast<double>(n) / waveformRateHz;
        atom[n] = std::exp(-ringDecay * turn) * sinusoid(turn);
        energy += atom[n] * atom[n];
    }
    std::array<float, TailImpulses::taps> result{};
    std::ranges::transform(atom, result.begin(),
                           [energy](double value) { return static_cast<float>(value / std::sqrt(energy)); });
    return result;
}

constexpr double slowestHz = 0.5;
constexpr double highestSwingHz = 700.0;
constexpr double highestLineHz = 960.0;
constexpr float largestLine = 30.0F;

/// Cosine and sine of an angle that grows evenly from sample to sample.
struct Rotation {
    Piece cosine;
    Piece sine;
};

/// The rotation of a family's first harmonic, turned on from its first sample in double precision.
Rotation firstHarmonic(double cycles, double cyclesPerSample, std::size_t samples) noexcept {
    constexpr double wholeTurn = 2.0 * std::numbers::pi;
    const double start = cycles + 0.5 * cyclesPerSample;
    const double angle = wholeTurn * (start - std::round(start));
    const double step = wholeTurn * cyclesPerSample;
    const double stepCosine = std::cos(step);
    const double stepSine = std::sin(step);
    double cosine = std::cos(angle);
    double sine = std::sin(angle);
    Rotation rotation;
    for (std::size_t n = 0; n < samples; ++n) {
        rotation.cosine[n] = static_cast<float>(cosine);
        rotation.sine[n] = static_cast<float>(sine);
        const double turned = cosine * stepCosine - sine * stepSine;
        sine = cosine * stepSine + sine * stepCosine;
        cosine = turned;
    }
    return rotation;
}

/// Turns `rotation` on by `step`.
void turn(Rotation& rotation, const Rotation& step, std::size_t samples) noexcept {
    for (std::size_t n = 0; n < samples; ++n) {
        const float cosine = rotation.cosine[n];
        const float sine = rotation.sine[n];
        rotation.cosine[n] = cosine * step.cosine[n] - sine * step.sine[n];
        rotation.sine[n] = cosine * step.sine[n] + sine * step.cosine[n];
    }
}

float lineGain(float output) noexcept {
    return largestLine * std::tanh(output / largestLine);
}

}  // namespace

TailImpulses::TailImpulses() {
    atoms_[0][0] = 1.0F;
    for (std::size_t ring = 0; ring < ringsHz.size(); ++ring) {
        atoms_[1 + 2 * ring] = ringing(ringsHz[ring], [](double turn) { return std::cos(turn); });
        atoms_[2 + 2 * ring] = ringing(ringsHz[ring], [](double turn) { return std::sin(turn); });
    }
    std::ranges::transform(model::SkeletonHeader::impulseThresholds, scales_.begin(),
                           [](double threshold) { return static_cast<float>(1.0 / excessDeviation(threshold)); });
}

void TailImpulses::add(std::span<const float> noise, std::span<const float, gainCount> gains,
                       Ringing& ringing) const noexcept {
    // Rarely more than two of eleven samples.
    std::array<std::size_t, pieceSamples + 1> places{};
    std::size_t count = 0;
    for (std::size_t at = 0; at < noise.size(); ++at) {
        places[count] = at;
        count += std::fabs(noise[at]) > lowestThreshold ? 1 : 0;
    }
    for (const std::size_t at : std::span(places).first(count)) {
        const bool isNegative = noise[at] < 0.0F;
        const float height = std::fabs(noise[at]);
        Kernel kernel{};
        for (std::size_t threshold = 0; threshold < thresholdCount; ++threshold) {
            const float excess = height - static_cast<float>(model::SkeletonHeader::impulseThresholds[threshold]);
            if (!(excess > 0.0F)) {
                break;
            }
            const std::size_t first = ((isNegative ? thresholdCount : 0) + threshold) * atomCount;
            const float event = (isNegative ? -scales_[threshold] : scales_[threshold]) * excess;
            addKernel(std::span<const float, atomCount>(gains.subspan(first, atomCount)), event, kernel);
        }
        for (std::size_t tap = 0; tap < taps; ++tap) {
            ringing[at + tap] += kernel[tap];
        }
    }
}

void TailImpulses::addKernel(std::span<const float, atomCount> gains, float event, Kernel& kernel) const noexcept {
    for (std::size_t atom = 0; atom < atomCount; ++atom) {
        const float gain = event * largestGain * std::tanh(gains[atom] / largestGain);
        for (std::size_t tap = 0; tap < taps; ++tap) {
            kernel[tap] += gain * atoms_[atom][tap];
        }
    }
}

bool isHeardHz(double rateHz) noexcept {
    return std::fabs(rateHz) > slowestHz && std::fabs(rateHz) < highestLineHz;
}

double linePower(const FamilyGains& gains, double rateHz, std::size_t harmonic) noexcept {
    if (std::fabs(rateHz) * static_cast<double>(harmonic) >= highestLineHz) {
        return 0.0;
    }
    const auto cosine = static_cast<double>(lineGain(gains.lineCosine[harmonic - 1]));
    const auto sine = static_cast<double>(lineGain(gains.lineSine[harmonic - 1]));
    return 0.5 * (cosine * cosine + sine * sine);
}

void SurfaceWaves::add(const FamilyPhase& phase, const FamilyGains& gains, NetworkView view) noexcept {
    isHeard_ = true;
    const double rateHz = std::fabs(phase.rateHz);
    const double cycles = phase.rateHz >= 0.0 ? phase.cycles : -phase.cycles;
    const Rotation first = firstHarmonic(cycles, rateHz / waveformRateHz, samples_);
    Rotation rotation = first;
    for (std::size_t index = 0; index < lineHarmonics; ++index) {
        const double harmonicHz = rateHz * static_cast<double>(index + 1);
        if (harmonicHz >= highestLineHz) {
            return;
        }
        if (index > 0) {
            turn(rotation, first, samples_);
        }
        const float lineCosine = lineGain(gains.lineCosine[index]);
        const float lineSine = lineGain(gains.lineSine[index]);
        for (std::size_t n = 0; n < samples_; ++n) {
            lines_[n] += lineCosine * rotation.cosine[n] + lineSine * rotation.sine[n];
        }
        if (index >= swingHarmonics || harmonicHz >= highestSwingHz) {
            continue;
        }
        const float swingCosine = gains.swingCosine[index];
        const float swingSine = gains.swingSine[index];
        for (std::size_t n = 0; n < samples_; ++n) {
            swing_[n] += swingCosine * rotation.cosine[n] + swingSine * rotation.sine[n];
        }
        if (view.input != nullptr) {
            const auto cosines = view.input->piece(2 + index, view.first, samples_);
            const auto sines = view.input->piece(2 + swingHarmonics + index, view.first, samples_);
            for (std::size_t n = 0; n < samples_; ++n) {
                cosines[n] += rotation.cosine[n];
                sines[n] += rotation.sine[n];
            }
        }
    }
}

}  // namespace haptoflow::skeleton
