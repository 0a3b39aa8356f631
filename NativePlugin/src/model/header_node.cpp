#include "model/header_node.hpp"

#include "model/model_error.hpp"
#include "model/plain_text.hpp"

#include <algorithm>
#include <cmath>
#include <unordered_set>

namespace haptoflow::model {

namespace {

/// Throws at a document that nests too deeply or repeats a key, before a value is built. nlohmann's parse callback
/// could say both, but its time grows with the square of an array's length.
class Bounds final : public nlohmann::json_sax<nlohmann::json> {
public:
    explicit Bounds(std::string document) : document_(std::move(document)) {}

    bool start_object(std::size_t /*elements*/) override { return open(); }
    bool start_array(std::size_t /*elements*/) override { return open(); }
    bool end_object() override { return close(); }
    bool end_array() override { return close(); }
    bool key(string_t& name) override {
        if (!open_.back().insert(name).second) {
            throw ModelError(ModelStatus::inconsistent,
                             document_ + " names the key \"" + name.substr(0, 64) + "\" twice in one object");
        }
        return true;
    }
    bool null() override { return true; }
    bool boolean(bool /*value*/) override { return true; }
    bool number_integer(number_integer_t /*value*/) override { return true; }
    bool number_unsigned(number_unsigned_t /*value*/) override { return true; }
    bool number_float(number_float_t /*value*/, const string_t& /*text*/) override { return true; }
    bool string(string_t& /*value*/) override { return true; }
    bool binary(binary_t& /*value*/) override { return true; }
    /// The parser that builds the value says it.
    bool parse_error(std::size_t /*position*/, const std::string& /*token*/,
                     const nlohmann::detail::exception& /*error*/) override {
        return false;
    }

private:
    bool open() {
        if (open_.size() >= static_cast<std::size_t>(maximumJsonDepth)) {
            throw ModelError(ModelStatus::oversized,
                             document_ + " nests deeper than " + std::to_string(maximumJsonDepth) + " levels");
        }
        open_.emplace_back();
        return true;
    }
    bool close() {
        open_.pop_back();
        return true;
    }

