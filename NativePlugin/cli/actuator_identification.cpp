#include "actuator_identification.hpp"

#include "dsp/fourier_transform.hpp"
#include "effects/parallel_filter.hpp"
#include "messages.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <numbers>
#include <utility>

namespace haptoflow::cli {
namespace {

using Complex = std::complex<double>;

constexpr double twoPi = 2.0 * std::numbers::pi;
constexpr double pointsPerOctave = 24.0;
constexpr double smoothingOctaves = 1.0 / 12.0;
// Excluded from the profile at either end of the sweep's range, where the deconvolution is faded in.
constexpr double edgeOctaves = 1.0 / 6.0;
// Excluded at the lower end in addition: about the resolution of the window over the response.
constexpr double edgeHz = 4.0;
// Longer than the response of any such actuator.
constexpr double ringingSeconds = 0.4;
constexpr double leadSeconds = 0.1;
constexpr double minimumRingingSeconds = 0.05;
constexpr int maximumHarmonic = 5;
constexpr double minimumSignalToNoiseDecibels = 6.0;
constexpr std::size_t minimumPoints = 24;

double rounded(double value, double perUnit) {
    return std::round(value * perUnit) / perUnit;
}

double powerDecibels(double power) {
    return 10.0 * std::log10(std::max(power, 1e-30));
}

void requireSignal(const Recording& recording, const ExponentialSweep& sweep, const std::string& name) {
    constexpr float silent = 1e-4F;
    constexpr float full = 0.999F;
    const double seconds = static_cast<double>(recording.samples.size()) / recording.rateHz;
    if (seconds < sweep.seconds) {
        throw InputError(name + ": lasts " + fixedDecimals(seconds, 1) + " s, but the sweep alone lasts " +
                         fixedDecimals(sweep.seconds, 1) +
                         " s; record from before the sweep until the silence after it");
    }
    const float peak = std::abs(std::ranges::max(recording.samples, {}, [](float each) { return std::abs(each); }));
    if (peak < silent) {
        throw InputError(name + ": is silent (peak " +
                         fixedDecimals(powerDecibels(static_cast<double>(peak) * peak), 0) +
                         " dB of full scale); check the sensor, its channel (--channel) and the recording level");
    }
    const auto atFull = std::ranges::count_if(recording.samples, [](float each) { return std::abs(each) >= full; });
    constexpr int maximumAtFull = 8;
    if (peak <= 1.0F && atFull > maximumAtFull) {
        throw InputError(name + ": is clipped, " + std::to_string(atFull) +
                         " samples are at full scale; lower the recording level, or the sweep's --level");
    }
}

/// The deconvolution of the recording by the sweep: the impulse response and, before it, those of the harmonics.
class ImpulseResponse {
public:
    ImpulseResponse(const Recording& recording, const ExponentialSweep& sweep) : rateHz_(recording.rateHz) {
        const std::vector<float> played = sweep.samples(rateHz_);
        values_.resize(std::bit_ceil(recording.samples.size() + played.size()));
        for (std::size_t i = 0; i < played.size(); ++i) {
            values_[i].real(played[i]);
        }
        for (std::size_t i = 0; i < recording.samples.size(); ++i) {
            values_[i].imag(recording.samples[i]);
        }
        dsp::fourierTransform(values_, dsp::Direction::forward);
        deconvolve(sweep);
        dsp::fourierTransform(values_, dsp::Direction::inverse);
    }

    [[nodiscard]] double rateHz() const { return rateHz_; }
    /// The value at a lag in samples, which may be negative. Its magnitude is the envelope.
    [[nodiscard]] Complex at(std::int64_t lag) const {
        const auto length = static_cast<std::int64_t>(values_.size());
        return values_[static_cast<std::size_t>(((lag % length) + length) % length)];
    }
    [[nodiscard]] std::int64_t length() const { return static_cast<std::int64_t>(values_.size()); }

