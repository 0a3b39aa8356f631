#include "learning/texture_fit.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace haptoflow::learning {
namespace {

constexpr std::size_t maximumBins = 6;
constexpr std::size_t pastSamples = inference::segmentSamples;
constexpr std::size_t warmSamples = LoopSettings{}.warmSamples;
constexpr std::size_t chainSamples = LoopSettings{}.samples;
constexpr std::size_t frameHop = 64;
constexpr std::size_t hopAt72Hz = 28;
constexpr std::size_t mostDirections = 12;
constexpr double lowestHz = 15.0;
constexpr double highestHz = 900.0;
constexpr double powerFloor = 1e-7;
constexpr double envelopeWeight = 1.0;
constexpr double levelWeight = 0.3;
constexpr double lineWeight = 1.0;
constexpr double lineFloor = 3e-4;
constexpr double minimumLineFrames = 3.0;

struct Band {
    std::size_t first = 0;
    std::size_t end = 0;
};

std::vector<Band> bandsUpTo(double bandwidthHz) {
    constexpr double relativeWidth = 0.23;
    std::vector<Band> bands;
    double hertz = lowestHz;
    while (hertz < std::min(highestHz, bandwidthHz)) {
        const auto first = static_cast<std::size_t>(std::lround(hertz / hertzPerBin));
        const auto width = std::max<std::size_t>(1, static_cast<std::size_t>(relativeWidth * hertz / hertzPerBin));
        bands.push_back({first, std::min(first + width, spectrumBins)});
        hertz = static_cast<double>(first + width) * hertzPerBin;
    }
    return bands;
}

double bandPower(const TextureFigures& figures, const Band& band) {
    double sum = 0.0;
    for (std::size_t bin = band.first; bin < band.end; ++bin) {
        sum += figures.power[bin];
    }
    return sum / static_cast<double>(band.end - band.first);
}

double lineDistance(const TextureFigures& recorded, const TextureFigures& generated) {
    double sum = 0.0;
    double count = 0.0;
    for (std::size_t i = 0; i < ribPartials; ++i) {
        if (recorded.lineFrames[i] >= minimumLineFrames && generated.lineFrames[i] >= minimumLineFrames) {
            const double difference =
                10.0 * std::log10((generated.lines[i] + lineFloor) / (recorded.lines[i] + lineFloor));
            sum += difference * difference;
            count += 1.0;
        }
    }
    return count > 0.0 ? sum / count : 0.0;
}

double oneDistance(const TextureFigures& recorded, const TextureFigures& generated, const std::vector<Band>& bands) {
    double spectral = 0.0;
    for (const Band& band : bands) {
        const double difference =
            10.0 * std::log10((bandPower(generated, band) + powerFloor) / (bandPower(recorded, band) + powerFloor));
        spectral += difference * difference / static_cast<double>(bands.size());
    }
    double envelope = 0.0;
    for (std::size_t i = 0; i < envelopeFigures; ++i) {
        const double difference = decibelsPerNat * (generated.envelope[i] - recorded.envelope[i]);
        envelope += difference * difference / static_cast<double>(envelopeFigures);
    }
    const double level = 10.0 * std::log10((generated.meanSquare + powerFloor) / (recorded.meanSquare + powerFloor));
    return spectral + envelopeWeight * envelope + levelWeight * level * level +
           lineWeight * lineDistance(recorded, generated);
}

std::vector<RibTravel> ribTravelsAlong(const recordings::PreparedRecording& recording,
                                       std::span<const float, 2 * inference::ribCount> waveVectors) {
    constexpr double millimetresPerSample = 1000.0 / inference::waveformRateHz;
    if (std::ranges::all_of(waveVectors, [](float value) { return value == 0.0F; })) {
        return {};
    }
    std::vector<RibTravel> ribTravels(recording.motion.size());
    RibTravel way{};
    for (std::size_t i = 0; i < ribTravels.size(); ++i) {
        ribTravels[i] = way;
        for (std::size_t rib = 0; rib < way.size(); ++rib) {
            way[rib] += millimetresPerSample * (static_cast<double>(waveVectors[2 * rib]) * recording.motion[i][0] +
                                                static_cast<double>(waveVectors[2 * rib + 1]) * recording.motion[i][1]);
        }
    }
    return ribTravels;
}

std::vector<double> slidingSpeeds(const recordings::PreparedRecording& recording, const Sliding& sliding) {
    std::vector<double> speeds;
    for (std::size_t i = 0; i < sliding.isSliding.size(); ++i) {
        if (sliding.isSliding[i] != 0) {
            speeds.push_back(recording.speedMps(i));
        }
    }
    return speeds;
}

}  // namespace

