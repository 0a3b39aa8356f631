#pragma once

#include "golden_file.hpp"
#include "inference/onnx_runtime.hpp"
#include "inference/onnx_segment_generator.hpp"
#include "inference/segment_generator.hpp"
#include "model/model_file.hpp"

#include <onnxruntime_c_api.h>

#include <algorithm>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

namespace haptoflow::inference::testing {

inline std::shared_ptr<const Runtime> testRuntime() {
    static const std::shared_ptr<const Runtime> runtime = Runtime::open(HAPTOFLOW_TEST_ONNXRUNTIME);
    return runtime;
}

/// Runs of graphs by the runtime below, probe runs included.
inline int graphRuns = 0;

/// The test's ONNX Runtime, which counts the runs of its graphs in `graphRuns`.
inline std::shared_ptr<const Runtime> countingRuntime() {
    static OrtApi api = testRuntime()->api();
    api.RunWithBinding = [](OrtSession* session, const OrtRunOptions* options,
                            const OrtIoBinding* binding) noexcept -> OrtStatus* {
        ++graphRuns;
        return testRuntime()->api().RunWithBinding(session, options, binding);
    };
    static const OrtApiBase base{[](std::uint32_t) noexcept -> const OrtApi* { return &api; },
                                 []() noexcept -> const char* { return "1.22.0"; }};
    return Runtime::fromApiBase(&base);
}

inline const model::ModelFile& tinyModel() {
    static const model::ModelFile model = model::ModelFile::read(HAPTOFLOW_TEST_GOLDEN_DIR "/model/tiny.haptoflow");
    return model;
}

/// A tier of networks alone.
inline OnnxSegmentGenerator openNetwork(const model::ModelFile& model, std::string_view tier, SolverSettings solver,
                                        std::size_t maximumBatch = 4, const LoadLimits& limits = {},
                                        SharedSessions* sessions = nullptr,
                                        const std::shared_ptr<const Runtime>& runtime = testRuntime()) {
    return OnnxSegmentGenerator({runtime, model, *model.findTier(tier), maximumBatch, limits, sessions}, solver);
}

inline SolverKind solverNamed(const std::string& name) {
    if (name == "euler") {
        return SolverKind::euler;
    }
    if (name == "heun") {
        return SolverKind::heun;
    }
    if (name == "midpoint") {
        return SolverKind::midpoint;
    }
    throw std::runtime_error("no solver is called " + name);
}

/// Owns the data that the requests of a batch view.
class RequestBatch {
public:
    void add(const std::vector<float>& embedding, const std::vector<float>& motion, const std::vector<float>& previous,
             const std::vector<float>& noise, const skeleton::Phases& phases = {}) {
        if (embedding.size() != embeddingSize || motion.size() != 3 || previous.size() != segmentSamples ||
            noise.size() != segmentSamples) {
            throw std::runtime_error("a golden request has the wrong sizes");
        }
        rows_.push_back(std::make_unique<Row>(Row{embedding, motion, previous, noise, phases}));
    }

    [[nodiscard]] std::vector<SegmentRequest> requests() const {
        std::vector<SegmentRequest> result;
        for (const auto& row : rows_) {
            SegmentRequest request{{},
                                   {},
                                   std::span<const float>(row->previous).first<segmentSamples>(),
                                   std::span<const float>(row->noise).first<segmentSamples>()};
            std::ranges::copy(row->embedding, request.embedding.begin());
            std::ranges::copy(row->motion, request.motion.begin());
            request.phases = row->phases;
            result.push_back(request);
        }
        return result;
    }

private:
    struct Row {
        std::vector<float> embedding;
        std::vector<float> motion;
        std::vector<float> previous;
        std::vector<float> noise;
        skeleton::Phases phases;
    };

    std::vector<std::unique_ptr<Row>> rows_;
};

/// The three requests of tiny.expected.json.
inline const RequestBatch& goldenBatch() {
    static const RequestBatch batch = [] {
        RequestBatch rows;
        const nlohmann::json golden = haptoflow::testing::readGolden("model/tiny.expected.json").at("requests");
        for (std::size_t row = 0; row < haptoflow::testing::goldenRows(golden, "noise").size(); ++row) {
            const auto values = [&](const char* key) { return golden.at(key).at(row).get<std::vector<float>>(); };
            rows.add(values("embedding"), values("motion"), values("previous"), values("noise"));
        }
        return rows;
    }();
    return batch;
}

}  // namespace haptoflow::inference::testing
