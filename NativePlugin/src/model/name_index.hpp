#pragma once

#include "model/header_node.hpp"

#include <cstddef>
#include <string>
#include <unordered_map>

namespace haptoflow::model {

/// Maximum length in bytes of the name of a model, label, tier or blob.
inline constexpr std::size_t nameBytes = 128;

/// Maps names to indices; refuses duplicate names.
class NameIndex {
public:
    void add(const HeaderNode& node, const std::string& name, std::size_t position) {
        if (!positions_.emplace(name, position).second) {
            node.refuse("a name that no other element has; \"" + name + "\" appears twice");
        }
    }
    [[nodiscard]] std::size_t at(const HeaderNode& node, const std::string& what) const {
        const std::string name = node.name(nameBytes);
        const auto found = positions_.find(name);
        if (found == positions_.end()) {
            node.refuse("the name of a " + what + "; there is no \"" + name + '"');
        }
        return found->second;
    }

private:
    std::unordered_map<std::string, std::size_t> positions_;
};

}  // namespace haptoflow::model