double textureDistance(std::span<const TextureFigures> recorded, std::span<const TextureFigures> generated,
                       double bandwidthHz) {
    const std::vector<Band> bands = bandsUpTo(bandwidthHz);
    return meanOverSpeeds(recorded, generated, [&bands](const TextureFigures& one, const TextureFigures& other) {
        return oneDistance(one, other, bands);
    });
}

TextureFit::TextureFit(ClosedLoop& loop, const recordings::PreparedRecording& recording, const Sliding& sliding,
                       std::span<const float> unitWave, std::span<const float, 2 * inference::ribCount> waveVectors,
                       std::uint64_t seed)
    : loop_(loop),
      recording_(recording),
      sliding_(sliding),
      unitWave_(unitWave),
      ribTravels_(ribTravelsAlong(recording, waveVectors)),
      seed_(seed),
      bins_(SpeedBins::divide(slidingSpeeds(recording, sliding), maximumBins)) {
    TextureMeter meter(bins_.count());
    measure(meter, unitWave, 0);
    recorded_ = meter.figures();
    starts_ = startsByBin(chainSamples);
    const bool hasStart =
        std::ranges::any_of(starts_, [](const std::vector<std::size_t>& starts) { return !starts.empty(); });
    if (!hasStart) {
        throw recordings::RecordingUnusable(
            "the recording has no stretch of half a second without a gap that slides; record longer "
            "strokes");
    }
}

template <typename Use>
void TextureFit::forEachFrame(std::size_t samples, std::size_t start, std::size_t hop, Use use) const {
    for (std::size_t at = 0; at + spectrumSamples <= samples; at += hop) {
        if (sliding_.holds(start + at, spectrumSamples)) {
            use(at);
        }
    }
}

double TextureFit::meanSpeedMps(std::size_t first) const {
    double logSpeed = 0.0;
    for (std::size_t i = first; i < first + spectrumSamples; ++i) {
        logSpeed += std::log(recording_.speedMps(i)) / static_cast<double>(spectrumSamples);
    }
    return std::exp(logSpeed);
}

void TextureFit::measure(TextureMeter& meter, std::span<const float> wave, std::size_t start) const {
    forEachFrame(wave.size(), start, frameHop, [&](std::size_t at) {
        const std::span<const RibTravel> ribTravels = ribTravels_.empty()
                                                          ? std::span<const RibTravel>()
                                                          : std::span(ribTravels_).subspan(start + at, spectrumSamples);
        meter.add(bins_.binOf(meanSpeedMps(start + at)), wave.subspan(at).first<spectrumSamples>(), ribTravels);
    });
}

void TextureFit::addFrames(std::vector<SpectrumFrame>& frames, std::span<const float> wave, std::size_t start) const {
    forEachFrame(wave.size(), start, spectrumSamples / 2, [&](std::size_t at) {
        double force = 0.0;
        for (std::size_t i = start + at; i < start + at + spectrumSamples; ++i) {
            force += static_cast<double>(recording_.motion[i][2]) / static_cast<double>(spectrumSamples);
        }
        SpectrumFrame& frame = frames.emplace_back();
        frame.speedMps = meanSpeedMps(start + at);
        frame.forceNewtons = force;
        frame.power = powerOf(wave.subspan(at).first<spectrumSamples>());
        frame.first = start + at;
        std::ranges::copy(wave.subspan(at, spectrumSamples), frame.wave.begin());
    });
}

std::vector<SpectrumFrame> TextureFit::recordedFrames() const {
    std::vector<SpectrumFrame> frames;
    addFrames(frames, unitWave_, 0);
    return frames;
}