    [[nodiscard]] double energy(std::int64_t from, std::int64_t until) const {
        double sum = 0.0;
        for (std::int64_t lag = from; lag < until; ++lag) {
            sum += std::norm(at(lag));
        }
        return sum;
    }

private:
    // Sweep and recording were transformed together, as the real and imaginary part of one signal. Only positive
    // frequencies are kept, so that the result is complex: its real part is the response and its magnitude the
    // envelope.
    void deconvolve(const ExponentialSweep& sweep) {
        const std::size_t length = values_.size();
        for (std::size_t bin = 1; bin < length / 2; ++bin) {
            const Complex sum = values_[bin];
            const Complex mirrored = std::conj(values_[length - bin]);
            const Complex played = 0.5 * (sum + mirrored);
            const Complex recorded = Complex(0.0, -0.5) * (sum - mirrored);
            const double hz = static_cast<double>(bin) * rateHz_ / static_cast<double>(length);
            const double inside = std::min(std::log2(hz / sweep.fromHz), std::log2(sweep.toHz / hz)) / edgeOctaves;
            const double share = 0.5 - 0.5 * std::cos(std::numbers::pi * std::clamp(inside, 0.0, 1.0));
            values_[bin] = share > 0.0 ? 2.0 * share * recorded / played : 0.0;
        }
        std::fill(values_.begin() + static_cast<std::ptrdiff_t>(length / 2), values_.end(), 0.0);
        values_[0] = 0.0;
    }

    double rateHz_;
    std::vector<Complex> values_;
};

/// The part of an impulse response from `before` ahead of a lag to `after` behind it, faded at both ends, and its
/// spectrum with that lag as time 0.
class WindowedSpectrum {
public:
    WindowedSpectrum(const ImpulseResponse& response, double lag, double beforeSeconds, double afterSeconds)
        : rateHz_(response.rateHz()), centre_(std::llround(lag)) {
        const auto before = static_cast<std::int64_t>(beforeSeconds * rateHz_);
        const auto after = static_cast<std::int64_t>(afterSeconds * rateHz_);
        // A resolution of half a hertz or finer, so that a twelfth of an octave contains several bins.
        bins_.resize(std::max(std::bit_ceil(static_cast<std::size_t>(2.0 * rateHz_)),
                              std::bit_ceil(static_cast<std::size_t>(before + after))));
        for (std::int64_t i = -before; i < after; ++i) {
            const double ahead =
                static_cast<double>(i + before) / static_cast<double>(std::max<std::int64_t>(before, 1));
            const double behind = 2.0 * static_cast<double>(after - i) / static_cast<double>(after);
            const double share = std::clamp(std::min(ahead, behind), 0.0, 1.0);
            const double window = 0.5 - 0.5 * std::cos(std::numbers::pi * share);
            const auto index = static_cast<std::size_t>(i < 0 ? i + static_cast<std::int64_t>(bins_.size()) : i);
            bins_[index] = window * response.at(centre_ + i).real();
            windowPower_ += window * window;
        }
        dsp::fourierTransform(bins_, dsp::Direction::forward);
    }

    /// The lag in samples.
    [[nodiscard]] double centre() const { return static_cast<double>(centre_); }
    [[nodiscard]] double windowPower() const { return windowPower_; }

    [[nodiscard]] double powerAt(double hz) const {
        const auto [first, last] = binsAround(hz);
        double sum = 0.0;
        for (std::size_t bin = first; bin <= last; ++bin) {
            sum += std::norm(bins_[bin]);
        }
        return sum / static_cast<double>(last - first + 1);
    }

