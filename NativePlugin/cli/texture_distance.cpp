#include "texture_distance.hpp"

#include "dsp/fourier_transform.hpp"
#include "dsp/waveform_resampler.hpp"
#include "inference/skeleton_generator.hpp"
#include "skeleton/condition.hpp"
#include "skeleton/gaussian_noise.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <complex>
#include <cstddef>
#include <cstdint>
#include <numbers>
#include <span>
#include <utility>

namespace haptoflow::cli {
namespace {

/// 200 ms of a label's waveform at 2 kHz. Its level does not count.
using TextureExcerpt = std::array<float, model::seedSamples>;

constexpr std::size_t segment = inference::segmentSamples;
/// Segments made before the excerpt and thrown away, because the filter begins in silence.
constexpr std::size_t settlingSegments = 4;

/// A sketch that slides over a label at one motion.
TextureExcerpt sketched(inference::SkeletonGenerator& sketch, std::span<const float, model::embeddingSize> embedding,
                        const std::array<float, 3>& motion, std::uint32_t voice) {
    std::array<float, segment> previous{};
    std::array<float, segment> noise{};
    inference::SegmentRequest request{
        .embedding = {}, .motion = motion, .previous = previous, .noise = noise, .levelMps2 = 1.0F};
    std::ranges::copy(embedding, request.embedding.begin());
    request.phases = skeleton::phasesOf(embedding, motion, {});
    TextureExcerpt excerpt{};
    static_assert(excerpt.size() == 2 * segment);
    for (std::size_t index = 0; index < settlingSegments + 2; ++index) {
        skeleton::fillStandardNormal({.seed = 1, .voice = voice, .segment = index}, noise);
        std::shift_left(excerpt.begin(), excerpt.end(), segment);
        sketch.generate(std::span(&request, 1), std::span(excerpt).last<segment>());
        std::ranges::copy(std::span(excerpt).last<segment>(), previous.begin());
        request.phases = skeleton::advanced(request.phases, static_cast<double>(segment));
    }
    return excerpt;
}

/// What a label sounds like without the model's networks. The noise is fixed, so a label has the same excerpts each
/// time.
std::vector<TextureExcerpt> texturesOf(const model::ModelFile& model, const skeleton::NativeParts& native,
                                       std::size_t label) {
    const model::ModelHeader& header = model.header();
    std::vector<TextureExcerpt> excerpts;
    for (std::size_t seed = 0; seed < header.seeds.size(); ++seed) {
        if (header.seeds[seed].label == label) {
            std::ranges::copy(model.seed(seed), excerpts.emplace_back().begin());
        }
    }
    if (header.skeleton) {
        inference::SkeletonGenerator sketch(native, 1);
        for (const double speed : header.speedMps.percentiles) {
            for (const double force : header.forceNewtons.percentiles) {
                excerpts.push_back(sketched(sketch, model.embedding(label),
                                            {static_cast<float>(speed), 0.0F, static_cast<float>(force)},
                                            static_cast<std::uint32_t>(excerpts.size())));
            }
        }
    }
    return excerpts;
}

constexpr double rateHz = 8000.0;
constexpr std::size_t window = 1024;
constexpr double lowestHz = 20.0;
constexpr double highestHz = 1000.0;
constexpr double dynamicDecibels = 30.0;

/// Mean power in each bin, over windows that overlap by half.
using Spectrum = std::vector<double>;

void addPower(Spectrum& spectrum, const std::vector<float>& samples) {
    for (std::size_t start = 0; start + window <= samples.size(); start += window / 2) {
        std::vector<std::complex<double>> values(window);
        for (std::size_t i = 0; i < window; ++i) {
            const double turn = 2.0 * std::numbers::pi * static_cast<double>(i) / static_cast<double>(window);
            values[i] = (0.5 - 0.5 * std::cos(turn)) * static_cast<double>(samples[start + i]);
        }
        dsp::fourierTransform(values, dsp::Direction::forward);
        for (std::size_t bin = 0; bin < spectrum.size(); ++bin) {
            spectrum[bin] += std::norm(values[bin]);
        }
    }
}

double hzOf(std::size_t bin) {
    return static_cast<double>(bin) * rateHz / static_cast<double>(window);
}

/// The original and the played spectrum in dB, over the bins that are compared.
struct LabelSpectra {
    std::string label;
    std::vector<double> uncompensated;
    std::vector<double> compensated;
};

LabelSpectra spectraOf(const std::string& label, const std::vector<TextureExcerpt>& excerpts,
                       const effects::ActuatorProfile& profile, effects::Compensation& compensation) {
    Spectrum wanted(window / 2);
    Spectrum compensated(window / 2);
    for (const TextureExcerpt& excerpt : excerpts) {
        dsp::WaveformResampler resampler(rateHz);
        // Played twice: the filters settle during the first time.
        std::vector<float> texture(2 * 4 * excerpt.size());
        for (std::size_t turn = 0; turn < 2; ++turn) {
            resampler.process(excerpt, std::span(texture).subspan(turn * texture.size() / 2, texture.size() / 2));
        }
        std::vector<float> played = texture;
        compensation.reset();
        compensation.process(played);
        const auto half = static_cast<std::ptrdiff_t>(texture.size() / 2);
        addPower(wanted, {texture.begin() + half, texture.end()});
        addPower(compensated, {played.begin() + half, played.end()});
    }
    LabelSpectra spectra{.label = label, .uncompensated = {}, .compensated = {}};
    const double loudest = std::ranges::max(wanted);
    for (std::size_t bin = 0; bin < wanted.size(); ++bin) {
        if (hzOf(bin) < lowestHz || hzOf(bin) > highestHz ||
            wanted[bin] <= loudest * std::pow(10.0, -dynamicDecibels / 10.0)) {
            continue;
        }
        const double actuator = profile.magnitudeDecibelsAt(hzOf(bin));
        spectra.uncompensated.push_back(actuator);
        spectra.compensated.push_back(actuator + 10.0 * std::log10(compensated[bin] / wanted[bin]));
    }
    return spectra;
}

using Differences = std::vector<double> LabelSpectra::*;

/// The gain that is best for all labels together: the mean of their mean differences.
double strengthDecibels(const std::vector<LabelSpectra>& labels, Differences differences) {
    double sum = 0.0;
    for (const LabelSpectra& label : labels) {
        double labelSum = 0.0;
        for (const double difference : label.*differences) {
            labelSum += difference;
        }
        sum += labelSum / static_cast<double>((label.*differences).size());
    }
    return sum / static_cast<double>(labels.size());
}

double distance(const LabelSpectra& label, Differences differences, double strength) {
    double sum = 0.0;
    for (const double difference : label.*differences) {
        sum += (difference - strength) * (difference - strength);
    }
    return std::sqrt(sum / static_cast<double>((label.*differences).size()));
}

}  // namespace

std::vector<TextureDistance> textureDistances(const model::ModelFile& model, const effects::ActuatorProfile& profile,
                                              const effects::CompensationSettings& settings) {
    effects::Compensation compensation(profile, rateHz, settings);
    const skeleton::NativeParts native = skeleton::readNativeParts(model);
    std::vector<LabelSpectra> labels;
    for (std::size_t label = 0; label < model.header().labels.size(); ++label) {
        LabelSpectra spectra =
            spectraOf(model.header().labels[label].name, texturesOf(model, native, label), profile, compensation);
        if (!spectra.compensated.empty()) {
            labels.push_back(std::move(spectra));
        }
    }
    std::vector<TextureDistance> distances;
    if (labels.empty()) {
        return distances;
    }
    const double without = strengthDecibels(labels, &LabelSpectra::uncompensated);
    const double with = strengthDecibels(labels, &LabelSpectra::compensated);
    for (const LabelSpectra& label : labels) {
        distances.push_back({.label = label.label,
                             .uncompensatedDecibels = distance(label, &LabelSpectra::uncompensated, without),
                             .compensatedDecibels = distance(label, &LabelSpectra::compensated, with)});
    }
    return distances;
}

}  // namespace haptoflow::cli