std::vector<std::vector<std::size_t>> TextureFit::startsByBin(std::size_t samples) const {
    constexpr std::size_t step = 50;
    constexpr double minimumSliding = 0.8;
    std::vector<std::vector<std::size_t>> starts(bins_.count());
    std::vector<std::size_t> usableBefore(recording_.isUsable.size() + 1);
    for (std::size_t i = 0; i < recording_.isUsable.size(); ++i) {
        usableBefore[i + 1] = usableBefore[i] + recording_.isUsable[i];
    }
    const std::size_t whole = pastSamples + warmSamples + samples;
    for (std::size_t first = 0; first + whole < recording_.isUsable.size(); first += step) {
        const std::size_t counted = first + pastSamples + warmSamples;
        const std::uint32_t sliding = sliding_.before[counted + samples] - sliding_.before[counted];
        if (usableBefore[first + whole] - usableBefore[first] == whole &&
            sliding >= minimumSliding * static_cast<double>(samples)) {
            double logSpeed = 0.0;
            for (std::size_t i = counted; i < counted + samples; ++i) {
                logSpeed +=
                    std::log(std::max(recording_.speedMps(i), minimumSlidingMps)) / static_cast<double>(samples);
            }
            starts[bins_.binOf(std::exp(logSpeed))].push_back(first + pastSamples);
        }
    }
    return starts;
}

std::vector<Chain> TextureFit::chainsOf(std::size_t count, std::uint64_t round) const {
    // A step with the golden ratio through each bin's stretches covers all of them evenly.
    constexpr double goldenShare = 0.6180339887498949;
    std::vector<Chain> chains;
    for (std::size_t k = 0; k < count; ++k) {
        const auto& starts = starts_[k % starts_.size()];
        if (starts.empty()) {
            continue;
        }
        const double turn = goldenShare * static_cast<double>(round * count + k + 1);
        const auto index = static_cast<std::size_t>((turn - std::floor(turn)) * static_cast<double>(starts.size()));
        chains.push_back({0, starts[std::min(index, starts.size() - 1)], static_cast<std::uint32_t>(k)});
    }
    return chains;
}

std::vector<TextureFigures> TextureFit::figuresOf(const Embedding& embedding, float impulseGain) {
    constexpr std::size_t chainsOfEachSpeed = 8;
    constexpr std::uint64_t ownRound = 3'000'000;
    const std::vector<Chain> chains = chainsOf(chainsOfEachSpeed * bins_.count(), ownRound);
    const std::vector<float> waves =
        loop_.run(std::span(&embedding, 1), chains, {.seed = seed_, .round = ownRound, .impulseGain = impulseGain});
    TextureMeter meter(bins_.count());
    for (std::size_t k = 0; k < chains.size(); ++k) {
        measure(meter, std::span(waves).subspan(k * chainSamples, chainSamples), chains[k].start + warmSamples);
    }
    return meter.figures();
}

std::vector<double> TextureFit::distances(std::span<const Embedding> embeddings, std::size_t chains,
                                          std::uint64_t round) {
    const std::vector<Chain> each = chainsOf(chains, round);
    std::vector<Chain> all;
    all.reserve(each.size() * embeddings.size());
    for (std::size_t e = 0; e < embeddings.size(); ++e) {
        for (Chain chain : each) {
            chain.embedding = e;
            all.push_back(chain);
        }
    }
    const std::vector<float> waves = loop_.run(embeddings, all, {.seed = seed_, .round = round});
    std::vector<double> result;
    for (std::size_t e = 0; e < embeddings.size(); ++e) {
        TextureMeter meter(bins_.count());
        for (std::size_t k = 0; k < each.size(); ++k) {
            measure(meter, std::span(waves).subspan((e * each.size() + k) * chainSamples, chainSamples),
                    each[k].start + warmSamples);
        }
        result.push_back(textureDistance(recorded_, meter.figures(), recording_.bandwidthHz));
    }
    return result;
}

