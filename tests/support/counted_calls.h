// SPDX-License-Identifier: MIT
// How often the tree calls a function of Vulkan that returns nothing.
#pragma once

#include "engine/gpu/vulkan.h"

#include <atomic>
#include <cstdint>

namespace shutter::test {

/// Counts calls while it lives: `CountedCalls<&vkCmdDispatch> dispatches;`. One per function at a
/// time, after Vulkan was loaded.
template <auto pointer> class CountedCalls;

template <class... Args, void(VKAPI_PTR** pointer)(Args...)> class CountedCalls<pointer> {
  public:
    CountedCalls() {
        sNext = *pointer;
        sCount = 0;
        *pointer = &CountedCalls::call;
    }

    ~CountedCalls() { *pointer = sNext; }

    CountedCalls(const CountedCalls&) = delete;
    CountedCalls& operator=(const CountedCalls&) = delete;

    [[nodiscard]] uint32_t count() const { return sCount; }

  private:
    static VKAPI_ATTR void VKAPI_CALL call(Args... args) {
        ++sCount;
        sNext(args...);
    }

    static inline void(VKAPI_PTR* sNext)(Args...) = nullptr;
    static inline std::atomic<uint32_t> sCount = 0;
};

} // namespace shutter::test