    [[nodiscard]] Complex meanAt(double hz) const {
        const auto [first, last] = binsAround(hz);
        Complex sum = 0.0;
        for (std::size_t bin = first; bin <= last; ++bin) {
            sum += bins_[bin];
        }
        return sum / static_cast<double>(last - first + 1);
    }

private:
    [[nodiscard]] std::pair<std::size_t, std::size_t> binsAround(double hz) const {
        const double half = std::exp2(0.5 * smoothingOctaves);
        const double perHz = static_cast<double>(bins_.size()) / rateHz_;
        const auto first = static_cast<std::size_t>(std::llround(hz / half * perHz));
        const auto last = static_cast<std::size_t>(std::llround(hz * half * perHz));
        return {first, std::max(first, last)};
    }

    double rateHz_;
    std::int64_t centre_;
    double windowPower_ = 0.0;
    std::vector<Complex> bins_;
};

/// The time at which the response begins, and how much of it the recording contains.
struct Arrival {
    /// In samples of the recording.
    double lag = 0.0;
    double leadSeconds = 0.0;
    double ringingSeconds = 0.0;
};

[[noreturn]] void refuseOtherSignal(const std::string& name) {
    throw InputError(
        name +
        ": does not contain the sweep; expected a recording of the file that --sweep names, played once at the "
        "rate that it states, louder than the noise");
}

Arrival findArrival(const ImpulseResponse& response, const Recording& recording, const ExponentialSweep& sweep,
                    const std::string& name) {
    const std::int64_t recorded = std::ssize(recording.samples);
    const std::int64_t played = std::llround(sweep.seconds * recording.rateHz);
    std::vector<double> powers;
    std::int64_t peak = 0;
    for (std::int64_t lag = -played; lag < recorded; ++lag) {
        powers.push_back(std::norm(response.at(lag)));
        peak = powers.back() > std::norm(response.at(peak)) ? lag : peak;
    }
    const auto middle = powers.begin() + std::ssize(powers) / 2;
    std::ranges::nth_element(powers, middle);
    constexpr double minimumPeakToMedian = 100.0;
    if (!(std::norm(response.at(peak)) > minimumPeakToMedian * *middle)) {
        refuseOtherSignal(name);
    }
    const double octave = std::numbers::ln2 * sweep.secondsPerNeper();
    const double tail = static_cast<double>(recorded - played - peak) / recording.rateHz;
    if (static_cast<double>(peak) < -leadSeconds * recording.rateHz) {
        throw InputError(name + ": begins " + fixedDecimals(-static_cast<double>(peak) / recording.rateHz, 2) +
                         " s after the sweep has begun; start recording first, then play");
    }
    const Arrival arrival{.lag = static_cast<double>(peak),
                          .leadSeconds = std::min(leadSeconds, 0.4 * octave),
                          .ringingSeconds = std::min(ringingSeconds, 0.5 * (tail - leadSeconds))};
    if (arrival.ringingSeconds < minimumRingingSeconds) {
        throw InputError(name + ": is too short, it ends " + fixedDecimals(std::abs(tail), 2) + " s " +
                         (tail < 0.0 ? "before" : "after") + " the sweep does; record until " +
                         fixedDecimals(ExponentialSweep::silenceSeconds, 0) + " s of silence have followed");
    }
    const auto lead = static_cast<std::int64_t>(arrival.leadSeconds * recording.rateHz);
    const auto length = lead + static_cast<std::int64_t>(arrival.ringingSeconds * recording.rateHz);
    const double inside = response.energy(peak - lead, peak - lead + length);
    // With another sweep the response is spread over seconds. Distortion comes before the response and is smaller.
    constexpr double minimumOverBefore = 3.0;
    constexpr double minimumOverAfter = 10.0;
    if (inside < minimumOverBefore * response.energy(peak - lead - length, peak - lead) ||
        inside < minimumOverAfter * response.energy(peak - lead + length, peak - lead + 2 * length)) {
        refuseOtherSignal(name);
    }
    return arrival;
}

/// The measurement at one frequency, as ratios of recorded to played power.
struct Reading {
    double hz = 0.0;
    double power = 0.0;
    double noise = 0.0;
    /// NaN if no harmonic lies within the sweep's range.
    double distortion = std::numeric_limits<double>::quiet_NaN();
    /// Phase with the arrival's lag as time 0.
    double phaseRadians = 0.0;

