#include "learning/learner.hpp"

#include "inference/inference_error.hpp"
#include "learning/closed_loop.hpp"
#include "learning/embedding_space.hpp"
#include "learning/evolution_strategy.hpp"
#include "learning/level_law.hpp"
#include "learning/material_frame.hpp"
#include "learning/material_text.hpp"
#include "learning/seed_choice.hpp"
#include "learning/seed_ribs.hpp"
#include "learning/sliding.hpp"
#include "learning/texture_fit.hpp"
#include "learning/thread_clock.hpp"
#include "learning/tone_fit.hpp"
#include "learning/wave_vectors.hpp"
#include "model/material_file.hpp"
#include "model/name_index.hpp"
#include "model/plain_text.hpp"
#include "recordings/prepared_recording.hpp"
#include "recordings/recording.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <stdexcept>

namespace haptoflow::learning {
namespace {

constexpr double fewSeconds = 10.0;
constexpr float maximumUnitSample = 12.0F;
/// A level this far from those of all labels is probably in another unit.
constexpr double suspiciousLevelDb = 30.0;
constexpr double degreesPerRadian = 57.29577951308232;
constexpr double decibelsPerNat = 8.685889638065037;
constexpr std::size_t population = 12;
constexpr double firstStep = 0.45;
/// Weight that draws coordinates to the labels' mean, in dB^2 per squared standard deviation.
constexpr double shrinkage = 0.06;
/// Segments of one chain of the fit; see TextureFit::distances.
constexpr std::uint64_t segmentsPerChain = 8;
/// Shares of the time limit at which the search among the labels and the fit end.
constexpr double labelShare = 0.4;
constexpr double fitShare = 0.9;

class Learner {
public:
    Learner(const recordings::Recording& recording, const model::ModelFile& model,
            inference::SegmentGenerator& generator, const LearningSettings& settings)
        : model_(model), generator_(generator), settings_(settings), began_(threadSeconds()) {
        say(0.0, "reading");
        checkSettings(settings);
        recordings::checkRecording(recording);
        recording_ = recordings::prepareRecording(recording);
        sliding_ = findSliding(recording_, model.header());
        if (recording.seconds() > recordings::maximumSeconds) {
            report_.warnings.push_back("only the first " + recordings::plainNumber(recordings::maximumSeconds) +
                                       " s were read");
        }
    }

    LearntMaterial learn() {
        describe();
        level_ = fitLevelLaw(recording_, sliding_, labelPrior());
        checkLevel();
        makeUnitWave();
        say(0.05, "wave vectors");
        findRibs();
        const EmbeddingSpace space(model_, waveVectors_);
        ClosedLoop loop(generator_, model_.header(), recording_, unitWave_);
        TextureFit fit(loop, recording_, sliding_, unitWave_, waveVectors_, settings_.seed);
        say(0.1, "nearest label");
        const std::size_t nearest = nearestLabel(fit, space);
        const model::Label& label = model_.header().labels[nearest];
        report_.nearestLabel = label.name;
        Embedding embedding = fitEmbedding(fit, space, space.ofLabel(nearest));
        say(0.9, "tone");
        ToneFit tone = fitTones(fit, embedding);
        std::vector<LearntSeed> seeds = chooseSeeds(recording_, sliding_, unitWave_, tone.tone);
        placeRibs(seeds, loop, embedding, settings_.seed);
        report_.seeds = seeds.size();
        report_.toneSpeeds = tone.tone.speedsMps.size();
        report_.speedExponent = level_.speedExponent;
        report_.forceExponent = level_.table.forceExponent;
        report_.segments = loop.segments();
        report_.seconds = elapsedSeconds();
        LearntMaterial learnt;
        learnt.materialJson = materialText(model_, {.settings = settings_,
                                                    .report = report_,
                                                    .nearest = label,
                                                    .embedding = embedding,
                                                    .level = level_,
                                                    .tone = tone.tone,
                                                    .frequencyExponent = frequencyExponent(fit, label),
                                                    .wavelengthMetres = wavelengthMetres(),
                                                    .seeds = seeds});
        requireReadable(learnt.materialJson);
        say(1.0, "done");
        learnt.report = std::move(report_);
        return learnt;
    }

private:
    /// Processor time of this thread, which other programs do not affect.
    [[nodiscard]] double elapsedSeconds() const { return threadSeconds() - began_; }

