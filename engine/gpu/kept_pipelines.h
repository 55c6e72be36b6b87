// SPDX-License-Identifier: MIT
// Cache of unused pipelines for reuse. Drivers cache compiled code, but some, such as lavapipe,
// translate the whole shader before they look it up: 80 ms for a large one. Programs that make the
// same effect many times, such as tests and benchmarks, would spend most of their time there.
#pragma once

#include "engine/gpu/vulkan.h"

#include <cstddef>
#include <deque>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

namespace shutter::gpu {

/// What makes up a pipeline.
struct PipelineObjects {
    VkPipeline pipeline = VK_NULL_HANDLE;
    VkPipelineLayout layout = VK_NULL_HANDLE;
    VkDescriptorSetLayout setLayout = VK_NULL_HANDLE; ///< set 0

    bool operator==(const PipelineObjects&) const = default;
};

/// Makes no Vulkan calls: the owner destroys the pipelines that it returns. Thread-safe, since
/// pipelines may be made on several threads.
class KeptPipelines {
  public:
    /// \param most maximum number; 0: none
    explicit KeptPipelines(size_t most) : mMost(most) {}

    [[nodiscard]] size_t most() const { return mMost; }

    /// Returns and removes a cached pipeline of this key (pipeline_key.h).
    [[nodiscard]] std::optional<PipelineObjects> take(const std::string& key);
    /// \return the pipeline to destroy, if any: the oldest if there is no room, or the given one if
    /// it is incomplete
    [[nodiscard]] std::optional<PipelineObjects> keep(std::string key, PipelineObjects objects);
    /// Hands over all.
    [[nodiscard]] std::vector<PipelineObjects> takeAll();

  private:
    struct Kept {
        std::string key;
        PipelineObjects objects;
    };

    size_t mMost;
    std::mutex mMutex;
    std::deque<Kept> mKept; ///< the oldest first
};

} // namespace shutter::gpu