    [[nodiscard]] double signalToNoise() const { return powerDecibels(power) - powerDecibels(noise); }
};

std::vector<Reading> readSpectra(const ImpulseResponse& response, const Arrival& arrival,
                                 const ExponentialSweep& sweep) {
    const double rateHz = response.rateHz();
    const WindowedSpectrum linear(response, arrival.lag, arrival.leadSeconds, arrival.ringingSeconds);
    const WindowedSpectrum noise(response, arrival.lag + (arrival.ringingSeconds + arrival.leadSeconds) * rateHz,
                                 arrival.leadSeconds, arrival.ringingSeconds);
    const double lowestHz = sweep.fromHz * std::exp2(edgeOctaves) + edgeHz;
    const double highestHz = sweep.toHz / std::exp2(edgeOctaves);
    std::vector<Reading> readings;
    for (int point = 0; lowestHz * std::exp2(point / pointsPerOctave) <= highestHz * (1.0 + 1e-9); ++point) {
        const double hz = lowestHz * std::exp2(point / pointsPerOctave);
        const double noisePower = noise.powerAt(hz);
        const double power = linear.powerAt(hz);
        readings.push_back({.hz = hz,
                            .power = std::max(power - noisePower, 1e-3 * power),
                            .noise = noisePower,
                            .phaseRadians = std::arg(linear.meanAt(hz))});
    }
    for (int harmonic = 2; harmonic <= maximumHarmonic; ++harmonic) {
        const double neper = sweep.secondsPerNeper();
        const double lag = arrival.lag - neper * std::log(harmonic) * rateHz;
        const double toNext = neper * std::log((harmonic + 1.0) / harmonic);
        const double toPrevious = neper * std::log(harmonic / (harmonic - 1.0));
        const WindowedSpectrum spectrum(response, lag, std::min(arrival.leadSeconds, 0.3 * toNext),
                                        std::min(arrival.ringingSeconds, 0.7 * toPrevious));
        for (Reading& reading : readings) {
            if (reading.hz * harmonic <= highestHz) {
                const double floor =
                    noise.powerAt(reading.hz * harmonic) * spectrum.windowPower() / noise.windowPower();
                const double power = std::max(spectrum.powerAt(reading.hz * harmonic) - floor, 0.0);
                reading.distortion = (harmonic == 2 ? 0.0 : reading.distortion) + power;
            }
        }
    }
    return readings;
}

/// Removes the ends of the range where the response does not exceed the noise.
void trim(std::vector<Reading>& readings, const std::string& name) {
    const auto stands = [](const Reading& reading) { return reading.signalToNoise() >= minimumSignalToNoiseDecibels; };
    readings.erase(readings.begin(), std::ranges::find_if(readings, stands));
    while (!readings.empty() && !stands(readings.back())) {
        readings.pop_back();
    }
    const auto standing = static_cast<std::size_t>(std::ranges::count_if(readings, stands));
    if (standing < minimumPoints || 2 * standing < readings.size()) {
        throw InputError(name + ": is too noisy, only " + std::to_string(standing) + " of " +
                         std::to_string(readings.size()) +
                         " frequencies stand out of the noise; raise the sweep's --level or --seconds");
    }
}

/// The phase of a minimum-phase system with the measured magnitude, which is extrapolated beyond both ends.
std::vector<double> minimumPhaseOf(const std::vector<Reading>& readings) {
    constexpr int beyond = static_cast<int>(4.0 * pointsPerOctave);
    constexpr std::size_t end = 8;
    constexpr double steepest = 4.0 * std::numbers::ln2 / pointsPerOctave;
    std::vector<double> nepers;
    const auto at = [&readings](std::size_t index) { return 0.5 * std::log(readings[index].power); };
    const std::size_t last = readings.size() - 1;
    const double falling = std::clamp((at(0) - at(end)) / static_cast<double>(end), -steepest, steepest);
    const double rising = std::clamp((at(last) - at(last - end)) / static_cast<double>(end), -steepest, steepest);
    for (int point = -beyond; point < static_cast<int>(readings.size()) + beyond; ++point) {
        const auto index = static_cast<std::size_t>(std::clamp(point, 0, static_cast<int>(last)));
        const double outside = point < 0 ? -point * falling : std::max(point - static_cast<int>(last), 0) * rising;
        nepers.push_back(at(index) + outside);
    }
    const std::vector<double> phase = effects::minimumPhaseRadians(nepers, 1.0 / pointsPerOctave);
    return {phase.begin() + beyond, phase.end() - beyond};
}

/// The delay in addition to the arrival's lag that brings the response closest to minimum phase. Throws InputError if
/// it is still far from that: the recording then is not the sweep at the rate that the file states.
double excessDelaySeconds(const std::vector<Reading>& readings, const std::string& name) {
    const std::vector<double> minimum = minimumPhaseOf(readings);
    std::vector<double> excess;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        const double phase = readings[i].phaseRadians - minimum[i];
        const double previous = excess.empty() ? phase : excess.back();
        excess.push_back(previous + std::remainder(phase - previous, twoPi));
    }
    double weights = 0.0;
    double meanHz = 0.0;
    double meanExcess = 0.0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        weights += readings[i].power;
        meanHz += readings[i].power * readings[i].hz;
        meanExcess += readings[i].power * excess[i];
    }
    meanHz /= weights;
    meanExcess /= weights;
    double covariance = 0.0;
    double variance = 0.0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        covariance += readings[i].power * (readings[i].hz - meanHz) * (excess[i] - meanExcess);
        variance += readings[i].power * (readings[i].hz - meanHz) * (readings[i].hz - meanHz);
    }
    // At 0 Hz the phase is 0, or half a turn if the wires are swapped.
    const double atZero = meanExcess - covariance / variance * meanHz;
    const double offset = std::numbers::pi * std::round(atZero / std::numbers::pi);
    double slope = 0.0;
    double squares = 0.0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        slope += readings[i].power * readings[i].hz * (excess[i] - offset);
        squares += readings[i].power * readings[i].hz * readings[i].hz;
    }
    slope /= squares;
    double rest = 0.0;
    for (std::size_t i = 0; i < readings.size(); ++i) {
        rest += readings[i].power * std::pow(excess[i] - offset - slope * readings[i].hz, 2.0);
    }
    constexpr double maximumRestRadians = 4.0;
    if (std::sqrt(rest / weights) > maximumRestRadians) {
        refuseOtherSignal(name);
    }
    return -slope / twoPi;
}

