#include "model/onnx_check.hpp"

#include "model/model_error.hpp"
#include "model/onnx_tensor.hpp"

#include <algorithm>
#include <unordered_map>
#include <vector>

namespace haptoflow::model {
namespace {

// Numbers of the fields in onnx.proto that are read, grouped by message, and those of the fields that may be there and
// are not read: names, texts for people and, of attributes, plain numbers and texts.
namespace model_field {
constexpr std::uint32_t graph = 7, opsetImport = 8;
constexpr std::uint32_t unread[]{1, 2, 3, 4, 5, 6, 14};
}  // namespace model_field
namespace opset_field {
constexpr std::uint32_t domain = 1, version = 2;
}  // namespace opset_field
namespace graph_field {
constexpr std::uint32_t node = 1, initializer = 5, input = 11, output = 12, valueInfo = 13;
constexpr std::uint32_t unread[]{2, 10, 16};
}  // namespace graph_field
namespace value_field {
constexpr std::uint32_t name = 1;
}  // namespace value_field
namespace node_field {
constexpr std::uint32_t input = 1, output = 2, operatorType = 4, attribute = 5, domain = 7;
constexpr std::uint32_t unread[]{3, 6, 9};
}  // namespace node_field
namespace attribute_field {
constexpr std::uint32_t tensor = 5;
constexpr std::uint32_t unread[]{1, 2, 3, 4, 7, 8, 9, 13, 20};
}  // namespace attribute_field

bool isAmong(std::span<const std::uint32_t> unread, std::uint32_t field) {
    return std::ranges::find(unread, field) != unread.end();
}

struct Node {
    std::string_view operatorType;
    std::string_view domain;
    std::vector<std::string_view> inputs;
    std::vector<std::string_view> outputs;
    std::vector<std::span<const std::byte>> attributes;
};

bool isAllowedOperator(std::string_view name) {
    return name.find(' ') == std::string_view::npos &&
           allowedOperators.find(' ' + std::string(name) + ' ') != std::string_view::npos;
}

/// True if this input determines the size or shape of the operator's result.
bool isShapeOperand(std::string_view name, std::size_t input) {
    if (name == "ConstantOfShape") {
        return input == 0;
    }
    if (name == "Expand" || name == "Pad" || name == "Reshape") {
        return input == 1;
    }
    return name == "Slice" && input >= 1;
}

/// What a value of the graph depends on.
enum class Origin {
    /// Only on constants and on the sizes of the inputs.
    sizes,
    /// On the content of the inputs.
    inputs,
};

bool isOnnxDomain(std::string_view domain) {
    return domain.empty() || domain == "ai.onnx";
}

/// Text from a file in printable form for a message, shortened to fit a line.
std::string quoted(std::string_view text) {
    std::string result = "\"";
    for (const char letter : text.substr(0, 64)) {
        result += letter >= ' ' && letter <= '~' ? letter : '?';
    }
    return result + '"';
}

class OnnxCheck {
public:
    explicit OnnxCheck(const std::string& name) : name_(name) {}

    void readModel(std::span<const std::byte> bytes) {
        std::vector<std::span<const std::byte>> graphs;
        WireReader reader(bytes);
        while (const auto field = reader.next()) {
            switch (field->number) {
                case model_field::graph:
                    graphs.push_back(messageOf(*field));
                    break;
                case model_field::opsetImport:
                    readOpset(messageOf(*field));
                    break;
                default:
                    requireUnread(model_field::unread, "model", field->number);
            }
        }
        if (graphs.size() != 1 || !hasOpset_) {
            refuse("is not an ONNX model: it must have one graph and an opset");
        }
        readNames(graphs.front());
        readNodes(graphs.front());
    }

private:
    [[noreturn]] void refuse(const std::string& message) const {
        throw ModelError(ModelStatus::inconsistent, name_ + ": " + message);
    }

    /// Refuses functions, training information, sparse tensors and fields of later versions of ONNX.
    void requireUnread(std::span<const std::uint32_t> unread, const char* message, std::uint32_t number) const {
        if (!isAmong(unread, number)) {
            refuse("is not a plain ONNX graph: its " + std::string(message) + " has the field " +
                   std::to_string(number) + "; export it for opset 16, without functions, subgraphs or sparse tensors");
        }
    }

    void count(std::size_t& counter, std::size_t limit, const char* what) const {
        if (++counter > limit) {
            throw ModelError(ModelStatus::oversized,
                             name_ + ": more than " + std::to_string(limit) + ' ' + what + "; export a smaller graph");
        }
    }

    [[nodiscard]] static std::span<const std::byte> messageOf(const WireField& field) {
        if (field.type != WireType::bytes) {
            throw WireError("field " + std::to_string(field.number) + " has another encoding than ONNX gives it");
        }
        return field.bytes;
    }
    [[nodiscard]] static std::string_view textOf(const WireField& field) {
        (void)messageOf(field);
        return field.text();
    }

    void readOpset(std::span<const std::byte> bytes) {
        std::string_view domain;
        std::uint64_t version = 0;
        WireReader reader(bytes);
        while (const auto field = reader.next()) {
            if (field->number == opset_field::domain) {
                domain = textOf(*field);
            } else if (field->number == opset_field::version) {
                version = field->value;
            } else {
                requireUnread({}, "opset", field->number);
            }
        }
        if (!isOnnxDomain(domain)) {
            refuse("imports operators of the domain " + quoted(domain) + "; export it with ONNX's own operators only");
        }
        if (version != graphOpset) {
            refuse("is written in opset " + std::to_string(version) + "; export it for opset 16");
        }
        hasOpset_ = true;
    }

