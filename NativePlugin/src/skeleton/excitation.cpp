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

void TailImpulses::add(Segment noise, std::span<const float, gainCount> gains,
                       std::span<float, segmentSamples> impulses) const noexcept {
    std::ranges::fill(impulses, 0.0F);
    // Rarely more than twenty of the 200 samples.
    std::array<std::size_t, segmentSamples> places{};
    std::size_t count = 0;
    for (std::size_t at = 0; at < noise.size(); ++at) {
        places[count] = at;
        count += std::fabs(noise[at]) > lowestThreshold ? 1 : 0;
    }
    for (const bool isNegative : {false, true}) {
        for (std::size_t threshold = 0; threshold < thresholdCount; ++threshold) {
            const std::size_t first = ((isNegative ? thresholdCount : 0) + threshold) * atomCount;
            const float sign = isNegative ? -1.0F : 1.0F;
            const auto height = static_cast<float>(model::SkeletonHeader::impulseThresholds[threshold]);
            Kernel kernel;
            bool hasKernel = false;
            for (const std::size_t at : std::span(places).first(count)) {
                const float excess = sign * noise[at] - height;
                if (!(excess > 0.0F)) {
                    continue;
                }
                if (!hasKernel) {
                    kernel = kernelOf(std::span<const float, atomCount>(gains.subspan(first, atomCount)));
                    hasKernel = true;
                }
                const float event = sign * scales_[threshold] * excess;
                const std::size_t heard = std::min(taps, segmentSamples - at);
                for (std::size_t tap = 0; tap < heard; ++tap) {
                    impulses[at + tap] += event * kernel[tap];
                }
            }
        }
    }
}

TailImpulses::Kernel TailImpulses::kernelOf(std::span<const float, atomCount> gains) const noexcept {
    Kernel kernel{};
    for (std::size_t atom = 0; atom < atomCount; ++atom) {
        const float gain = largestGain * std::tanh(gains[atom] / largestGain);
        for (std::size_t tap = 0; tap < taps; ++tap) {
            kernel[tap] += gain * atoms_[atom][tap];
        }
    }
    return kernel;
}

namespace {

constexpr double slowestHz = 0.5;
constexpr double highestSwingHz = 700.0;
constexpr double highestLineHz = 960.0;
constexpr float largestLine = 30.0F;

using Wave = std::array<float, segmentSamples>;

/// Cosine and sine of an angle that grows evenly from sample to sample.
struct Rotation {
    Wave cosine;
    Wave sine;
};

/// The rotation of a family's first harmonic. Eight samples are computed as such and turned on from there, in double
/// precision, so that the error does not grow over the segment.
Rotation firstHarmonic(double cycles, double cyclesPerSample) noexcept {
    constexpr std::size_t lanes = 8;
    static_assert(segmentSamples % lanes == 0);
    std::array<double, lanes> cosine{};
    std::array<double, lanes> sine{};
    for (std::size_t lane = 0; lane < lanes; ++lane) {
        const double angle = cycles + cyclesPerSample * (static_cast<double>(lane) + 0.5);
        const double radians = 2.0 * std::numbers::pi * (angle - std::round(angle));
        cosine[lane] = std::cos(radians);
        sine[lane] = std::sin(radians);
    }
    const double step = 2.0 * std::numbers::pi * cyclesPerSample * static_cast<double>(lanes);
    const double stepCosine = std::cos(step);
    const double stepSine = std::sin(step);
    Rotation rotation;
    for (std::size_t first = 0; first < rotation.cosine.size(); first += lanes) {
        for (std::size_t lane = 0; lane < lanes; ++lane) {
            rotation.cosine[first + lane] = static_cast<float>(cosine[lane]);
            rotation.sine[first + lane] = static_cast<float>(sine[lane]);
            const double turned = cosine[lane] * stepCosine - sine[lane] * stepSine;
            sine[lane] = cosine[lane] * stepSine + sine[lane] * stepCosine;
            cosine[lane] = turned;
        }
    }
    return rotation;
}

/// Turns `rotation` on by `step`.
void turn(Rotation& rotation, const Rotation& step) noexcept {
    for (std::size_t n = 0; n < rotation.cosine.size(); ++n) {
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

bool FamilyPhase::isHeard() const noexcept {
    return std::isfinite(cycles) && std::fabs(rateHz) > slowestHz && std::fabs(rateHz) < highestLineHz;
}

void SurfaceWaves::add(const FamilyPhase& phase, const FamilyGains& gains, Pulses* cosines, Pulses* sines) noexcept {
    isHeard_ = true;
    const double rateHz = std::fabs(phase.rateHz);
    const double cycles = phase.rateHz >= 0.0 ? phase.cycles : -phase.cycles;
    const Rotation first = firstHarmonic(cycles, rateHz / waveformRateHz);
    Rotation rotation = first;
    for (std::size_t index = 0; index < lineHarmonics; ++index) {
        const double harmonicHz = rateHz * static_cast<double>(index + 1);
        if (harmonicHz >= highestLineHz) {
            return;
        }
        if (index > 0) {
            turn(rotation, first);
        }
        const float lineCosine = lineGain(gains.lineCosine[index]);
        const float lineSine = lineGain(gains.lineSine[index]);
        for (std::size_t n = 0; n < lines_.size(); ++n) {
            lines_[n] += lineCosine * rotation.cosine[n] + lineSine * rotation.sine[n];
        }
        if (index >= swingHarmonics || harmonicHz >= highestSwingHz) {
            continue;
        }
        const float swingCosine = gains.swingCosine[index];
        const float swingSine = gains.swingSine[index];
        for (std::size_t n = 0; n < segmentSamples; ++n) {
            swing_[n] += swingCosine * rotation.cosine[n] + swingSine * rotation.sine[n];
        }
        if (cosines != nullptr && sines != nullptr) {
            for (std::size_t n = 0; n < segmentSamples; ++n) {
                (*cosines)[index][n] += rotation.cosine[n];
                (*sines)[index][n] += rotation.sine[n];
            }
        }
    }
}

}  // namespace haptoflow::skeleton