/// The peaks that are 3 dB above the lowest value between them and a higher peak or the end of the range.
std::vector<double> findResonances(const std::vector<double>& hz, const std::vector<double>& decibels) {
    constexpr double prominence = 3.0;
    std::vector<double> found;
    for (std::size_t i = 1; i + 1 < decibels.size(); ++i) {
        if (decibels[i] < decibels[i - 1] || decibels[i] <= decibels[i + 1]) {
            continue;
        }
        double lowestLeft = decibels[i];
        for (std::size_t j = i; j-- > 0 && decibels[j] <= decibels[i];) {
            lowestLeft = std::min(lowestLeft, decibels[j]);
        }
        double lowestRight = decibels[i];
        for (std::size_t j = i + 1; j < decibels.size() && decibels[j] <= decibels[i]; ++j) {
            lowestRight = std::min(lowestRight, decibels[j]);
        }
        if (decibels[i] - std::max(lowestLeft, lowestRight) >= prominence) {
            const double curve = decibels[i - 1] - 2.0 * decibels[i] + decibels[i + 1];
            const double shift = curve < 0.0 ? 0.5 * (decibels[i - 1] - decibels[i + 1]) / curve : 0.0;
            found.push_back(rounded(hz[i] * std::exp2(shift / pointsPerOctave), 10.0));
        }
    }
    constexpr std::size_t most = 16;
    found.resize(std::min(found.size(), most));
    return found;
}

