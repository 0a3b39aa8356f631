#include "skeleton/skeleton_tensors.hpp"

#include "model/model_error.hpp"

#include <cstdint>
#include <initializer_list>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace haptoflow::skeleton {
namespace {

struct Tensor {
    std::vector<float> values;
    std::size_t rows;
};

std::string shapeText(const std::vector<std::int64_t>& shape) {
    std::string text;
    for (const std::int64_t dimension : shape) {
        text += (text.empty() ? "" : ", ") + std::to_string(dimension);
    }
    return '[' + text + ']';
}

[[noreturn]] void refuse(const std::string& name, const std::string& reason) {
    throw model::ModelError(model::ModelStatus::inconsistent,
                            "blob \"" + name + "\" " + reason + ": export the model again");
}

/// The tensor with `columns` numbers in a row, or a vector without; `rows` is the number of rows if it is known.
Tensor readTensor(const model::ModelFile& model, const std::string& name, std::optional<std::size_t> rows,
                  std::optional<std::size_t> columns) {
    const model::Blob* blob = model.findBlob(name);
    if (blob == nullptr || blob->type != model::BlobType::float32) {
        refuse(name, "of type \"float32\" is missing, which the tiers of kind `skeleton` and `refine` need");
    }
    const std::size_t rank = columns ? 2 : 1;
    const auto isDimension = [&](std::size_t index, std::optional<std::size_t> wanted) {
        return !wanted || blob->shape[index] == static_cast<std::int64_t>(*wanted);
    };
    if (blob->shape.size() != rank || !isDimension(0, rows) || !isDimension(rank - 1, columns ? columns : rows)) {
        const std::string first = rows ? std::to_string(*rows) : "any";
        refuse(name, "has the shape " + shapeText(blob->shape) + "; expected [" + first +
                         (columns ? ", " + std::to_string(*columns) : "") + ']');
    }
    return {model.tensor(name), static_cast<std::size_t>(blob->shape[0])};
}

LinearLayer readLayer(const model::ModelFile& model, const std::string& name, std::optional<std::size_t> outputs,
                      std::size_t inputs) {
    const Tensor weight = readTensor(model, name + ".weight", outputs, inputs);
    return {weight.values, readTensor(model, name + ".bias", weight.rows, std::nullopt).values};
}

LinearLayer readHiddenLayer(const model::ModelFile& model, const std::string& name, std::size_t inputs) {
    LinearLayer layer = readLayer(model, name, std::nullopt, inputs);
    if (layer.outputs() > maximumHidden) {
        refuse(name + ".weight",
               "has " + std::to_string(layer.outputs()) + " rows; expected at most " + std::to_string(maximumHidden));
    }
    return layer;
}

HiddenLayers readHidden(const model::ModelFile& model, const std::string& name, std::size_t inputs) {
    LinearLayer first = readHiddenLayer(model, name + ".0", inputs);
    LinearLayer second = readHiddenLayer(model, name + ".2", first.outputs());
    return {std::move(first), std::move(second)};
}

Perceptron readPerceptron(const model::ModelFile& model, const std::string& name, std::size_t inputs,
                          std::optional<std::size_t> outputs) {
    HiddenLayers hidden = readHidden(model, name, inputs);
    LinearLayer last = readLayer(model, name + ".4", outputs, hidden.outputs());
    return {std::move(hidden), std::move(last)};
}

struct RowRange {
    std::size_t first;
    std::size_t count;
};

/// A layer of some rows of another, in this order.
LinearLayer layerOf(const Tensor& weight, const Tensor& bias, std::initializer_list<RowRange> ranges) {
    const std::size_t inputs = weight.values.size() / weight.rows;
    std::vector<float> weights;
    std::vector<float> biases;
    for (const auto& [first, count] : ranges) {
        const auto rows = std::span(weight.values).subspan(first * inputs, count * inputs);
        const auto own = std::span(bias.values).subspan(first, count);
        weights.insert(weights.end(), rows.begin(), rows.end());
        biases.insert(biases.end(), own.begin(), own.end());
    }
    return {weights, biases};
}

}  // namespace

std::shared_ptr<const LevelModel> readLevelModel(const model::ModelFile& model) {
    return std::make_shared<const LevelModel>(
        readLayer(model, "level.law", 3, embeddingSize),
        readPerceptron(model, "level.correction", LevelModel::correctionInputs, 1));
}

std::shared_ptr<const Skeleton> readSkeleton(const model::ModelFile& model) {
    HiddenLayers hidden = readHidden(model, "skeleton", Condition{}.size());
    const Tensor weight = readTensor(model, "skeleton.4.weight", output::count, hidden.outputs());
    const Tensor bias = readTensor(model, "skeleton.4.bias", output::count, std::nullopt);
    const auto family = [&](std::size_t index) {
        return layerOf(weight, bias,
                       {{output::swing + index * 2 * swingHarmonics, 2 * swingHarmonics},
                        {output::lines + index * 2 * lineHarmonics, 2 * lineHarmonics}});
    };
    static_assert(familyCount == 3);
    return std::make_shared<const Skeleton>(
        std::move(hidden),
        OutputLayers{.filter = layerOf(weight, bias, {{output::reflections, filterOrder + 1}}),
                     .families = {family(0), family(1), family(2)},
                     .impulseGains = layerOf(weight, bias, {{output::impulseGains, TailImpulses::gainCount}})});
}

NativeParts readNativeParts(const model::ModelFile& model) {
    if (!model.header().skeleton) {
        return {};
    }
    return {.level = readLevelModel(model), .skeleton = readSkeleton(model)};
}

NativeParts sharedOrRead(const NativeParts& shared, const model::ModelFile& model) {
    return shared.skeleton != nullptr ? shared : readNativeParts(model);
}

Perceptron readConditioning(const model::ModelFile& model, std::string_view tier) {
    return readPerceptron(model, std::string(tier) + ".condition", Condition{}.size(), std::nullopt);
}

}  // namespace haptoflow::skeleton