    /// True if this share of the limit has been used; adds a warning the first time.
    bool isOutOfTime(double share) {
        if (elapsedSeconds() <= share * settings_.secondsLimit) {
            return false;
        }
        if (!report_.stoppedEarly) {
            report_.stoppedEarly = true;
            report_.warnings.push_back("the fit was stopped by the limit of " +
                                       recordings::plainNumber(settings_.secondsLimit) +
                                       " s: another run may learn another material");
        }
        return true;
    }

    void say(double share, const char* doing) const {
        if (settings_.cancellation != nullptr && settings_.cancellation->isCancelled()) {
            throw inference::LoadCancelled("learning was cancelled");
        }
        if (settings_.progress) {
            settings_.progress(share, doing);
        }
    }

    void describe() {
        report_.slidingSeconds = sliding_.seconds;
        report_.speedMps = {sliding_.speedMps[0], sliding_.speedMps[2]};
        report_.forceNewtons = {sliding_.forceNewtons[0], sliding_.forceNewtons[2]};
        if (sliding_.seconds < fewSeconds) {
            report_.warnings.push_back("the tip slides for " + recordings::plainNumber(sliding_.seconds) +
                                       " s; 10 s or more give a more accurate material");
        }
        if (sliding_.speedMps[2] < 1.3 * sliding_.speedMps[0]) {
            report_.warnings.emplace_back(
                "the speed hardly changes: its effect on level and spectrum is taken from the model's labels");
        }
        const double lost = 1.0 - std::accumulate(recording_.isUsable.begin(), recording_.isUsable.end(), 0.0) /
                                      static_cast<double>(recording_.isUsable.size());
        if (lost > 0.0) {
            report_.warnings.push_back(recordings::plainNumber(100.0 * lost) +
                                       " % of the recording was left out around missing or frozen samples");
        }
    }

    /// The reader of the library has the last word on what was learnt.
    static void requireReadable(const std::string& material) {
        try {
            (void)model::parseMaterial(material);
        } catch (const model::MaterialError& error) {
            throw recordings::RecordingUnusable(std::string("gives a material that HaptoFlow would refuse (") +
                                                error.what() +
                                                "); check the units and the extreme values of the recording");
        }
    }

    [[nodiscard]] ExponentPrior labelPrior() const {
        const auto& labels = model_.header().labels;
        ExponentPrior prior;
        if (labels.size() < 3) {
            return prior;
        }
        const auto statistics = [&](auto exponent, double& mean, double& spread) {
            mean = 0.0;
            double squares = 0.0;
            for (const model::Label& label : labels) {
                mean += exponent(label) / static_cast<double>(labels.size());
            }
            for (const model::Label& label : labels) {
                squares += (exponent(label) - mean) * (exponent(label) - mean);
            }
            spread = std::clamp(std::sqrt(squares / static_cast<double>(labels.size())), 0.05, 0.5);
        };
        statistics([](const model::Label& label) { return label.speedLevelExponent; }, prior.speedMean,
                   prior.speedSpread);
        statistics([](const model::Label& label) { return label.forceLevelExponent; }, prior.forceMean,
                   prior.forceSpread);
        return prior;
    }

    /// Checks the level, which is the only sign of a unit that is wrong by a factor of ten or a thousand.
    void checkLevel() {
        const double speed = std::min(sliding_.speedMps[1], model_.header().speedMps.maximum);
        const double force = std::clamp(sliding_.forceNewtons[1], model_.header().forceNewtons.minimum,
                                        model_.header().forceNewtons.maximum);
        std::vector<inference::SegmentRequest> requests;
        for (std::size_t label = 0; label < model_.header().labels.size(); ++label) {
            inference::SegmentRequest request{
                {}, {static_cast<float>(speed), 0.0F, static_cast<float>(force)}, silence_, silence_, {}, {}, {}};
            std::ranges::copy(model_.embedding(label), request.embedding.begin());
            requests.push_back(request);
        }
        std::vector<float> levels(requests.size());
        generator_.levels(requests, levels);
        const auto [quietest, loudest] = std::ranges::minmax(levels);
        const double own = std::exp(level_.logLevel(speed, force));
        const double belowDb = decibelsPerNat * std::log(quietest / own);
        const double aboveDb = decibelsPerNat * std::log(own / loudest);
        if (belowDb > suspiciousLevelDb || aboveDb > suspiciousLevelDb) {
            report_.warnings.push_back("the level, " + recordings::plainNumber(own) + " m/s^2 RMS at " +
                                       recordings::plainNumber(1000.0 * speed) + " mm/s, is " +
                                       recordings::plainNumber(std::max(belowDb, aboveDb)) + " dB " +
                                       (belowDb > 0.0 ? "below" : "above") + " every label of the model (" +
                                       recordings::plainNumber(quietest) + " to " + recordings::plainNumber(loudest) +
                                       " m/s^2); check the unit or full scale of the acceleration");
        }
        if (belowDb > 2.0 * suspiciousLevelDb || aboveDb > 2.0 * suspiciousLevelDb) {
            throw recordings::RecordingUnusable(report_.warnings.back());
        }
    }

