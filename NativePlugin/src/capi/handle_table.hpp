#pragma once

#include <cstdint>
#include <memory>
#include <mutex>
#include <stdexcept>
#include <string>
#include <unordered_map>

namespace haptoflow::capi {

/// Opaque handles to shared objects. A handle is a number that is never reused, not an address, so that a closed or
/// invalid handle is detected instead of dereferenced. Thread-safe.
template <typename Handle, typename Object>
class HandleTable {
public:
    explicit HandleTable(const char* kind) : kind_(kind) {}

    [[nodiscard]] Handle* open(std::shared_ptr<Object> object) {
        const std::lock_guard lock(mutex_);
        const std::uintptr_t number = nextNumber_;
        objects_.emplace(number, std::move(object));
        nextNumber_ += numberStep;
        return reinterpret_cast<Handle*>(number);
    }

    /// Throws std::invalid_argument for a handle that is not open.
    [[nodiscard]] std::shared_ptr<Object> get(const Handle* handle) const {
        const std::lock_guard lock(mutex_);
        const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
        if (found == objects_.end()) {
            refuse();
        }
        return found->second;
    }

    /// Throws std::invalid_argument for a handle that is not open. The object is destroyed outside the lock, when its
    /// last user releases it.
    void close(const Handle* handle) {
        std::shared_ptr<Object> last;
        const std::lock_guard lock(mutex_);
        const auto found = objects_.find(reinterpret_cast<std::uintptr_t>(handle));
        if (found == objects_.end()) {
            refuse();
        }
        last = std::move(found->second);
        objects_.erase(found);
    }

private:
    // Tools that tag the lower bits of pointers expect multiples of 16.
    static constexpr std::uintptr_t numberStep = 16;

    [[noreturn]] void refuse() const { throw std::invalid_argument(std::string("not an open ") + kind_ + " handle"); }

    const char* kind_;
    mutable std::mutex mutex_;
    std::unordered_map<std::uintptr_t, std::shared_ptr<Object>> objects_;
    std::uintptr_t nextNumber_ = numberStep;
};

}  // namespace haptoflow::capi