double distortionPercent(const std::vector<Reading>& readings) {
    double harmonics = 0.0;
    double fundamental = 0.0;
    for (const Reading& reading : readings) {
        if (std::isfinite(reading.distortion)) {
            harmonics += reading.distortion;
            fundamental += reading.power;
        }
    }
    return fundamental > 0.0 ? 100.0 * std::sqrt(harmonics / fundamental) : 0.0;
}

std::string provenanceOf(const IdentificationSettings& settings, const ExponentialSweep& sweep) {
    return "Measured by `haptoflow actuator identify` from " + settings.recordingName + ", an exponential sweep of " +
           fixedDecimals(sweep.fromHz, 0) + " to " + fixedDecimals(sweep.toHz, 0) + " Hz in " +
           fixedDecimals(sweep.seconds, 1) + " s at a level of " + fixedDecimals(sweep.level, 3) + '.';
}

}  // namespace

Identification identifyActuator(const Recording& recording, const ExponentialSweep& sweep,
                                const IdentificationSettings& settings) {
    requireSignal(recording, sweep, settings.recordingName);
    if (sweep.toHz > 0.45 * recording.rateHz) {
        throw InputError(settings.recordingName + ": has a rate of " + fixedDecimals(recording.rateHz, 0) +
                         " Hz, too low for a sweep to " + fixedDecimals(sweep.toHz, 0) +
                         " Hz; record at a higher rate");
    }
    const ImpulseResponse response(recording, sweep);
    const Arrival arrival = findArrival(response, recording, sweep, settings.recordingName);
    std::vector<Reading> readings = readSpectra(response, arrival, sweep);
    trim(readings, settings.recordingName);
    const double excessSeconds = excessDelaySeconds(readings, settings.recordingName);

    Identification found;
    const double largest = std::ranges::max(readings, {}, &Reading::power).power;
    effects::ActuatorProfile& profile = found.profile;
    profile.name = settings.name;
    profile.provenance = provenanceOf(settings, sweep);
    if (settings.mps2PerUnit) {
        profile.ratedLevelMps2 = *settings.mps2PerUnit * std::sqrt(largest);
    }
    std::vector<double> signalToNoise;
    for (const Reading& reading : readings) {
        const double phase = reading.phaseRadians + twoPi * reading.hz * excessSeconds;
        profile.frequencyHz.push_back(rounded(reading.hz, 100.0));
        profile.magnitudeDecibels.push_back(rounded(powerDecibels(reading.power / largest), 100.0));
        profile.phaseDegrees.push_back(rounded(std::remainder(phase, twoPi) * 360.0 / twoPi, 10.0));
        found.noiseDecibels.push_back(powerDecibels(reading.noise / largest));
        found.distortionDecibels.push_back(std::isfinite(reading.distortion) && reading.distortion > 0.0
                                               ? powerDecibels(reading.distortion / largest)
                                               : std::numeric_limits<double>::quiet_NaN());
        signalToNoise.push_back(reading.signalToNoise());
    }
    profile.resonancesHz = findResonances(profile.frequencyHz, profile.magnitudeDecibels);
    profile.measurement =
        effects::ActuatorMeasurement{.sampleRateHz = recording.rateHz,
                                     .delaySeconds = rounded(arrival.lag / recording.rateHz + excessSeconds, 1e7),
                                     .distortionPercent = rounded(distortionPercent(readings), 100.0),
                                     .signalToNoiseDecibels = rounded(recordings::upperMedian(signalToNoise), 10.0)};
    return found;
}

}  // namespace haptoflow::cli