    void makeUnitWave() {
        unitWave_.resize(recording_.wave.size());
        for (std::size_t i = 0; i < unitWave_.size(); ++i) {
            const double speed = std::max(recording_.speedMps(i), minimumSlidingMps);
            const double level = std::exp(level_.logLevel(speed, recording_.motion[i][2]));
            unitWave_[i] =
                std::clamp(static_cast<float>(recording_.wave[i] / level), -maximumUnitSample, maximumUnitSample);
        }
    }

    /// Rotates the recording so that its most distinct ribs are perpendicular to the first axis.
    void findRibs() {
        std::vector<WaveVector> vectors;
        if (settings_.waveVectors) {
            for (std::size_t rib = 0; rib < inference::ribCount; ++rib) {
                vectors.push_back({(*settings_.waveVectors)[2 * rib], (*settings_.waveVectors)[2 * rib + 1]});
            }
        } else {
            vectors = findWaveVectors(recording_, sliding_);
        }
        const MaterialFrame frame = MaterialFrame::across(vectors);
        waveVectors_ = frame.waveNumbers;
        frame.turn(recording_);
        report_.turnDegrees = degreesPerRadian * frame.turnRadians;
        for (std::size_t rib = 0; rib < inference::ribCount; ++rib) {
            if (waveVectors_[2 * rib] != 0.0F || waveVectors_[2 * rib + 1] != 0.0F) {
                report_.waveVectors.push_back({waveVectors_[2 * rib], waveVectors_[2 * rib + 1]});
            }
        }
    }

    [[nodiscard]] std::optional<double> wavelengthMetres() const {
        constexpr double metresPerMillimetre = 1e-3;
        if (report_.waveVectors.empty()) {
            return std::nullopt;
        }
        return metresPerMillimetre / std::hypot(report_.waveVectors[0].x, report_.waveVectors[0].y);
    }

    std::size_t nearestLabel(TextureFit& fit, const EmbeddingSpace& space) {
        constexpr std::size_t labelsAtOnce = 32;
        const std::size_t labels = model_.header().labels.size();
        const auto share = static_cast<std::uint64_t>(0.15 * static_cast<double>(settings_.segmentBudget));
        const std::size_t chains =
            std::clamp<std::size_t>(share / (labels * segmentsPerChain), 4, 4 * fit.bins().count());
        std::vector<double> distances;
        for (std::size_t first = 0; first < labels; first += labelsAtOnce) {
            std::vector<Embedding> embeddings;
            for (std::size_t label = first; label < std::min(labels, first + labelsAtOnce); ++label) {
                embeddings.push_back(space.ofLabel(label));
            }
            say(0.1 + 0.1 * static_cast<double>(first) / static_cast<double>(labels), "nearest label");
            if (first > 0 && isOutOfTime(labelShare)) {
                break;
            }
            const std::vector<double> part = fit.distances(embeddings, chains, 0);
            distances.insert(distances.end(), part.begin(), part.end());
        }
        // Only embeddings of labels with ribs respond to wave vectors.
        const auto& all = model_.header().labels;
        const auto hasRibs = [&](std::size_t label) { return all[label].wavelengthMetres.has_value(); };
        std::vector<std::size_t> eligible;
        for (std::size_t label = 0; label < distances.size(); ++label) {
            if (report_.waveVectors.empty() || hasRibs(label)) {
                eligible.push_back(label);
            }
        }
        if (eligible.empty()) {
            eligible.resize(distances.size());
            std::iota(eligible.begin(), eligible.end(), std::size_t{0});
        }
        return *std::ranges::min_element(eligible, {}, [&](std::size_t label) { return distances[label]; });
    }

