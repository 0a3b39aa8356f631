#include "engine/relief_table.hpp"

#include <utility>

namespace haptoflow::engine {

std::uint32_t ReliefTable::add(std::shared_ptr<const effects::ReliefMap> map) {
    const std::lock_guard lock(mutex_);
    maps_.emplace(last_ + 1, std::move(map));
    edition_.fetch_add(1, std::memory_order_release);
    return ++last_;
}

bool ReliefTable::remove(std::uint32_t number) {
    std::shared_ptr<const effects::ReliefMap> freed;
    const std::lock_guard lock(mutex_);
    const auto found = maps_.find(number);
    if (found == maps_.end()) {
        return false;
    }
    freed = std::move(found->second);
    maps_.erase(found);
    edition_.fetch_add(1, std::memory_order_release);
    return true;
}

void ReliefTable::follow(std::uint32_t wanted, std::uint32_t& number, std::uint64_t& edition,
                         std::shared_ptr<const effects::ReliefMap>& map) const noexcept {
    const std::uint64_t newest = edition_.load(std::memory_order_acquire);
    if (wanted == number && newest == edition) {
        return;
    }
    if (wanted == 0) {
        number = 0;
        edition = newest;
        map.reset();
        return;
    }
    const std::unique_lock lock(mutex_, std::try_to_lock);
    if (!lock.owns_lock()) {
        return;
    }
    const auto found = maps_.find(wanted);
    map = found != maps_.end() ? found->second : nullptr;
    number = wanted;
    edition = newest;
}

ReliefTable& reliefs() noexcept {
    static ReliefTable table;
    return table;
}

}  // namespace haptoflow::engine
