// SPDX-License-Identifier: MIT
#include "engine/gpu/replaced_shader.h"

#include "engine/gpu/shader_reflection.h"

#include <algorithm>
#include <deque>
#include <mutex>
#include <ranges>
#include <utility>

namespace shutter::gpu {

namespace {

constexpr size_t kSpirvHeaderWords = 5;

struct Replacements {
    std::mutex mutex;
    std::deque<std::vector<ReplacedShader>> calls; ///< the last one counts
};

Replacements& replacements() {
    static Replacements all;
    return all;
}

bool isSpirv(std::span<const uint32_t> words) {
    if (words.size() < kSpirvHeaderWords || words[0] != kSpirvMagic)
        return false;
    for (size_t i = kSpirvHeaderWords; i < words.size();) {
        const size_t count = words[i] >> 16u;
        if (count == 0 || count > words.size() - i)
            return false;
        i += count;
    }
    return true;
}

} // namespace

void replaceShaders(std::vector<ReplacedShader> shaders) {
    Replacements& all = replacements();
    const std::lock_guard lock(all.mutex);
    all.calls.push_back(std::move(shaders));
}

std::span<const uint32_t> findShader(std::span<const uint32_t> own) {
    Replacements& all = replacements();
    const std::lock_guard lock(all.mutex);
    if (all.calls.empty())
        return own;
    for (const ReplacedShader& shader : all.calls.back())
        if (std::ranges::equal(shader.own, own))
            return shader.now;
    return own;
}

core::Status checkReplacement(const ReplacedShader& shader) {
    if (!isSpirv(shader.now))
        return core::makeError("it is no SPIR-V");
    const std::vector<ShaderBinding> known = reflectBindings(shader.own);
    for (const ShaderBinding& binding : reflectBindings(shader.now))
        if (std::find(known.begin(), known.end(), binding) == known.end())
            return core::makeError(
                "set {}, binding {} is new or of another kind: the program must be built for it",
                binding.set,
                binding.binding
            );
    return {};
}

} // namespace shutter::gpu
