// SPDX-License-Identifier: MIT
// Resources of frames in flight that only some frames use.
#pragma once

#include "engine/core/idle_counter.h"
#include "engine/gpu/device.h"

#include <cstdint>
#include <memory>
#include <utility>
#include <vector>

namespace shutter::render {

/// One object per frame in flight, made by the first frame that uses it. All are freed together
/// once no frame has used any for core::kFramesKept frames. \tparam T is made from a gpu::Device&
template <class T> class PerSlot {
  public:
    PerSlot(gpu::Device& device, uint32_t slotCount) : mDevice(device), mObjects(slotCount) {}

    /// The slot's, for the frame that is being declared.
    [[nodiscard]] T& use(uint32_t slot) {
        mIsUsed = true;
        std::unique_ptr<T>& object = mObjects.at(slot);
        if (!object)
            object = std::make_unique<T>(mDevice);
        return *object;
    }

    /// Frees the slot's after a frame that was declared and not submitted, since it counts work as
    /// done that the GPU never did.
    void drop(uint32_t slot) {
        mObjects.at(slot).reset();
        mIsUsed = false;
    }

    /// Must be called once per submitted frame that effects draw.
    void endFrame() {
        if (!mIdle.advance(std::exchange(mIsUsed, false)))
            return;
        for (std::unique_ptr<T>& object : mObjects)
            object.reset();
    }

  private:
    gpu::Device& mDevice;
    std::vector<std::unique_ptr<T>> mObjects;
    core::IdleCounter mIdle; ///< of all slots: with two in flight each is used every second frame
    bool mIsUsed = false;    ///< since the last endFrame()
};

} // namespace shutter::render