std::vector<SpectrumFrame> TextureFit::generatedFrames(const Embedding& embedding, float impulseGain) {
    constexpr std::size_t maximumChains = 192;
    constexpr std::size_t defaultChains = 120;
    std::size_t available = 0;
    for (const auto& starts : starts_) {
        available += starts.size();
    }
    const std::size_t count = std::min(maximumChains, std::max(defaultChains, available / 20));
    std::vector<Chain> chains;
    for (std::size_t k = 0; k < count; ++k) {
        const auto& starts = starts_[k % starts_.size()];
        if (!starts.empty()) {
            const std::size_t place = k / starts_.size();
            const std::size_t places = (count + starts_.size() - 1) / starts_.size();
            chains.push_back({0, starts[place * starts.size() / places], static_cast<std::uint32_t>(k)});
        }
    }
    const std::vector<float> waves =
        loop_.run(std::span(&embedding, 1), chains,
                  {.hopSamples = hopAt72Hz, .seed = seed_, .round = 1'000'000, .impulseGain = impulseGain});
    std::vector<SpectrumFrame> frames;
    for (std::size_t k = 0; k < chains.size(); ++k) {
        addFrames(frames, std::span(waves).subspan(k * chainSamples, chainSamples), chains[k].start + warmSamples);
    }
    return frames;
}

void TextureFit::addSteadyChains(std::vector<Chain>& chains, double speedMps, double newtons, std::size_t count) const {
    constexpr std::size_t nearestShare = 12;
    constexpr double smallestNewtons = 1e-3;
    struct Near {
        double distance = 0.0;
        std::size_t start = 0;
    };
    const auto middleOf = [](std::size_t start) { return start + warmSamples + chainSamples / 2; };
    std::vector<Near> all;
    for (const auto& starts : starts_) {
        for (const std::size_t start : starts) {
            const std::size_t at = middleOf(start);
            const double force = std::max(static_cast<double>(recording_.motion[at][2]), smallestNewtons);
            const double speed = std::max(recording_.speedMps(at), minimumSlidingMps);
            all.push_back({std::hypot(std::log(speed / speedMps), std::log(force / newtons)), start});
        }
    }
    std::ranges::sort(all, {}, [](const Near& near) { return std::pair(near.distance, near.start); });
    const std::size_t among = std::min(all.size(), std::max(count, all.size() / nearestShare));
    for (std::size_t k = 0; k < count; ++k) {
        const std::size_t start = all[k * among / count].start;
        const auto& motion = recording_.motion[middleOf(start)];
        const auto scale =
            static_cast<float>(speedMps / std::max(recording_.speedMps(middleOf(start)), minimumSlidingMps));
        chains.push_back({.embedding = 0,
                          .start = start,
                          .noise = static_cast<std::uint32_t>(chains.size()),
                          .steadyMotion = {{motion[0] * scale, motion[1] * scale, static_cast<float>(newtons)}}});
    }
}

std::vector<SpectrumFrame> TextureFit::steadyFrames(const Embedding& embedding, std::span<const double> speedsMps,
                                                    std::span<const double> forcesNewtons, std::uint64_t segmentBudget,
                                                    float impulseGain) {
    constexpr std::size_t steadySamples = 1024;
    constexpr std::size_t segments = (warmSamples + steadySamples + hopAt72Hz - 1) / hopAt72Hz;
    const auto count = static_cast<std::size_t>(std::clamp<std::uint64_t>(
        segmentBudget / (segments * speedsMps.size() * forcesNewtons.size()), 2, mostDirections));
    std::vector<Chain> chains;
    for (const double force : forcesNewtons) {
        for (const double speed : speedsMps) {
            addSteadyChains(chains, speed, force, count);
        }
    }
    const std::vector<float> waves = loop_.run(std::span(&embedding, 1), chains,
                                               {.hopSamples = hopAt72Hz,
                                                .samples = steadySamples,
                                                .seed = seed_,
                                                .round = 2'000'000,
                                                .impulseGain = impulseGain});
    std::vector<SpectrumFrame> frames;
    for (std::size_t k = 0; k < chains.size(); ++k) {
        const auto& motion = *chains[k].steadyMotion;
        for (std::size_t at = 0; at + spectrumSamples <= steadySamples; at += spectrumSamples / 2) {
            SpectrumFrame& frame = frames.emplace_back();
            frame.speedMps = std::hypot(static_cast<double>(motion[0]), static_cast<double>(motion[1]));
            frame.forceNewtons = motion[2];
            frame.power = powerOf(std::span(waves).subspan(k * steadySamples + at).first<spectrumSamples>());
        }
    }
    return frames;
}

}  // namespace haptoflow::learning
