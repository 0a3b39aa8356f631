#include "../inference/skeleton_model.hpp"
#include "random.hpp"
#include "refusal.hpp"

#include "model/file_layout.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>

// Deterministic mutations of a valid file. Under the sanitizers they show that invalid bytes cause no undefined
// behaviour; otherwise, that every mutant is either refused with a ModelError or readable through every accessor.

namespace haptoflow::model::testing {
namespace {

using Json = nlohmann::json;

double touchEverything(const ModelFile& model) {
    double sum = static_cast<double>(model.checksum()) + static_cast<double>(model.headerText().size());
    for (std::size_t label = 0; label < model.header().labels.size(); ++label) {
        for (const float value : model.embedding(label)) {
            sum += static_cast<double>(value);
        }
    }
    for (std::size_t seed = 0; seed < model.header().seeds.size(); ++seed) {
        for (const float value : model.seed(seed)) {
            sum += static_cast<double>(value);
        }
        sum += static_cast<double>(model.header().labels.at(model.header().seeds[seed].label).name.size());
    }
    for (const Blob& blob : model.header().blobs) {
        for (const std::byte value : model.blob(blob.name)) {
            sum += std::to_integer<int>(value);
        }
    }
    for (const Tier& tier : model.header().tiers) {
        for (const std::string* graph : {&tier.field, &tier.level, &tier.encoder, &tier.decoder}) {
            sum += graph->empty() ? 0.0 : static_cast<double>(model.blob(*graph).size());
        }
    }
    if (model.header().skeleton) {
        sum += static_cast<double>(model.tensor(skeletonTensor)[0]);
    }
    sum += static_cast<double>(spaceOf(model.header()).size());
    return sum;
}

/// Numbers of refused and accepted mutants; tests require both kinds where both must occur.
struct Outcome {
    int accepted = 0;
    std::map<ModelStatus, int> refused;