    Embedding fitEmbedding(TextureFit& fit, const EmbeddingSpace& space, const Embedding& start) {
        const std::size_t chains = std::max<std::size_t>(12, 3 * fit.bins().count());
        Embedding fitted = start;
        const std::uint64_t perGeneration = population * chains * segmentsPerChain;
        const std::uint64_t generations = settings_.segmentBudget / perGeneration;
        if (space.axisCount() > 0 && generations > 0) {
            EvolutionStrategy strategy(space.coordinatesOf(start), firstStep, population, settings_.seed + 1);
            for (std::uint64_t generation = 0; generation < generations; ++generation) {
                say(0.2 + 0.7 * static_cast<double>(generation) / static_cast<double>(generations), "embedding");
                if (isOutOfTime(fitShare)) {
                    break;
                }
                const std::vector<std::vector<double>>& points = strategy.ask();
                std::vector<Embedding> embeddings;
                embeddings.reserve(points.size());
                for (const std::vector<double>& point : points) {
                    embeddings.push_back(space.at(start, point));
                }
                std::vector<double> scores = fit.distances(embeddings, chains, generation + 1);
                for (std::size_t k = 0; k < scores.size(); ++k) {
                    for (const double coordinate : points[k]) {
                        scores[k] += shrinkage * coordinate * coordinate;
                    }
                }
                strategy.tell(scores);
                ++report_.generations;
            }
            fitted = space.at(start, strategy.mean());
        }
        const std::size_t manyChains = 6 * fit.bins().count();
        const std::array<Embedding, 2> both{start, fitted};
        const std::vector<double> distances = fit.distances(both, manyChains, 1'000'000 / manyChains);
        report_.nearestDistanceDb = std::sqrt(distances[0]);
        report_.fittedDistanceDb = std::sqrt(std::min(distances[0], distances[1]));
        return distances[1] < distances[0] ? fitted : start;
    }

    ToneFit fitTones(TextureFit& fit, const Embedding& embedding) {
        const std::vector<TextureFigures> generated = fit.resynthesis(embedding);
        ToneFit tone = fitTone(fit.bins(), fit.recorded(), generated, recording_.bandwidthHz);
        if (tone.tone.speedsMps.empty()) {
            return tone;
        }
        for (std::size_t i = 0; i < level_.table.speedsMps.size(); ++i) {
            level_.table.logLevels[i] += correction(tone, level_.table.speedsMps[i]);
        }
        measureSpectra(fit, generated, tone);
        return tone;
    }

    static double correction(const ToneFit& tone, double speedMps) {
        const std::vector<double>& speeds = tone.tone.speedsMps;
        if (speedMps <= speeds.front()) {
            return tone.logLevels.front();
        }
        if (speedMps >= speeds.back()) {
            return tone.logLevels.back();
        }
        const auto above = static_cast<std::size_t>(std::ranges::upper_bound(speeds, speedMps) - speeds.begin());
        const double share = std::log(speedMps / speeds[above - 1]) / std::log(speeds[above] / speeds[above - 1]);
        return tone.logLevels[above - 1] + share * (tone.logLevels[above] - tone.logLevels[above - 1]);
    }

    void measureSpectra(const TextureFit& fit, std::span<const TextureFigures> generated, const ToneFit& tone) {
        constexpr double lowestHz = 20.0;
        constexpr double highestHz = 450.0;
        double total = 0.0;
        double weights = 0.0;
        for (std::size_t bin = 0; bin < fit.bins().count(); ++bin) {
            const TextureFigures& recorded = fit.recorded()[bin];
            if (recorded.frames <= 0.0 || generated[bin].frames <= 0.0) {
                continue;
            }
            const double speed = fit.bins().centresMps[bin];
            const double gainDb = decibelsPerNat * correction(tone, speed);
            double squares = 0.0;
            double count = 0.0;
            for (std::size_t i = 1; i < spectrumBins; ++i) {
                const double hertz = static_cast<double>(i) * hertzPerBin;
                if (hertz >= lowestHz && hertz <= highestHz) {
                    const double made =
                        10.0 * std::log10(generated[bin].power[i] + 1e-12) + tone.tone.gainDb(speed, hertz) + gainDb;
                    const double difference = made - 10.0 * std::log10(recorded.power[i] + 1e-12);
                    squares += difference * difference;
                    count += 1.0;
                }
            }
            total += recorded.frames * std::sqrt(squares / count);
            weights += recorded.frames;
            report_.levelErrorDb =
                std::max(report_.levelErrorDb, std::abs(10.0 * std::log10(std::max(recorded.meanSquare, 1e-9))));
        }
        report_.spectralDistanceDb = weights > 0.0 ? total / weights : 0.0;
    }

