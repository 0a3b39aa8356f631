#include "unity/pass_through.hpp"

#include <algorithm>
#include <cstring>

namespace haptoflow::unity {
namespace {

void passFrame(const AudioBlock& block, std::size_t frame) noexcept {
    const std::size_t kept = std::min(block.inChannels, block.outChannels);
    float* out = block.out + frame * block.outChannels;
    std::memmove(out, block.in + frame * block.inChannels, kept * sizeof(float));
    std::fill(out + kept, out + block.outChannels, 0.0F);
}

}  // namespace

void passThrough(const AudioBlock& block) noexcept {
    const std::size_t frames = block.frames;
    if (block.in == nullptr || block.inChannels == 0) {
        std::fill_n(block.out, frames * block.outChannels, 0.0F);
    } else if (block.inChannels == block.outChannels) {
        if (block.in != block.out) {
            std::memmove(block.out, block.in, frames * block.outChannels * sizeof(float));
        }
    } else if (block.inChannels < block.outChannels) {
        // Start at the last frame: if the buffers are the same, the longer output frames overwrite later input.
        for (std::size_t frame = frames; frame > 0; --frame) {
            passFrame(block, frame - 1);
        }
    } else {
        for (std::size_t frame = 0; frame < frames; ++frame) {
            passFrame(block, frame);
        }
    }
}

}  // namespace haptoflow::unity
