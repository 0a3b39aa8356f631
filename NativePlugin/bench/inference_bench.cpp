#include "bench/measurements.hpp"

#include "dsp/denormals.hpp"
#include "inference/random_requests.hpp"

#include <algorithm>
#include <array>
#include <deque>
#include <random>

namespace haptoflow::bench {
namespace {

constexpr std::size_t blocksOfEach = 8;
constexpr std::size_t warmUpRuns = 3;

/// A tier whose runs are timed.
struct Contender {
    std::string name;
    const model::Tier& tier;
    std::unique_ptr<inference::TierGenerator> generator;
    inference::RandomRequests requests;
    std::array<float, inference::segmentSamples> segment{};
    std::vector<double> hotSeconds{};
    std::vector<double> pacedSeconds{};

    double run() {
        const auto request = requests.next(1);
        return secondsOf([&] { generator->generate(request, segment); });
    }
};

void runHot(Contender& contender, std::size_t runs) {
    for (std::size_t run = 0; run < warmUpRuns; ++run) {
        (void)contender.run();
    }
    for (std::size_t run = 0; run < runs; ++run) {
        contender.hotSeconds.push_back(contender.run());
    }
}

/// One run at each update. A run that takes longer is followed by the next one at once.
void runPaced(Contender& contender, std::size_t runs) {
    (void)contender.run();
    double due = nowSeconds();
    for (std::size_t run = 0; run < runs; ++run) {
        due = std::max(due + 1.0 / updateRateHz, nowSeconds());
        sleepUntil(due);
        contender.pacedSeconds.push_back(contender.run());
    }
}

/// Runs every tier in `blocksOfEach` blocks, in random order over all tiers.
template <typename RunBlock>
void inRandomOrder(std::deque<Contender>& contenders, std::size_t runs, std::mt19937_64& random, RunBlock runBlock) {
    std::vector<std::size_t> order;
    for (std::size_t index = 0; index < contenders.size(); ++index) {
        order.insert(order.end(), blocksOfEach, index);
    }
    std::ranges::shuffle(order, random);
    const std::size_t runsOfBlock = (runs + blocksOfEach - 1) / blocksOfEach;
    for (const std::size_t index : order) {
        runBlock(contenders[index], runsOfBlock);
    }
}

nlohmann::ordered_json figuresOf(const Contender& contender) {
    nlohmann::ordered_json figures = toJson(distributionOf(contender.hotSeconds), milliseconds);
    figures["paced"] = toJson(distributionOf(contender.pacedSeconds), milliseconds);
    const model::Tier& tier = contender.tier;
    figures["solver"] = std::string(tier.isSolved() ? model::solverName(tier.solver) : model::kindName(tier.kind));
    figures["steps"] = tier.isSolved() ? tier.steps : 1;
    figures["parameters"] = contender.tier.parameters;
    return figures;
}

/// The median time of the paper's architecture divided by the tier's.
nlohmann::ordered_json speedup(const nlohmann::ordered_json& paper, const nlohmann::ordered_json& tier) {
    return ratioOf(paper["p50"].get<double>(), tier["p50"].get<double>());
}

nlohmann::ordered_json reportOf(const std::deque<Contender>& contenders, const Subjects& subjects) {
    nlohmann::ordered_json tiers;
    nlohmann::ordered_json paper;
    for (const Contender& contender : contenders) {
        (contender.name.empty() ? paper : tiers[contender.name]) = figuresOf(contender);
    }
    nlohmann::ordered_json report;
    if (subjects.paper == nullptr) {
        report["inference_ms"] = tiers;
        return report;
    }
    for (auto& tier : tiers) {
        tier["ratio"] = speedup(paper, tier);
        tier["paced"]["ratio"] = speedup(paper["paced"], tier["paced"]);
    }
    paper["model"] = subjects.paper->header().name;
    report["inference_ms"] = tiers;
    report["paper_architecture_ms"] = paper;
    const nlohmann::ordered_json& standard = tiers[subjects.standard().name];
    report["speedup_vs_paper_architecture"] = standard["ratio"];
    report["speedup_vs_paper_architecture_paced"] = standard["paced"]["ratio"];
    return report;
}

/// One row for each number of voices: the tier's segments in one batch, and as many batches of one.
nlohmann::ordered_json voiceRows(const Subjects& subjects, const model::Tier& tier, const BenchPlan& plan,
                                 const Advance& advance) {
    const std::size_t most = *std::ranges::max_element(plan.batchVoices);
    const auto batched = subjects.generator(*subjects.model, tier, most);
    const auto single = subjects.generator(*subjects.model, tier, 1);
    inference::RandomRequests source(*subjects.model, most, subjects.seed);
    std::vector<float> segments(most * inference::segmentSamples);
    std::mt19937_64 random(subjects.seed);
    nlohmann::ordered_json rows = nlohmann::ordered_json::array();
    for (const std::size_t voices : plan.batchVoices) {
        const auto target = std::span(segments).first(voices * inference::segmentSamples);
        std::array<std::vector<double>, 2> seconds;
        for (std::size_t run = 0; run < plan.batchRuns() + 1; ++run) {
            const auto requests = source.next(voices);
            const std::size_t first = random() % 2;
            for (const std::size_t kind : {first, 1 - first}) {
                auto& generator = kind == 0 ? *batched : *single;
                const double taken = secondsOf([&] { generator.generate(requests, target); });
                if (run > 0) {
                    seconds.at(kind).push_back(taken);
                }
            }
        }
        const nlohmann::ordered_json batch = toJson(distributionOf(seconds[0]), milliseconds);
        const nlohmann::ordered_json oneByOne = toJson(distributionOf(seconds[1]), milliseconds);
        rows.push_back({{"count", voices},
                        {"ms_per_update", batch["p50"]},
                        {"batched", batch},
                        {"one_by_one", oneByOne},
                        {"ratio", ratioOf(batch["p50"].get<double>(), oneByOne["p50"].get<double>())}});
        advance(static_cast<double>(rows.size()) / static_cast<double>(plan.batchVoices.size()));
    }
    return rows;
}

}  // namespace

nlohmann::ordered_json measureInference(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    const dsp::ScopedFlushDenormals flush;
    std::deque<Contender> contenders;
    const auto enter = [&](const std::string& name, const model::ModelFile& file, const model::Tier& tier) {
        contenders.push_back({.name = name,
                              .tier = tier,
                              .generator = subjects.generator(file, tier, 1),
                              .requests = inference::RandomRequests(file, inference::requestCount, subjects.seed)});
    };
    for (const model::Tier& tier : subjects.model->header().tiers) {
        enter(tier.name, *subjects.model, tier);
    }
    if (subjects.paper != nullptr) {
        const model::ModelHeader& header = subjects.paper->header();
        enter("", *subjects.paper, header.tiers[header.defaultTier]);
    }
    std::mt19937_64 random(subjects.seed);
    const auto blocks = static_cast<double>(2 * blocksOfEach * contenders.size());
    double done = 0.0;
    inRandomOrder(contenders, plan.inferenceRuns(), random, [&](Contender& contender, std::size_t runs) {
        runHot(contender, runs);
        advance(++done / blocks);
    });
    inRandomOrder(contenders, plan.inferenceRuns(), random, [&](Contender& contender, std::size_t runs) {
        runPaced(contender, runs);
        advance(++done / blocks);
    });
    return reportOf(contenders, subjects);
}

nlohmann::ordered_json measureVoices(const Subjects& subjects, const BenchPlan& plan, const Advance& advance) {
    const dsp::ScopedFlushDenormals flush;
    const auto& tiers = subjects.model->header().tiers;
    const auto sketch = std::ranges::find(tiers, model::TierKind::skeleton, &model::Tier::kind);
    const double shares = sketch != tiers.end() ? 2.0 : 1.0;
    nlohmann::ordered_json report{
        {"voices", voiceRows(subjects, subjects.standard(), plan, [&](double share) { advance(share / shares); })}};
    if (sketch != tiers.end()) {
        report["sketch_voices"] =
            voiceRows(subjects, *sketch, plan, [&](double share) { advance(0.5 + share / shares); });
    }
    return report;
}

}  // namespace haptoflow::bench
