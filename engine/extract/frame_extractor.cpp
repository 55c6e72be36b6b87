// SPDX-License-Identifier: MIT
#include "engine/extract/frame_extractor.h"

#include "engine/core/check.h"
#include "engine/extract/frame_view.h"
#include "engine/math/transform.h"
#include "engine/scene/deformation.h"
#include "engine/scene/history.h"

#include <algorithm>
#include <atomic>
#include <cstring>
#include <utility>

namespace shutter::extract {

namespace {

using math::dmat4;

/// Maximum number of rows that count as moving without being written to, in addition to an eighth
/// of all rows.
constexpr size_t kMaxQuiet = 64;

uint64_t takeRevision() {
    static std::atomic<uint64_t> next = 1;
    return next++;
}

bool hasTriangles(const SceneLayout& layout, uint32_t mesh) {
    return !layout.bounds[mesh].isEmpty() &&
           layout.firstGeometry[mesh] != layout.firstGeometry[mesh + 1];
}

bool isStatic(const ObjectPoses& poses) {
    return poses.still || (poses.open == poses.raster && poses.close == poses.raster);
}

} // namespace

core::Result<const ExtractedFrame*> FrameExtractor::update(
    const scene::World& world, const SceneLayout& layout, const ViewRequest& request
) {
    SHUTTER_CHECK(request.width > 0 && request.height > 0, "an empty picture");
    SHUTTER_TRY(mMotionCheck.check(world.registry));
    const WorldChanges changes = mWatch.update(world.registry);
    mFrameView = std::make_unique<const FrameView>(world, request);
    const FrameView& view = *mFrameView;
    const Frame frame{world, layout, request, view};
    mFrame.changes.since = mFrame.changes.revision;
    mFrame.changes.revision = takeRevision();
    mFrame.changes.all = false;
    mFrame.changes.rows.clear();
    const bool mayRefresh =
        mListed && !changes.structure && mLayout == &layout && mRows.size() <= request.entityLimit;
    mLayout = &layout;
    mViewMirrors = view.mirrors();
    if (!mayRefresh || !refresh(frame, changes))
        SHUTTER_TRY(rebuild(frame));
    mView = view.matrices();
    mFrame.constants = view.constants();
    if (layout.hasEnvironment && request.environment)
        mFrame.constants.flags |= shader::kFrameEnvironment;
    addLights(frame);
    mFrame.moves = view.moves() || mMovesInView > 0;
    mFrame.mirrors = view.mirrors();
    mFrame.isCameraAtRest = view.isCameraAtRest();
    return &mFrame;
}

const FrameView& FrameExtractor::view() const {
    SHUTTER_CHECK(mFrameView, "no frame was extracted");
    return *mFrameView;
}

core::Status FrameExtractor::rebuild(const Frame& frame) {
    clear();
    const scene::World& world = frame.world;
    for (auto [entity, instance] : world.registry.view<scene::MeshInstance>()) {
        if (!hasTriangles(frame.layout, instance.mesh) || scene::isAlwaysHidden(world, entity))
            continue;
        list(frame, entity, instance.mesh);
        if (mRows.size() > frame.request.entityLimit)
            return describeFullTable(frame.request.entityLimit);
    }
    // Behind those of static rows, whose number is known only now.
    const auto staticMotions = static_cast<uint32_t>(mFrame.staticMotions.size());
    for (const uint32_t row : mFrame.movingRows)
        if (mFrame.entities[row].motion != shader::kNoMotion)
            mFrame.entities[row].motion += staticMotions;
    sortDraws(&DrawList::still);
    drawMoving(frame.layout);
    mListed = true;
    return {};
}

void FrameExtractor::clear() {
    mFrame.entities.clear();
    mFrame.worldFromObject.clear();
    mFrame.atRest.clear();
    mFrame.staticMotions.clear();
    mFrame.movingMotions.clear();
    mFrame.movingRows.clear();
    mFrame.entityMeshes.clear();
    mFrame.entityHandles.clear();
    mFrame.deformed.clear();
    mFrame.opaque.still.clear();
    mFrame.blended.still.clear();
    mFrame.changes.all = true;
    mFrame.changes.rows.clear();
    mFrame.staticSet = mFrame.staticRevision = takeRevision();
    mRows.clear();
    mHiddenRows.clear();
    mRowOfEntity.clear();
    mJoining.clear();
    mDescendants.clear();
    mFirstMovingMotion = 0;
    mMovesInView = 0;
    mListed = false;
}

bool FrameExtractor::evolves(const Frame& frame, ecs::Entity entity) {
    // Under a moving camera, an entity's blur scale gives a static entity motion.
    return scene::isDeformable(frame.world, entity) || scene::mayObjectMove(frame.world, entity) ||
           scene::findBlurScale(frame.world, entity) != 1.0 ||
           scene::mayComeOrGo(frame.world, entity, frame.request.exposure.frame().open) ||
           frame.request.exposure.cap.findMover(entity) != nullptr;
}

std::optional<FrameExtractor::PosedEntity>
FrameExtractor::pose(const Frame& frame, ecs::Entity entity, uint32_t mesh, bool evolves) {
    const scene::ExposureMotion& motion = frame.view.motion();
    if (motion.isHidden(entity))
        return std::nullopt;
    const ShutterTimes& times = frame.view.times();
    const dmat4 raster = motion.worldFromObject(entity, times.raster);
    PosedEntity posed{ObjectPoses(raster), std::nullopt};
    if (evolves) {
        const auto poseAt = [&](double s) {
            return s == times.raster ? raster : motion.worldFromObject(entity, s);
        };
        posed.poses = ObjectPoses(poseAt(times.open), raster, poseAt(times.close));
    }
    if (!isDrawable(posed.poses))
        return std::nullopt;
    if (scene::isDeformable(frame.world, entity)) {
        posed.shape = poseEntity(motion, entity, frame.layout.reaches.at(mesh), times);
        if (!posed.shape)
            return std::nullopt;
    }
    return posed;
}

void FrameExtractor::list(const Frame& frame, ecs::Entity entity, uint32_t mesh) {
    if (entity.index >= mRowOfEntity.size())
        mRowOfEntity.resize(entity.index + size_t{1}, kNone);
    const bool moving = evolves(frame, entity);
    std::optional<PosedEntity> posed = pose(frame, entity, mesh, moving);
    if (!posed) {
        mRowOfEntity[entity.index] = kHiddenRow;
        mHiddenRows.push_back({entity, mesh, moving});
        return;
    }
    const auto index = static_cast<uint32_t>(mRows.size());
    mRowOfEntity[entity.index] = index;
    Row& row = mRows.emplace_back();
    row.evolves = row.moving = moving;
    row.deformed = kNone;
    shader::EntityRow entry{};
    entry.firstGeometry = frame.layout.firstGeometry[mesh];
    if (posed->shape) {
        row.deformed = static_cast<uint32_t>(mFrame.deformed.size());
        entry.firstGeometry = static_cast<uint32_t>(frame.layout.geometries.size());
        if (!mFrame.deformed.empty()) {
            const DeformedEntity& last = mFrame.deformed.back();
            entry.firstGeometry = mFrame.entities[last.row].firstGeometry +
                                  frame.layout.firstGeometry[last.mesh + 1] -
                                  frame.layout.firstGeometry[last.mesh];
        }
        mFrame.deformed.emplace_back();
    }
    mFrame.entities.push_back(entry);
    mFrame.worldFromObject.push_back(posed->poses.raster);
    mFrame.atRest.push_back(false);
    mFrame.entityMeshes.push_back(mesh);
    mFrame.entityHandles.push_back(entity);
    if (moving)
        mFrame.movingRows.push_back(index);
    else
        row.worldFromObject = posed->poses.raster;
    place(frame, index, std::move(*posed));
    if (!moving)
        addDraws(frame.layout, index);
}

bool FrameExtractor::refresh(const Frame& frame, const WorldChanges& changes) {
    if (!refreshWritten(frame, changes))
        return false;
    for (const HiddenRow& hidden : mHiddenRows)
        if (hidden.evolves && pose(frame, hidden.entity, hidden.mesh, true))
            return false;
    refreshCapped(frame);
    takeOutOfStill();
    if (!isIdentical(mView, frame.view.matrices()))
        placeStill(frame);
    return placeMoving(frame);
}

uint32_t FrameExtractor::rowOf(uint32_t entity) const {
    return entity < mRowOfEntity.size() ? mRowOfEntity[entity] : kNone;
}

void FrameExtractor::refreshCapped(const Frame& frame) {
    for (const auto& [entity, share] : frame.request.exposure.cap.movers) {
        const uint32_t index = rowOf(entity.index);
        if (index == kNone || index == kHiddenRow || mFrame.entityHandles[index] != entity)
            continue;
        mRows[index].evolves = true;
        if (!std::exchange(mRows[index].moving, true))
            mJoining.push_back(index);
    }
}

bool FrameExtractor::refreshWritten(const Frame& frame, const WorldChanges& changes) {
    for (const ecs::Entity entity : changes.drawn) {
        // It is there: a component that was removed would have changed the structure.
        const uint32_t mesh = frame.world.registry.get<scene::MeshInstance>(entity).mesh;
        const uint32_t row = rowOf(entity.index);
        const bool isAsListed =
            row == kNone
                ? !hasTriangles(frame.layout, mesh) || scene::isAlwaysHidden(frame.world, entity)
                : row != kHiddenRow && mesh == mFrame.entityMeshes[row];
        if (!isAsListed)
            return false;
    }
    if (changes.placed.empty())
        return true;
    if (!mDescendants.isBuilt())
        mDescendants.build(frame.world.registry);
    for (const uint32_t entity : mDescendants.collect(changes.placed)) {
        const uint32_t row = rowOf(entity);
        if (row == kHiddenRow ? becomesDrawable(frame, entity)
                              : row != kNone && !refreshRow(frame, row))
            return false;
    }
    return true;
}

bool FrameExtractor::becomesDrawable(const Frame& frame, uint32_t entity) {
    const auto hidden =
        std::find_if(mHiddenRows.begin(), mHiddenRows.end(), [&](const HiddenRow& one) {
            return one.entity.index == entity;
        });
    hidden->evolves = evolves(frame, hidden->entity);
    return pose(frame, hidden->entity, hidden->mesh, hidden->evolves).has_value();
}

bool FrameExtractor::refreshRow(const Frame& frame, uint32_t index) {
    Row& row = mRows[index];
    const ecs::Entity entity = mFrame.entityHandles[index];
    row.evolves = evolves(frame, entity);
    row.written = true;
    if (!row.moving) {
        // Entities written to once tend to be written to every frame.
        row.moving = true;
        mJoining.push_back(index);
    }
    if (row.evolves)
        return true; // posed with the others of its kind
    const auto posed = pose(frame, entity, mFrame.entityMeshes[index], false);
    if (!posed)
        return false;
    row.worldFromObject = posed->poses.raster;
    return true;
}

void FrameExtractor::takeOutOfStill() {
    if (mJoining.empty())
        return;
    for (const uint32_t row : mJoining)
        mFrame.movingRows.insert(
            std::lower_bound(mFrame.movingRows.begin(), mFrame.movingRows.end(), row), row
        );
    mJoining.clear();
    for (DrawList* draws : {&mFrame.opaque, &mFrame.blended})
        std::erase_if(draws->still, [&](const DrawItem& item) {
            return mRows[item.entity].moving;
        });
    mFrame.staticSet = mFrame.staticRevision = takeRevision();
}

void FrameExtractor::placeStill(const Frame& frame) {
    mFrame.changes.all = true;
    mFrame.staticRevision = takeRevision();
    mFrame.staticMotions.clear();
    mFrame.opaque.still.clear();
    mFrame.blended.still.clear();
    for (uint32_t row = 0; row < mRows.size(); ++row) {
        if (mRows[row].moving)
            continue;
        place(frame, row, {ObjectPoses(mRows[row].worldFromObject), std::nullopt});
        addDraws(frame.layout, row);
    }
    sortDraws(&DrawList::still);
}

bool FrameExtractor::placeMoving(const Frame& frame) {
    mFrame.movingMotions.clear();
    mFirstMovingMotion = static_cast<uint32_t>(mFrame.staticMotions.size());
    size_t quiet = 0;
    for (const uint32_t index : mFrame.movingRows) {
        Row& row = mRows[index];
        if (row.evolves) {
            auto posed = pose(frame, mFrame.entityHandles[index], mFrame.entityMeshes[index], true);
            if (!posed)
                return false;
            place(frame, index, std::move(*posed));
        } else {
            quiet += !row.written;
            place(frame, index, {ObjectPoses(row.worldFromObject), std::nullopt});
        }
        row.written = false;
    }
    drawMoving(frame.layout);
    if (quiet > kMaxQuiet + mRows.size() / 8)
        mListed = false; // they are static again from the next frame on
    return true;
}

bool FrameExtractor::isAsBefore(
    const scene::ExposureMotion& before, uint32_t index, const PosedEntity& posed
) const {
    if (!mRows[index].evolves)
        return true;
    const ecs::Entity entity = mFrame.entityHandles[index];
    const double raster = before.exposure().rasterTime;
    return before.worldFromObject(entity, raster) == posed.poses.raster &&
           (!posed.shape || isSame(before.deformationAt(entity, raster), posed.shape->raster));
}

void FrameExtractor::place(const Frame& frame, uint32_t index, PosedEntity posed) {
    Row& row = mRows[index];
    shader::EntityRow& entry = mFrame.entities[index];
    const uint32_t mesh = mFrame.entityMeshes[index];
    mFrame.worldFromObject[index] = posed.poses.raster;
    const bool shapeChanges = posed.shape && posed.shape->changes;
    const bool deformedMirrored = posed.shape && posed.shape->mirrored;
    const scene::ExposureMotion* before = frame.view.before();
    mFrame.atRest[index] = before && !row.written && !shapeChanges && isStatic(posed.poses) &&
                           isAsBefore(*before, index, posed);
    posed.poses.jitters = !before || mFrame.atRest[index];
    PlacedEntity placed = placeEntity(
        frame.view.matrices(),
        posed.poses,
        posed.shape ? posed.shape->bounds : frame.layout.bounds[mesh],
        shapeChanges
    );
    row.mirrored = (glm::determinant(math::dmat3(posed.poses.raster)) < 0.0) != deformedMirrored;
    placed.row.firstGeometry = entry.firstGeometry;
    placed.row.handedness = row.mirrored ? -1.0f : 1.0f;
    if (placed.moves) {
        auto& motions = row.moving ? mFrame.movingMotions : mFrame.staticMotions;
        placed.row.motion =
            static_cast<uint32_t>(motions.size()) + (row.moving ? mFirstMovingMotion : 0);
        motions.push_back(placed.motion);
    }
    if (!mFrame.changes.all && std::memcmp(&entry, &placed.row, sizeof(entry)) != 0)
        mFrame.changes.rows.push_back(index);
    entry = placed.row;
    mMovesInView -= row.movesInView;
    row.movesInView = placed.visible && placed.moves;
    mMovesInView += row.movesInView;
    row.visible = placed.visible;
    row.distance = placed.distance;
    if (!posed.shape)
        return;
    posed.shape->row = index;
    posed.shape->mesh = mesh;
    mFrame.deformed[row.deformed] = std::move(*posed.shape);
}

void FrameExtractor::addDraws(const SceneLayout& layout, uint32_t index) {
    const Row& row = mRows[index];
    if (!row.visible)
        return;
    const uint32_t mesh = mFrame.entityMeshes[index];
    const uint32_t first = layout.firstGeometry[mesh];
    for (uint32_t geometry = first; geometry < layout.firstGeometry[mesh + 1]; ++geometry) {
        const SceneLayout::GeometryInfo& info = layout.geometries[geometry];
        DrawList& draws =
            info.alphaMode == scene::AlphaMode::Blend ? mFrame.blended : mFrame.opaque;
        (row.moving ? draws.moving : draws.still)
            .push_back(
                {index,
                 geometry,
                 mFrame.entities[index].firstGeometry + geometry - first,
                 info.alphaMode,
                 info.doubleSided,
                 row.mirrored != mViewMirrors,
                 row.distance}
            );
    }
}

void FrameExtractor::sortDraws(std::vector<DrawItem> DrawList::*part) {
    for (DrawList* draws : {&mFrame.opaque, &mFrame.blended})
        std::sort((draws->*part).begin(), (draws->*part).end(), [&](const auto& a, const auto& b) {
            return draws->isBefore(a, b);
        });
}

void FrameExtractor::drawMoving(const SceneLayout& layout) {
    mFrame.opaque.moving.clear();
    mFrame.blended.moving.clear();
    for (const uint32_t row : mFrame.movingRows)
        addDraws(layout, row);
    sortDraws(&DrawList::moving);
}

void FrameExtractor::addLights(const Frame& frame) {
    const scene::ExposureMotion& motion = frame.view.motion();
    mFrame.lights.clear();
    mFrame.lightEntities.clear();
    for (auto [entity, light] : frame.world.registry.view<scene::Light>()) {
        if (motion.isHiddenAt(entity, frame.view.times().raster))
            continue;
        const dmat4 world = motion.worldFromLight(entity, frame.view.times().raster);
        // A light that is nowhere lights nothing; its NaN would blacken the picture.
        if (!math::isFinite(world))
            continue;
        mFrame.lights.push_back(makeLight(light, world, frame.view.matrices().eye));
        mFrame.lightEntities.push_back(entity);
    }
    mFrame.constants.lightCount = static_cast<uint32_t>(mFrame.lights.size());
}

} // namespace shutter::extract