    /// Reads everything in the graph but its nodes: inputs, initialisers and their kind.
    void readNames(std::span<const std::byte> graph) {
        std::vector<std::string_view> constants;
        WireReader reader(graph);
        while (const auto field = reader.next()) {
            switch (field->number) {
                case graph_field::input:
                    count(tensors_, maximumGraphTensors, "inputs and tensors");
                    origins_[nameOf(messageOf(*field))] = Origin::inputs;
                    break;
                case graph_field::initializer:
                    count(tensors_, maximumGraphTensors, "inputs and tensors");
                    constants.push_back(checkTensor(messageOf(*field)));
                    break;
                case graph_field::valueInfo:
                case graph_field::output:
                    count(tensors_, maximumGraphTensors, "inputs and tensors");
                    break;
                case graph_field::node:
                    count(nodes_, maximumGraphNodes, "operators");
                    break;
                default:
                    requireUnread(graph_field::unread, "graph", field->number);
            }
        }
        for (const std::string_view constant : constants) {
            origins_.emplace(constant, Origin::sizes);
        }
    }

    [[nodiscard]] static std::string_view nameOf(std::span<const std::byte> valueInfo) {
        std::string_view name;
        WireReader reader(valueInfo);
        while (const auto field = reader.next()) {
            if (field->number == value_field::name) {
                name = textOf(*field);
            }
        }
        return name;
    }

    [[nodiscard]] std::string_view checkTensor(std::span<const std::byte> bytes) const {
        const OnnxTensor tensor = readOnnxTensor(bytes);
        if (!tensor.problem.empty()) {
            refuse("the tensor " + quoted(tensor.name) + ' ' + tensor.problem);
        }
        return tensor.name;
    }

    void readNodes(std::span<const std::byte> graph) {
        WireReader reader(graph);
        while (const auto field = reader.next()) {
            if (field->number == graph_field::node) {
                checkNode(readNode(messageOf(*field)));
            }
        }
    }

    [[nodiscard]] Node readNode(std::span<const std::byte> bytes) const {
        Node node;
        WireReader reader(bytes);
        while (const auto field = reader.next()) {
            switch (field->number) {
                case node_field::input:
                    node.inputs.push_back(textOf(*field));
                    break;
                case node_field::output:
                    node.outputs.push_back(textOf(*field));
                    break;
                case node_field::operatorType:
                    node.operatorType = textOf(*field);
                    break;
                case node_field::domain:
                    node.domain = textOf(*field);
                    break;
                case node_field::attribute:
                    node.attributes.push_back(messageOf(*field));
                    break;
                default:
                    requireUnread(node_field::unread, "operator", field->number);
            }
        }
        return node;
    }

    void checkNode(const Node& node) {
        const std::string type(quoted(node.operatorType));
        if (!isOnnxDomain(node.domain)) {
            refuse("uses the operator " + type + " of the domain " + quoted(node.domain) +
                   "; export it with ONNX's own operators only");
        }
        if (!isAllowedOperator(node.operatorType)) {
            refuse(
                "uses the operator " + type +
                ", which model files may not contain: export it with the operators that Documentation~/model-format.md "
                "lists");
        }
        for (const auto& attribute : node.attributes) {
            checkAttribute(attribute, type);
        }
        // The result of the operator Shape depends only on sizes, whatever its input depends on.
        Origin origin = Origin::sizes;
        for (std::size_t index = 0; index < node.inputs.size(); ++index) {
            const std::string_view input = node.inputs[index];
            if (input.empty()) {
                continue;
            }
            const auto found = origins_.find(input);
            if (found == origins_.end()) {
                refuse("the operator " + type + " reads " + quoted(input) + " before it is defined");
            }
            if (found->second == Origin::inputs) {
                if (isShapeOperand(node.operatorType, index)) {
                    refuse("the operator " + type +
                           " takes a size from the content of the graph's inputs; sizes must depend only on constants "
                           "and on the inputs' shapes");
                }
                origin = node.operatorType == "Shape" ? origin : Origin::inputs;
            }
        }
        for (const std::string_view output : node.outputs) {
            if (!output.empty() && !origins_.emplace(output, origin).second) {
                refuse("the name " + quoted(output) + " is defined twice");
            }
        }
    }

    void checkAttribute(std::span<const std::byte> bytes, const std::string& type) const {
        WireReader reader(bytes);
        while (const auto field = reader.next()) {
            if (field->number == attribute_field::tensor) {
                (void)checkTensor(messageOf(*field));
            } else if (!isAmong(attribute_field::unread, field->number)) {
                refuse("the operator " + type + " has an attribute with a subgraph or another kind of value (field " +
                       std::to_string(field->number) +
                       " of onnx.proto's AttributeProto) that a model file may not hold; export it without");
            }
        }
    }

    const std::string& name_;
    bool hasOpset_ = false;
    std::size_t nodes_ = 0;
    std::size_t tensors_ = 0;
    std::unordered_map<std::string_view, Origin> origins_;
};

}  // namespace

void checkOnnxModel(std::span<const std::byte> bytes, const std::string& name) {
    try {
        OnnxCheck(name).readModel(bytes);
    } catch (const WireError& error) {
        throw ModelError(ModelStatus::inconsistent, name + ": is not an ONNX model: " + error.what());
    }
}

}  // namespace haptoflow::model