    /// How the spectrum's centre moves with speed, combined with the nearest label's value; 1 if ribs are crossed.
    [[nodiscard]] double frequencyExponent(const TextureFit& fit, const model::Label& nearest) const {
        constexpr double priorSpread = 0.1;
        constexpr double centroidSpread = 0.08;
        if (!report_.waveVectors.empty()) {
            return 1.0;
        }
        const double prior = nearest.wavelengthMetres ? 0.1 : nearest.frequencyExponent;
        std::vector<double> x;
        std::vector<double> y;
        for (std::size_t bin = 0; bin < fit.bins().count(); ++bin) {
            double power = 0.0;
            double logs = 0.0;
            for (std::size_t i = 3; i < spectrumBins / 2; ++i) {
                power += fit.recorded()[bin].power[i];
                logs += fit.recorded()[bin].power[i] * std::log(static_cast<double>(i));
            }
            if (power > 0.0) {
                x.push_back(std::log(fit.bins().centresMps[bin]));
                y.push_back(logs / power);
            }
        }
        const auto count = static_cast<double>(std::max<std::size_t>(x.size(), 1));
        const double meanX = std::accumulate(x.begin(), x.end(), 0.0) / count;
        const double meanY = std::accumulate(y.begin(), y.end(), 0.0) / count;
        double squares = 0.0;
        double products = 0.0;
        for (std::size_t i = 0; i < x.size(); ++i) {
            squares += (x[i] - meanX) * (x[i] - meanX);
            products += (x[i] - meanX) * (y[i] - meanY);
        }
        const double trust = squares / (centroidSpread * centroidSpread);
        const double priorTrust = 1.0 / (priorSpread * priorSpread);
        const double slope = squares > 0.0 ? products / squares : prior;
        return std::clamp((trust * slope + priorTrust * prior) / (trust + priorTrust), 0.0, 1.0);
    }

    const model::ModelFile& model_;
    inference::SegmentGenerator& generator_;
    const LearningSettings& settings_;
    double began_;
    std::array<float, inference::segmentSamples> silence_{};
    recordings::PreparedRecording recording_;
    Sliding sliding_;
    LevelLaw level_;
    std::vector<float> unitWave_;
    std::array<float, 2 * inference::ribCount> waveVectors_{};
    LearningReport report_;
};

/// The rules of material files (header_node.hpp): a text that breaks them would be written and never read again.
void requireText(const std::string& text, std::size_t longest, const char* what) {
    if (text.size() > longest || !model::isUtf8(text) || model::hasControlCharacter(text)) {
        throw std::invalid_argument(std::string(what) + " is \"" + model::printable(model::shortened(text, 60)) +
                                    "\" (" + std::to_string(text.size()) + " bytes); expected one line of text in " +
                                    "UTF-8, without control characters, of " + std::to_string(longest) +
                                    " bytes at most");
    }
}

}  // namespace

void checkSettings(const LearningSettings& settings) {
    constexpr double maximumCyclesPerMillimetre = 20.0;
    const bool hasCapitals = std::ranges::any_of(settings.name, [](char each) { return each >= 'A' && each <= 'Z'; });
    requireText(settings.name, model::nameBytes, "name");
    if (settings.name.find_first_not_of(' ') == std::string::npos || hasCapitals) {
        throw std::invalid_argument("name is \"" + settings.name +
                                    "\"; expected text that is not blank and has no capital letters, as labels have");
    }
    requireText(settings.category, model::nameBytes, "category");
    requireText(settings.description, model::maximumTextBytes, "description");
    requireText(settings.licence, model::maximumTextBytes, "licence");
    requireText(settings.recordings, model::maximumTextBytes, "recordings");
    if (settings.waveVectors) {
        for (const double number : *settings.waveVectors) {
            if (!(std::abs(number) <= maximumCyclesPerMillimetre)) {
                throw std::invalid_argument("wave_vectors: " + recordings::plainNumber(number) +
                                            " cycles per millimetre; expected -20 to 20");
            }
        }
    }
}

LearntMaterial learnMaterial(const recordings::Recording& recording, const model::ModelFile& model,
                             inference::SegmentGenerator& generator, const LearningSettings& settings) {
    return Learner(recording, model, generator, settings).learn();
}

}  // namespace haptoflow::learning
