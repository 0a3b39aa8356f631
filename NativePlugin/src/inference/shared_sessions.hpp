#pragma once

#include "inference/graph_session.hpp"

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace haptoflow::inference {

/// The graphs that the tiers of one engine have loaded, so that tiers of the same graph load it once. One thread at a
/// time runs the generators that share a graph, and each fills its inputs before every run, since another one may have
/// written to them. The owner lets one thread at a time call this class.
class SharedSessions {
public:
    /// The session in use of this blob, signature and batch, or what `load` returns.
    template <typename Load>
    [[nodiscard]] std::shared_ptr<GraphSession> getOrLoad(const std::string& blob, const GraphSignature& signature,
                                                          std::size_t maximumBatch, Load load) {
        for (const Entry& entry : entries_) {
            if (entry.blob == blob && entry.maximumBatch == maximumBatch && entry.signature == signature) {
                if (auto session = entry.session.lock()) {
                    return session;
                }
            }
        }
        std::shared_ptr<GraphSession> session = load();
        entries_.push_back({blob, signature, maximumBatch, session});
        return session;
    }

    /// How many sessions were loaded.
    [[nodiscard]] std::size_t loaded() const noexcept { return entries_.size(); }

private:
    struct Entry {
        std::string blob;
        GraphSignature signature;
        std::size_t maximumBatch;
        /// Ends with the last generator.
        std::weak_ptr<GraphSession> session;
    };
    std::vector<Entry> entries_;
};

}  // namespace haptoflow::inference
