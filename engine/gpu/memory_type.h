// SPDX-License-Identifier: MIT
// Which type of memory serves which use. Drivers list their types in different orders and with
// heaps of very different sizes, so the choice depends on each type's properties, and is a pure
// function.
#pragma once

#include "engine/gpu/vulkan.h"

#include <cstdint>
#include <functional>
#include <span>
#include <vector>

namespace shutter::gpu {

enum class MemoryUse : uint8_t {
    Device,   ///< fast for the GPU, not mapped
    Staging,  ///< mapped; the CPU writes it once, a transfer reads it once: best in main memory
    Stream,   ///< mapped; the CPU writes it for a frame, shaders read it: best near the GPU
    Readback, ///< mapped; written by the GPU, read by the CPU: best in the CPU's caches
};

/// The types of `memory` in `typeBits` that serve `use`, best first; empty where none does. Staging
/// and Stream are always coherent; Readback need not be (Buffer::mapped). Types with properties
/// beyond the core's five host and device ones are left out: they come with conditions that this
/// engine does not meet (protected submissions, features of AMD's, transient attachments).
/// \param bytes of the allocation; streams pass over a heap that one would fill by a quarter
[[nodiscard]] std::vector<uint32_t> rankMemoryTypes(
    const VkPhysicalDeviceMemoryProperties& memory,
    uint32_t typeBits,
    MemoryUse use,
    VkDeviceSize bytes
);

/// What allocateInTurn ended with.
struct TypeAttempt {
    VkResult result =
        VK_ERROR_FEATURE_NOT_PRESENT; ///< of the last attempt; this where there was none
    uint32_t type = 0;                ///< of the last attempt
};

/// Calls `allocate` with one type after the other, for as long as it is out of device memory: the
/// heap of the best type may be full, or no larger than a window of 256 MiB.
[[nodiscard]] TypeAttempt
allocateInTurn(std::span<const uint32_t> types, const std::function<VkResult(uint32_t)>& allocate);

} // namespace shutter::gpu