    std::string document_;
    // The keys of every object that is open; an array has none.
    std::vector<std::unordered_set<std::string>> open_;
};

}  // namespace

nlohmann::json parseBoundedJson(std::string_view text, std::string_view document) {
    const std::string name(document);
    Bounds bounds(name);
    (void)nlohmann::json::sax_parse(text, &bounds);
    try {
        return nlohmann::json::parse(text);
    } catch (const nlohmann::json::parse_error& error) {
        throw ModelError(ModelStatus::damaged, name + " is not valid JSON at its byte " + std::to_string(error.byte));
    } catch (const nlohmann::json::exception&) {
        throw ModelError(ModelStatus::damaged, name + " is not valid JSON: it has a number that is too large");
    }
}

HeaderNode::HeaderNode(const nlohmann::json& value, std::string path, const char* document)
    : value_(&value), path_(std::move(path)), document_(document) {}

void HeaderNode::refuse(const std::string& expectation) const {
    const std::string place = path_.empty() ? std::string(document_) : std::string(document_) + " key \"" + path_ + '"';
    throw ModelError(ModelStatus::inconsistent, place + ": expected " + expectation);
}

void HeaderNode::refuseValue(const std::string& expectation) const {
    if (value_->is_structured()) {
        refuse(expectation + ", found an " + value_->type_name() + " of " + std::to_string(value_->size()));
    }
    // Escaped: the terminal obeys no control character of a file.
    const std::string text = value_->dump(-1, ' ', true);
    refuse(expectation + ", found " + (text.size() > 40 ? text.substr(0, 40) + "..." : text));
}

void HeaderNode::refuseSize(const std::string& found, std::size_t limit) const {
    throw ModelError(ModelStatus::oversized, std::string(document_) + " key \"" + path_ + "\": " + found +
                                                 "; the limit is " + std::to_string(limit));
}

std::optional<HeaderNode> HeaderNode::find(std::string_view key) const {
    if (!value_->is_object()) {
        refuseValue("an object");
    }
    const auto member = value_->find(key);
    if (member == value_->end()) {
        return std::nullopt;
    }
    std::string path = path_.empty() ? std::string(key) : path_ + '.' + std::string(key);
    return HeaderNode(*member, std::move(path), document_);
}

void HeaderNode::requireKnown(std::initializer_list<std::string_view> keys) const {
    if (!value_->is_object()) {
        refuseValue("an object");
    }
    for (const auto& [key, unused] : value_->items()) {
        if (std::ranges::find(keys, key) == keys.end()) {
            std::string known;
            for (const std::string_view each : keys) {
                known += (known.empty() ? "" : ", ") + std::string(each);
            }
            refuse("no key \"" + printable(shortened(key, 40)) + "\"; known are " + known);
        }
    }
}

HeaderNode HeaderNode::at(std::string_view key) const {
    auto member = find(key);
    if (!member) {
        refuse("a member \"" + std::string(key) + "\"");
    }
    return *std::move(member);
}

std::vector<HeaderNode> HeaderNode::elements(std::size_t minimum, std::size_t maximum) const {
    if (!value_->is_array()) {
        refuseValue("an array");
    }
    if (value_->size() > maximum) {
        refuseSize(std::to_string(value_->size()) + " elements", maximum);
    }
    if (value_->size() < minimum) {
        refuse("at least " + std::to_string(minimum) + " elements");
    }
    std::vector<HeaderNode> nodes;
    nodes.reserve(value_->size());
    for (std::size_t index = 0; index < value_->size(); ++index) {
        nodes.emplace_back((*value_)[index], path_ + '[' + std::to_string(index) + ']', document_);
    }
    return nodes;
}

std::vector<double> HeaderNode::numbers(std::size_t count, double minimum, double maximum) const {
    if (!value_->is_array() || value_->size() != count) {
        refuseValue("an array of " + std::to_string(count) + " numbers");
    }
    std::vector<double> result;
    result.reserve(count);
    for (const HeaderNode& node : elements(count, count)) {
        result.push_back(node.number(minimum, maximum));
    }
    return result;
}

std::vector<double> HeaderNode::risingNumbers(std::size_t minimumCount, std::size_t maximumCount, double minimum,
                                              double maximum) const {
    std::vector<double> result;
    for (const HeaderNode& node : elements(minimumCount, maximumCount)) {
        const double value = node.number(minimum, maximum);
        if (!result.empty() && value <= result.back()) {
            node.refuse("a number above the one before");
        }
        result.push_back(value);
    }
    return result;
}

double HeaderNode::number(double minimum, double maximum) const {
    const double value = value_->is_number() ? value_->get<double>() : std::nan("");
    if (!(value >= minimum && value <= maximum)) {
        refuseValue("a number from " + shortNumber(minimum) + " to " + shortNumber(maximum));
    }
    return value;
}

std::int64_t HeaderNode::integer(std::int64_t minimum, std::int64_t maximum) const {
    // A JSON integer above 2^63 - 1 is stored as unsigned and would wrap if read as signed.
    const bool representable =
        value_->is_number_integer() &&
        (!value_->is_number_unsigned() || value_->get<std::uint64_t>() <= static_cast<std::uint64_t>(INT64_MAX));
    const std::int64_t value = representable ? value_->get<std::int64_t>() : 0;
    if (!representable || value < minimum || value > maximum) {
        refuseValue("an integer from " + std::to_string(minimum) + " to " + std::to_string(maximum));
    }
    return value;
}

bool HeaderNode::boolean() const {
    if (!value_->is_boolean()) {
        refuseValue("true or false");
    }
    return value_->get<bool>();
}

bool HeaderNode::isNull() const {
    return value_->is_null();
}

std::string HeaderNode::text(std::size_t maximumBytes) const {
    if (!value_->is_string()) {
        refuseValue("a string");
    }
    const auto& content = value_->get_ref<const std::string&>();
    if (content.size() > maximumBytes) {
        refuseSize(std::to_string(content.size()) + " bytes of text", maximumBytes);
    }
    if (hasControlCharacter(content)) {
        refuse("text without control characters");
    }
    return content;
}

std::string HeaderNode::name(std::size_t maximumBytes) const {
    std::string content = text(maximumBytes);
    if (content.empty()) {
        refuse("text that is not empty");
    }
    return content;
}

std::string HeaderNode::date() const {
    constexpr std::string_view pattern = "0000-00-00";
    std::string content = text(nameBytes);
    const auto fits = [](char letter, char wanted) {
        return wanted == '0' ? letter >= '0' && letter <= '9' : letter == wanted;
    };
    const auto between = [&content](std::size_t place, int highest) {
        const int number = std::stoi(content.substr(place, 2));
        return number >= 1 && number <= highest;
    };
    if (!content.empty() && !(std::equal(content.begin(), content.end(), pattern.begin(), pattern.end(), fits) &&
                              between(5, 12) && between(8, 31))) {
        refuse("a date as YYYY-MM-DD, or an empty string");
    }
    return content;
}

std::string HeaderNode::objectText() const {
    if (!value_->is_object()) {
        refuseValue("an object");
    }
    return value_->dump();
}

}  // namespace haptoflow::model
