// SPDX-License-Identifier: MIT
#include "engine/ecs/registry.h"

#include <limits>

namespace shutter::ecs {

uint32_t takeTypeIndex() {
    static std::atomic<uint32_t> next = 0;
    return next++;
}

uint64_t takeLogNumber() {
    static std::atomic<uint64_t> next = 1;
    return next++;
}

Registry::Registry(Registry&& other) noexcept {
    *this = std::move(other);
}

Registry& Registry::operator=(Registry&& other) noexcept {
    checkUnlocked("move");
    other.checkUnlocked("move");
    mSlots = std::exchange(other.mSlots, {});
    mFreeIndices = std::exchange(other.mFreeIndices, {});
    mAliveCount = std::exchange(other.mAliveCount, 0);
    mSets = std::exchange(other.mSets, {});
    return *this;
}

Entity Registry::create() {
    checkUnlocked("create");
    uint32_t index = 0;
    if (mFreeIndices.empty()) {
        SHUTTER_CHECK(mSlots.size() < kNullEntity.index, "create: no index is left");
        index = static_cast<uint32_t>(mSlots.size());
        mSlots.emplace_back();
    } else {
        index = mFreeIndices.back();
        mFreeIndices.pop_back();
    }
    mSlots[index].alive = true;
    ++mAliveCount;
    return {index, mSlots[index].generation};
}

void Registry::destroy(Entity entity) {
    checkUnlocked("destroy");
    SHUTTER_CHECK(isAlive(entity), "destroy: {} is not alive", entity);
    for (const auto& set : mSets)
        if (set)
            set->erase(entity);
    EntitySlot& slot = mSlots[entity.index];
    slot.alive = false;
    --mAliveCount;
    // A slot whose generations are used up stays dead, so that no old handle comes alive again.
    if (slot.generation == std::numeric_limits<uint32_t>::max())
        return;
    ++slot.generation;
    mFreeIndices.push_back(entity.index);
}

} // namespace shutter::ecs
