#include "inference/load_limits.hpp"

#include <utility>

namespace haptoflow::inference {

void Cancellation::cancel() noexcept {
    const std::lock_guard lock(mutex_);
    if (!std::exchange(isCancelled_, true)) {
        for (const CancellationAction* action : actions_) {
            action->action_();
        }
    }
}

bool Cancellation::isCancelled() const noexcept {
    const std::lock_guard lock(mutex_);
    return isCancelled_;
}

CancellationAction::CancellationAction(const Cancellation* cancellation, std::function<void()> action)
    : cancellation_(cancellation), action_(std::move(action)) {
    if (cancellation_ == nullptr) {
        return;
    }
    const std::lock_guard lock(cancellation_->mutex_);
    cancellation_->actions_.push_back(this);
    if (cancellation_->isCancelled_) {
        action_();
    }
}

CancellationAction::~CancellationAction() {
    if (cancellation_ != nullptr) {
        const std::lock_guard lock(cancellation_->mutex_);
        std::erase(cancellation_->actions_, this);
    }
}

}  // namespace haptoflow::inference