    [[nodiscard]] int refusals() const {
        int sum = 0;
        for (const auto& [status, count] : refused) {
            sum += count;
        }
        return sum;
    }
};

void tryMutant(Bytes file, Outcome& outcome) {
    try {
        const ModelFile model = ModelFile::parse(std::move(file));
        EXPECT_TRUE(std::isfinite(touchEverything(model)));
        ++outcome.accepted;
    } catch (const ModelError& error) {
        EXPECT_STRNE(error.what(), "");
        ++outcome.refused[error.status()];
    }
}

/// Corrects all checksums, so that a mutant is refused only for its content.
Bytes reseal(Bytes file) {
    if (file.size() >= prefixBytes) {
        resealHeader(file);
    }
    return file;
}

Json nastyValue(Random& random) {
    static const Json values = [] {
        Json list = Json::parse(R"([null, true, 0, -1, 1, 16, 64, 200, 9223372036854775807, -9223372036854775808,
            18446744073709551615, 4294967296, 0.5, -0.0, 1e-308, 1.7e308, "", "oak", "field", "embedding", "skeleton",
            "a\tb", [], {}, [0, 0], [1, 64], [9223372036854775807, 9223372036854775807], [0.1, 0.2, 0.3, 0.4, 0.5]])");
        list.push_back(std::string(5000, 'x'));
        return list;
    }();
    return values[random.below(values.size())];
}

/// A random value somewhere in `root`.
Json& pick(Json& root, Random& random) {
    Json* node = &root;
    while (node->is_structured() && !node->empty() && random.below(4) != 0) {
        auto child = node->begin();
        std::advance(child, static_cast<std::ptrdiff_t>(random.below(node->size())));
        node = &*child;
    }
    return *node;
}

void mutateJson(Json& root, Random& random) {
    Json& node = pick(root, random);
    switch (random.below(5)) {
        case 0:
            if (node.is_object() && !node.empty()) {
                auto victim = node.begin();
                std::advance(victim, static_cast<std::ptrdiff_t>(random.below(node.size())));
                node.erase(victim);
                return;
            }
            node = nastyValue(random);
            return;
        case 1:
            if (node.is_array() && !node.empty()) {
                const std::size_t index = random.below(node.size());
                if (random.below(2) == 0) {
                    node.erase(index);
                } else {
                    node.push_back(Json(node[index]));
                }
                return;
            }
            node = nastyValue(random);
            return;
        case 2: {
            Json copy = pick(root, random);
            if (copy.dump().size() < 1000) {
                pick(root, random) = std::move(copy);
            }
            return;
        }
        case 3:
            if (node.is_number_integer()) {
                // Unsigned arithmetic, because an earlier change may have left the largest number of its type.
                node = static_cast<std::int64_t>(node.get<std::uint64_t>() + random.below(129) - 64U);
                return;
            }
            node = nastyValue(random);
            return;
        default:
            node = nastyValue(random);
    }
}

/// A kind of valid file: with a seed bank, or with a skeleton.
struct Kind {
    const char* name;
    ModelBuilder (*builder)();
    /// Two tensors, to change their numbers.
    std::array<const char*, 2> tensors;
};

class MutationTest : public ::testing::TestWithParam<Kind> {
protected:
    [[nodiscard]] static ModelBuilder builder() { return GetParam().builder(); }
};

INSTANTIATE_TEST_SUITE_P(Kinds, MutationTest,
                         ::testing::Values(Kind{"Seeded", [] { return ModelBuilder(); }, {"embedding", "seeds"}},
                                           Kind{"Skeleton",
                                                [] { return skeleton::testing::refinedModel({.hidden = 2}); },
                                                {"embedding", "skeleton.4.weight"}}),
                         [](const auto& kind) { return std::string(kind.param.name); });

TEST_P(MutationTest, EveryChangedByteIsDetected) {
    const Bytes valid = builder().build();
    Random random(1);
    Outcome outcome;
    constexpr int mutants = 1500;
    for (int index = 0; index < mutants; ++index) {
        Bytes file = valid;
        file[random.below(file.size())] ^= static_cast<std::byte>(1 + random.below(255));
        tryMutant(std::move(file), outcome);
    }
    EXPECT_EQ(outcome.accepted, 0);
    EXPECT_EQ(outcome.refusals(), mutants);
}

TEST_P(MutationTest, ChangedHeaderBytesWithCorrectChecksumsAreRefusedOrReadable) {
    const Bytes valid = builder().build();
    const std::size_t textBytes = ModelFile::parse(valid).headerText().size();
    Random random(2);
    Outcome outcome;
    for (int index = 0; index < 2000; ++index) {
        Bytes file = valid;
        for (std::size_t change = 0; change <= random.below(4); ++change) {
            file[prefixBytes + random.below(textBytes)] = static_cast<std::byte>(random.below(256));
        }
        tryMutant(reseal(std::move(file)), outcome);
    }
    EXPECT_GT(outcome.accepted, 0);
    EXPECT_GT(outcome.refused[ModelStatus::damaged], 0);
    EXPECT_GT(outcome.refused[ModelStatus::inconsistent], 0);
}

TEST_P(MutationTest, ChangedHeaderValuesWithCorrectChecksumsAreRefusedOrReadable) {
    Random random(3);
    Outcome outcome;
    ModelBuilder mutated = builder();
    mutated.editLaidOut = [&random](Json& header) {
        for (std::size_t change = 0; change <= random.below(3); ++change) {
            mutateJson(header, random);
        }
    };
    int built = 0;
    for (int index = 0; index < 2000; ++index) {
        try {
            tryMutant(mutated.build(), outcome);
            ++built;
        } catch (const std::length_error&) {
            // The mutant's header does not fit into the space that the builder leaves: skip it.
        }
    }
    EXPECT_GT(built, 1500);
    EXPECT_GT(outcome.accepted, 0);
    EXPECT_GT(outcome.refused[ModelStatus::inconsistent], 0);
    EXPECT_GT(outcome.refused[ModelStatus::oversized], 0);
}

TEST_P(MutationTest, ChangedLengthsAndOffsetsWithCorrectChecksumsAreRefusedOrReadable) {
    const Bytes valid = builder().build();
    Random random(4);
    Outcome outcome;
    for (int index = 0; index < 1500; ++index) {
        Bytes file = valid;
        if (random.below(2) == 0) {
            file.resize(random.below(2 * file.size()));
        }
        if (file.size() >= prefixBytes && random.below(2) == 0) {
            writeUnsigned(file, 16, 8, file.size());
        }
        if (file.size() >= prefixBytes && random.below(2) == 0) {
            writeUnsigned(file, 12, 4, random.next() >> random.below(60));
        }
        tryMutant(reseal(std::move(file)), outcome);
    }
    EXPECT_GT(outcome.refused[ModelStatus::truncated], 0);
    EXPECT_GT(outcome.refused[ModelStatus::inconsistent], 0);
    EXPECT_GT(outcome.refused[ModelStatus::oversized], 0);
}

TEST_P(MutationTest, ChangedTensorsWithCorrectChecksumsAreRefusedOrReadable) {
    Random random(5);
    Outcome outcome;
    for (int index = 0; index < 600; ++index) {
        ModelBuilder mutated = builder();
        Bytes& bytes = blobOf(mutated, GetParam().tensors[random.below(2)]).bytes;
        writeUnsigned(bytes, 4 * random.below(bytes.size() / 4), 4, random.next());
        tryMutant(mutated.build(), outcome);
    }
    EXPECT_GT(outcome.accepted, 0);
    EXPECT_GT(outcome.refused[ModelStatus::inconsistent], 0);
}

}  // namespace
}  // namespace haptoflow::model::testing
