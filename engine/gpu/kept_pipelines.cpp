// SPDX-License-Identifier: MIT
#include "engine/gpu/kept_pipelines.h"

#include <algorithm>
#include <ranges>
#include <utility>

namespace shutter::gpu {

std::optional<PipelineObjects> KeptPipelines::take(const std::string& key) {
    const std::scoped_lock lock(mMutex);
    const auto found = std::ranges::find(mKept, key, &Kept::key);
    if (found == mKept.end())
        return std::nullopt;
    const PipelineObjects objects = found->objects;
    mKept.erase(found);
    return objects;
}

std::optional<PipelineObjects> KeptPipelines::keep(std::string key, PipelineObjects objects) {
    if (mMost == 0 || objects.pipeline == VK_NULL_HANDLE)
        return objects;
    const std::scoped_lock lock(mMutex);
    std::optional<PipelineObjects> leaves;
    if (mKept.size() == mMost) {
        leaves = mKept.front().objects;
        mKept.pop_front();
    }
    mKept.push_back({std::move(key), objects});
    return leaves;
}

std::vector<PipelineObjects> KeptPipelines::takeAll() {
    const std::scoped_lock lock(mMutex);
    std::vector<PipelineObjects> all;
    for (const Kept& kept : mKept)
        all.push_back(kept.objects);
    mKept.clear();
    return all;
}

} // namespace shutter::gpu
