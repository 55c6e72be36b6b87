// SPDX-License-Identifier: MIT
#include "engine/extract/world_watch.h"

#include "engine/scene/auto_focus.h"
#include "engine/scene/lens.h"
#include "engine/scene/vertex_waves.h"

#include <fmt/format.h>

#include <algorithm>
#include <string>
#include <utility>

namespace shutter::extract {

namespace {

/// Calls `use` with the changes of each type; every cursor moves on.
template <class Cursors, class Use>
void forEachType(const ecs::Registry& registry, Cursors& cursors, Use&& use) {
    const auto one = [&]<class T>(std::pair<T*, ecs::ChangeCursor>& cursor) {
        use(registry.changesSince<T>(cursor.second));
    };
    std::apply([&](auto&... each) { (one(each), ...); }, cursors.all);
}

std::string describe(const ecs::Registry& registry, ecs::Entity entity) {
    const auto* name = registry.find<scene::Name>(entity);
    return name && !name->value.empty() ? fmt::format("'{}'", name->value)
                                        : fmt::format("entity {}", entity.index);
}

/// Validates each component of type T that may have changed since `cursor`, which moves on unless
/// one is not valid.
template <class T, class Validate>
core::Status
checkChanged(const ecs::Registry& registry, ecs::ChangeCursor& cursor, Validate validate) {
    ecs::ChangeCursor next = cursor;
    const ecs::Changes changes = registry.changesSince<T>(next);
    const auto checkOne = [&](ecs::Entity entity, const T& component) -> core::Status {
        if (core::Status valid = validate(component); !valid)
            return core::makeError("{}: {}", describe(registry, entity), valid.error().message);
        return {};
    };
    if (changes.all) {
        for (auto [entity, component] : registry.view<T>())
            SHUTTER_TRY(checkOne(entity, component));
    } else {
        for (const ecs::Entity entity : changes.entities) {
            const T* component = registry.isAlive(entity) ? registry.find<T>(entity) : nullptr;
            if (!component)
                continue;
            SHUTTER_TRY(checkOne(entity, *component));
        }
    }
    cursor = next;
    return {};
}

} // namespace

core::Status MotionCheck::check(const ecs::Registry& registry) {
    SHUTTER_TRY(checkChanged<scene::PathMotion>(registry, mPaths, scene::validatePath));
    SHUTTER_TRY(checkChanged<scene::LensMotion>(registry, mLenses, scene::validateLens));
    SHUTTER_TRY(checkChanged<scene::FocusMotion>(registry, mFocuses, scene::validateFocus));
    SHUTTER_TRY(checkChanged<scene::CameraLens>(registry, mOpenings, [](const auto& lens) {
        return scene::validate(lens, "lens.");
    }));
    SHUTTER_TRY(checkChanged<scene::LensOverride>(registry, mOverrides, [](const auto& lens) {
        return scene::validate(lens, "lens override: ");
    }));
    SHUTTER_TRY(checkChanged<scene::AutoFocus>(registry, mAutoFocuses, scene::validateAutoFocus));
    return checkChanged<scene::VertexWaves>(registry, mWaves, scene::validateWaves);
}

WorldChanges WorldWatch::update(const ecs::Registry& registry) {
    WorldChanges changes;
    forEachType(registry, mPlacing, [&](const ecs::Changes& one) {
        changes.structure = changes.structure || one.all;
        changes.placed.insert(changes.placed.end(), one.entities.begin(), one.entities.end());
    });
    forEachType(registry, mHierarchy, [&](const ecs::Changes& one) {
        changes.structure = changes.structure || one.all || !one.entities.empty();
    });
    forEachType(registry, mPresence, [&](const ecs::Changes& one) {
        changes.structure = changes.structure || one.structure;
    });
    const ecs::Changes drawn = registry.changesSince<scene::MeshInstance>(mDrawn);
    changes.structure = changes.structure || drawn.structure;
    changes.drawn.assign(drawn.entities.begin(), drawn.entities.end());
    return changes;
}

void Descendants::build(const ecs::Registry& registry) {
    mFirstChild.clear();
    mNextSibling.clear();
    mVisit.clear();
    const auto grow = [&](uint32_t index) {
        if (index < mFirstChild.size())
            return;
        mFirstChild.resize(index + size_t{1}, kNone);
        mNextSibling.resize(index + size_t{1}, kNone);
    };
    for (auto [entity, parent] : registry.view<scene::Parent>()) {
        if (parent.entity == ecs::kNullEntity)
            continue;
        grow(std::max(entity.index, parent.entity.index));
        mNextSibling[entity.index] = std::exchange(mFirstChild[parent.entity.index], entity.index);
    }
    mBuilt = true;
}

void Descendants::visit(uint32_t entity, std::vector<uint32_t>& visited) {
    if (entity >= mVisit.size())
        mVisit.resize(entity + size_t{1}, 0);
    if (mVisit[entity] == mCollects)
        return;
    mVisit[entity] = mCollects;
    visited.push_back(entity);
}

std::vector<uint32_t> Descendants::collect(std::span<const ecs::Entity> roots) {
    ++mCollects;
    std::vector<uint32_t> visited;
    for (const ecs::Entity root : roots)
        visit(root.index, visited);
    // Appended entries are visited in turn: a deep hierarchy must not overflow the stack.
    for (size_t i = 0; i < visited.size(); ++i) {
        if (visited[i] >= mFirstChild.size())
            continue;
        for (uint32_t child = mFirstChild[visited[i]]; child != kNone; child = mNextSibling[child])
            visit(child, visited);
    }
    return visited;
}

} // namespace shutter::extract
