#include "learning/learner.hpp"

#include "inference/tier_generator.hpp"
#include "learning/closed_loop.hpp"
#include "learning/comparison.hpp"
#include "learning/embedding_search.hpp"
#include "learning/level_law.hpp"
#include "learning/sliding.hpp"
#include "learning/wave_vectors.hpp"
#include "model/material_file.hpp"
#include "recordings/prepared_recording.hpp"
#include "skeleton/skeleton_tensors.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace haptoflow::learning {
namespace {

constexpr double fewSeconds = 10.0;
constexpr float maximumUnitSample = 12.0F;
constexpr double degreesPerRadian = 57.29577951308232;
/// Shares of the time limit at which the search among the labels and the fit end.
constexpr double labelShare = 0.4;
constexpr double fitShare = 0.9;
/// Share of the segments that measure the network's level; see TextureFit::steadyFrames.
constexpr double steadyShare = 0.4;
constexpr double noticeableDb = 0.3;
constexpr double largeLevelErrorDb = 3.0;

class Learner {
public:
    Learner(const recordings::Recording& recording, const model::ModelFile& model,
            inference::SegmentGenerator& generator, const LearningSettings& settings,
            std::span<const OtherTier> otherTiers)
        : model_(model), generator_(generator), settings_(settings), otherTiers_(otherTiers), began_(threadSeconds()) {
        say(0.0, "reading");
        checkSettings(settings);
        requireOwnLevels(model, generator);
        keptLabel_ = keptLabelOf(settings, model.header());
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
        level_ = fitLevelLaw(recording_, sliding_, exponentPrior(model_.header()));
        if (const auto warning = levelWarning(level_, sliding_, model_, generator_)) {
            report_.warnings.push_back(*warning);
        }
        makeUnitWave();
        say(0.05, "wave vectors");
        findRibs();
        ClosedLoop loop(generator_, model_.header(), recording_, unitWave_);
        TextureFit fit = fitOf(loop);
        const auto skeleton = report_.waveVectors.empty() ? skeleton::readNativeParts(model_).skeleton : nullptr;
        if (skeleton != nullptr && !keptLabel_) {
            likelihood_.emplace(*skeleton, recording_, sliding_, unitWave_);
        }
        const auto& labels = model_.header().labels;
        const std::size_t start = keptLabel_ ? *keptLabel_ : startOf(fit);
        report_.startLabel = labels[start].name;
        const Embedding embedding = keptLabel_ ? embeddingOf(*keptLabel_) : searched(fit, start);
        report_.nearestLabel = labels[model_.nearestLabel(embedding)].name;
        if (skeleton != nullptr) {
            impulseGain_ =
                fitImpulseGain(fit, embedding, [this](double share) { say(0.85 + 0.05 * share, "impulses"); });
        }
        say(0.9, "tone");
        const model::ToneTable tone = fitTones(fit, embedding);
        report_.toneSpeeds = tone.speedsMps.size();
        report_.speedExponent = level_.speedExponent;
        report_.forceExponent = level_.table.forceExponent;
        report_.segments = loop.segments();
        report_.seconds = elapsedSeconds();
        const bool isRuled = !report_.waveVectors.empty();
        LearntMaterial learnt;
        learnt.materialJson = materialText(
            model_, {.settings = settings_,
                     .report = report_,
                     .start = labels[start],
                     .embedding = embedding,
                     .level = level_,
                     .tone = tone,
                     .impulseGain = impulseGain_,
                     .frequencyExponent = isRuled ? 1.0 : frequencyExponent(fit.bins(), fit.recorded(), labels[start]),
                     .wavelengthMetres = wavelengthMetres()});
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
        report_.recordNext = recordNext(sliding_, exponentPrior(model_.header()));
        report_.noiseSource = recording_.noise.source;
        report_.noiseMps2 = recording_.noise.rmsMps2;
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

    /// Settings of a search that takes `share` of the whole from `begin` on and ends at `limit` of the time limit.
    SearchSettings search(double begin, double share, const char* doing, double limit) {
        return {.seed = settings_.seed,
                .segmentBudget = settings_.segmentBudget,
                .needsRibs = !report_.waveVectors.empty(),
                .progress = [this, begin, share, doing](double done) { say(begin + share * done, doing); },
                .isOver = [this, limit] { return isOutOfTime(limit); }};
    }

    [[nodiscard]] Embedding embeddingOf(std::size_t label) const {
        Embedding embedding{};
        std::ranges::copy(model_.embedding(label), embedding.begin());
        return embedding;
    }

    [[nodiscard]] std::size_t startOf(TextureFit& fit) {
        say(0.1, "start label");
        if (likelihood_) {
            return likeliestLabel(*likelihood_, EmbeddingSpace(model_, waveVectors_), model_.header().labels.size());
        }
        return startLabel(fit, EmbeddingSpace(model_, waveVectors_), model_.header().labels,
                          search(0.1, 0.1, "start label", labelShare));
    }

    [[nodiscard]] Embedding searched(TextureFit& fit, std::size_t start) {
        const EmbeddingSpace space(model_, waveVectors_);
        const SearchSettings settings = search(0.2, 0.65, "embedding", fitShare);
        const FittedEmbedding fitted =
            likelihood_ ? likeliestEmbedding(*likelihood_, fit, space, space.ofLabel(start), settings)
                        : fitEmbedding(fit, space, space.ofLabel(start), settings);
        report_.startDistanceDb = fitted.startDistanceDb;
        report_.fittedDistanceDb = fitted.distanceDb;
        report_.generations = fitted.generations;
        return fitted.embedding;
    }

    [[nodiscard]] TextureFit fitOf(ClosedLoop& loop) const {
        return {loop, recording_, sliding_, unitWave_, waveVectors_, settings_.seed};
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
        if (keptLabel_) {
            const Embedding embedding = embeddingOf(*keptLabel_);
            std::copy(embedding.end() - static_cast<std::ptrdiff_t>(waveVectors_.size()), embedding.end(),
                      waveVectors_.begin());
            reportRibs();
            return;
        }
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
        reportRibs();
    }

    void reportRibs() {
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

    model::ToneTable fitTones(TextureFit& fit, const Embedding& embedding) {
        const std::vector<SpectrumFrame> recorded = fit.recordedFrames();
        const std::vector<SpectrumFrame> generated = fit.generatedFrames(embedding, impulseGain_);
        const ToneConditions conditions = toneConditions(recorded);
        const std::vector<SpectrumFrame> steady = fit.steadyFrames(
            embedding, conditions.speedsMps, conditions.forcesNewtons,
            static_cast<std::uint64_t>(steadyShare * static_cast<double>(settings_.segmentBudget)), impulseGain_);
        using Frames = std::span<const SpectrumFrame>;
        const bool hasRibs = !report_.waveVectors.empty();
        model::ToneTable tone = fitTone(recorded, steady, hasRibs ? std::optional<Frames>(generated) : std::nullopt,
                                        recording_.bandwidthHz);
        if (tone.speedsMps.empty()) {
            return tone;
        }
        const ToneErrors errors = toneErrors(fit.bins(), recorded, generated, tone);
        report_.spectralDistanceDb = errors.spectralDistanceDb;
        report_.levelErrorDb = std::abs(errors.levelErrorDb);
        if (std::abs(errors.levelErrorDb) > largeLevelErrorDb) {
            report_.warnings.push_back(
                "at some speed the level is " + recordings::plainNumber(std::abs(errors.levelErrorDb)) + " dB " +
                (errors.levelErrorDb > 0.0 ? "above" : "below") +
                " the recording's: it changes there for another reason than speed and force, such as knocks, the "
                "direction of the strokes or a motion that was measured late; record steady strokes at that speed");
        }
        compare(fit, embedding, recorded, generated, tone);
        for (const OtherTier& other : otherTiers_) {
            ClosedLoop loop(*other.generator, model_.header(), recording_, unitWave_);
            const double distanceDb =
                toneErrors(fit.bins(), recorded, fitOf(loop).generatedFrames(embedding, impulseGain_), tone)
                    .spectralDistanceDb;
            report_.otherTiers.push_back({.tier = other.name,
                                          .spectralDistanceDb = distanceDb,
                                          .isFurtherOff = distanceDb > report_.spectralDistanceDb + noticeableDb});
        }
        return tone;
    }

    void compare(TextureFit& fit, const Embedding& embedding, std::span<const SpectrumFrame> recorded,
                 std::span<const SpectrumFrame> generated, const model::ToneTable& tone) {
        const auto lawOf = [this](std::span<const SpectrumFrame> frames) {
            std::vector<double> levels(frames.size());
            std::ranges::transform(frames, levels.begin(), [this](const SpectrumFrame& frame) {
                return std::exp(level_.logLevel(frame.speedMps, frame.forceNewtons));
            });
            return levels;
        };
        const std::size_t nearestLabel = model_.nearestLabel(embedding);
        const Embedding nearest = embeddingOf(nearestLabel);
        const std::vector<SpectrumFrame> ofLabel =
            fit.generatedFrames(nearest, model_.header().labels[nearestLabel].impulseGain);
        std::vector<LevelCondition> conditions;
        conditions.reserve(ofLabel.size());
        for (const SpectrumFrame& frame : ofLabel) {
            conditions.push_back({nearest, frame.speedMps, frame.forceNewtons});
        }
        const std::vector<float> levels = levelsOf(generator_, conditions);
        const auto framesOf = [&](std::span<const SpectrumFrame> frames, std::vector<double> levelsMps2,
                                  const model::ToneTable* filter) {
            return ComparedFrames{.frames = frames,
                                  .levels = std::move(levelsMps2),
                                  .tone = filter,
                                  .moments = momentsOf(frames, filter, fit.ribTravels())};
        };
        const ComparedFrames ofRecording = framesOf(recorded, lawOf(recorded), nullptr);
        const ComparedFrames ofMaterial = framesOf(generated, lawOf(generated), &tone);
        const ComparedFrames ofNearest = framesOf(ofLabel, std::vector<double>(levels.begin(), levels.end()), nullptr);
        report_.comparedHz = comparedHz();
        report_.comparisons = compared(fit.bins(), ofRecording, ofMaterial, ofNearest);
        report_.forces = comparedByForce(fit.bins(), ForceRanges::divide(recorded), ofRecording, ofMaterial, ofNearest);
        addLaws(ToneLevel(fit.bins(), generated, tone), nearest);
    }

    /// Adds the levels of material and nearest label at all speeds of the report, recorded or not.
    void addLaws(const ToneLevel& toneLevel, const Embedding& nearestLabel) {
        report_.lawSpeedsMps = lawSpeedsMps();
        const model::ModelHeader& header = model_.header();
        const double exponent = header.labels[model_.nearestLabel(nearestLabel)].speedLevelExponent;
        for (ForceComparison& each : report_.forces) {
            std::vector<LevelCondition> conditions;
            for (const double speed : report_.lawSpeedsMps) {
                conditions.push_back({nearestLabel, std::min(speed, header.speedMps.maximum), each.forceNewtons});
                each.learntMps2.push_back(std::exp(level_.logLevel(speed, each.forceNewtons)) *
                                          toneLevel.at(speed, each.forceNewtons));
            }
            const std::vector<float> levels = levelsOf(generator_, conditions);
            for (std::size_t i = 0; i < levels.size(); ++i) {
                // As the engine goes on beyond the model's range.
                const double beyond = report_.lawSpeedsMps[i] / conditions[i].speedMps;
                each.nearestLabelMps2.push_back(static_cast<double>(levels[i]) * std::pow(beyond, exponent));
            }
        }
    }

    static std::optional<std::size_t> keptLabelOf(const LearningSettings& settings, const model::ModelHeader& header) {
        if (settings.keptLabel.empty()) {
            return std::nullopt;
        }
        const auto found = std::ranges::find(header.labels, settings.keptLabel, &model::Label::name);
        if (found == header.labels.end()) {
            throw std::invalid_argument("options: the model has no label '" + settings.keptLabel + "'");
        }
        return static_cast<std::size_t>(found - header.labels.begin());
    }

    const model::ModelFile& model_;
    inference::SegmentGenerator& generator_;
    const LearningSettings& settings_;
    std::optional<std::size_t> keptLabel_;
    std::span<const OtherTier> otherTiers_;
    double began_;
    recordings::PreparedRecording recording_;
    Sliding sliding_;
    LevelLaw level_;
    std::vector<float> unitWave_;
    std::array<float, 2 * inference::ribCount> waveVectors_{};
    /// Of a search without ribs, in a model with a skeleton.
    std::optional<FilterLikelihood> likelihood_;
    float impulseGain_ = 1.0F;
    LearningReport report_;
};

}  // namespace

LearntMaterial learnMaterial(const recordings::Recording& recording, const model::ModelFile& model,
                             inference::SegmentGenerator& generator, const LearningSettings& settings,
                             std::span<const OtherTier> otherTiers) {
    return Learner(recording, model, generator, settings, otherTiers).learn();
}

LearntMaterial learnMaterial(const recordings::Recording& recording, const model::ModelFile& model,
                             const model::Tier& tier, std::shared_ptr<const inference::Runtime> runtime,
                             const LearningSettings& settings, const inference::LoadLimits& limits) {
    constexpr std::size_t batchOfFit = 64;
    const auto native = skeleton::readNativeParts(model);
    const auto open = [&](const model::Tier& each) {
        return inference::makeGenerator(runtime, model, each, inference::defaultSolver(each), batchOfFit, limits,
                                        native);
    };
    std::vector<OtherTier> others;
    for (const model::Tier& each : model.header().tiers) {
        const bool canRun = runtime != nullptr || !each.needsOnnxRuntime();
        if (each.name != tier.name && canRun) {
            others.push_back({.name = each.name, .generator = open(each)});
        }
    }
    return learnMaterial(recording, model, *open(tier), settings, others);
}

}  // namespace haptoflow::learning
