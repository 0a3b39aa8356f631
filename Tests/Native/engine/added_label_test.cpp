// A label with its own level and tone is added to the shipped model.
#include "engine/offline_renderer.hpp"
#include "model/material_builder.hpp"
#include "model/model_builder.hpp"
#include "model/model_file.hpp"
#include "support/model_generator.hpp"
#include "support/wave_measures.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <span>
#include <string>
#include <vector>

namespace haptoflow::engine {
namespace {

/// The shipped model with one more label, which has a slightly changed embedding of wood and its own level and tone.
model::ModelFile withDenim(const model::ModelFile& shipped) {
    model::testing::ModelBuilder builder;
    builder.header = nlohmann::json::parse(shipped.headerText());
    builder.header.erase("blobs");
    builder.blobs.clear();
    for (const model::Blob& blob : shipped.header().blobs) {
        const auto bytes = shipped.blob(blob.name);
        model::testing::BlobContent content{blob.name, blob.type == model::BlobType::onnx ? "onnx" : "float32",
                                            blob.shape, model::testing::Bytes(bytes.begin(), bytes.end())};
        if (blob.name == "embedding") {
            std::vector<float> row(shipped.embedding(0).begin(), shipped.embedding(0).end());
            row[0] += 0.1F;
            const model::testing::Bytes added = model::testing::bytesOf(row);
            content.bytes.insert(content.bytes.end(), added.begin(), added.end());
            ++content.shape[0];
        }
        if (blob.name == "pieces") {
            content.bytes.resize(content.bytes.size() + bytes.size() / static_cast<std::size_t>(content.shape[0]));
            ++content.shape[0];
        }
        builder.blobs.push_back(content);
    }
    nlohmann::json denim = model::testing::validMaterial("00000000");
    denim["embedding_row"] = shipped.header().labels.size();
    builder.header["labels"].push_back(denim);
    return model::ModelFile::parse(builder.build());
}

class AddedLabelTest : public ::testing::Test {
protected:
    static std::vector<float> rendered(const model::ModelFile& model, std::uint32_t first, std::uint32_t second) {
        const auto generator = haptoflow::testing::generatorOf(model, 4, "draft");
        std::vector<TimedContactState> states;
        for (int update = 0; update < 72; ++update) {
            TimedContactState state;
            state.timeSeconds = update / 72.0;
            state.touching = true;
            state.touchCounter = 1;
            state.velocityMps = {0.1F, 0.05F};
            state.forceNewtons = 1.0F;
            state.material.add(update < 36 ? first : second, 1.0F);
            states.push_back(state);
        }
        return renderOffline(model, *generator, states, {}).samples;
    }

    model::ModelFile shipped_ = model::ModelFile::read(HAPTOFLOW_TEST_DEFAULT_MODEL);
    model::ModelFile added_ = withDenim(shipped_);
};

TEST_F(AddedLabelTest, AnAddedLabelDoesNotChangeTheOutputOfOtherLabels) {
    EXPECT_EQ(model::spaceOf(added_.header()), model::spaceOf(shipped_.header()));
    for (const std::uint32_t label : {0U, 8U, 13U}) {
        const std::vector<float> before = rendered(shipped_, label, label + 1);
        EXPECT_GT(haptoflow::testing::peak(before), 0.0F);
        EXPECT_EQ(rendered(added_, label, label + 1), before) << label;
    }
}

TEST_F(AddedLabelTest, AnAddedLabelSoundsAtItsOwnLevel) {
    const auto denim = static_cast<std::uint32_t>(shipped_.header().labels.size());
    const std::vector<float> own = rendered(added_, denim, denim);
    // At 0.112 m/s and 1 N, the level is e^1.08 m/s^2 plus 3 dB; the tone adds 1 to 9 dB.
    const double decibels = haptoflow::testing::levelDecibels(std::span(own).first(48000)) + 20.0 * std::log10(200.0);
    EXPECT_GT(decibels, 20.0 * std::log10(std::exp(1.08)) + 3.0 - 4.0);
    EXPECT_LT(decibels, 20.0 * std::log10(std::exp(1.08)) + 3.0 + 9.0);
}

}  // namespace
}  // namespace haptoflow::engine
