// SPDX-License-Identifier: MIT
// Incremental extraction: static entities before a static camera cost nothing after the first
// frame.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"
#include "engine/extract/world_watch.h"

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace shutter::extract {

/// Owns a frame and updates it. A row is recomputed if the entity may move or deform, or if its or
/// its ancestors' components may have changed (ecs::Registry::changesSince); all rows are, if the
/// camera, its lens, the size or the jitter changed. The list of rows is rebuilt when entities are
/// created, destroyed, hidden or shown, change parents or meshes, become drawable or undrawable, or
/// when too many changed.
class FrameExtractor {
  public:
    /// The frame equals extractFrame()'s, except that rows that were written to still count as
    /// moving ones, and that the table of motions may be in another order. It lives until the next
    /// call.
    /// \param layout must not change between calls
    /// Error: as extractFrame's.
    [[nodiscard]] core::Result<const ExtractedFrame*>
    update(const scene::World& world, const SceneLayout& layout, const ViewRequest& request);

    /// Moves the frame out; must be the last call.
    [[nodiscard]] ExtractedFrame take() { return std::move(mFrame); }

    /// The camera and the motion that the frame was made with. Needs a frame (CHECKed); reads the
    /// world, which must be as it was then.
    [[nodiscard]] const FrameView& view() const;

  private:
    /// Data per row of the entity table.
    struct Row {
        math::dmat4 worldFromObject{1.0}; ///< unless `evolves`: at all times
        uint32_t deformed = 0;            ///< its place in ExtractedFrame::deformed, or kNone
        float distance = 0.0f;            ///< as PlacedEntity's
        bool evolves = false;             ///< its pose differs between the instants
        bool moving = false;              ///< in ExtractedFrame::movingRows, or joins them
        bool written = false;             ///< to, since the previous frame
        bool visible = false;             ///< in the picture
        bool movesInView = false;
        bool mirrored = false; ///< the transform or the skeleton turns the winding round
    };

    /// An entity that can be drawn, where it is.
    struct PosedEntity {
        ObjectPoses poses;
        std::optional<DeformedEntity> shape; ///< without row and mesh
    };

    /// What one call works on.
    struct Frame {
        const scene::World& world;
        const SceneLayout& layout;
        const ViewRequest& request;
        const FrameView& view;
    };

    /// An entity that cannot be drawn now: it has no row.
    struct HiddenRow {
        ecs::Entity entity;
        uint32_t mesh = 0;
        bool evolves = false;
    };

    /// In mRowOfEntity; smaller values are rows.
    static constexpr uint32_t kNone = 0xFFFFFFFFu;
    static constexpr uint32_t kHiddenRow = 0xFFFFFFFEu;

    // Rebuilds the list of rows.
    core::Status rebuild(const Frame& frame);
    void clear();
    void list(const Frame& frame, ecs::Entity entity, uint32_t mesh);

    // Updates the rows. False: the list has to be rebuilt.
    bool refresh(const Frame& frame, const WorldChanges& changes);
    bool refreshWritten(const Frame& frame, const WorldChanges& changes);
    bool refreshRow(const Frame& frame, uint32_t index);
    /// A row, kHiddenRow or kNone. \param entity index
    [[nodiscard]] uint32_t rowOf(uint32_t entity) const;
    bool becomesDrawable(const Frame& frame, uint32_t entity);
    /// Entities with a share of the cap count as moving, even if static in the world.
    void refreshCapped(const Frame& frame);
    void takeOutOfStill();
    void placeStill(const Frame& frame);
    bool placeMoving(const Frame& frame);

    static bool evolves(const Frame& frame, ecs::Entity entity);
    /// Nothing for what cannot be drawn.
    static std::optional<PosedEntity>
    pose(const Frame& frame, ecs::Entity entity, uint32_t mesh, bool evolves);
    /// Whether the entity was there one frame ago, in the same shape.
    [[nodiscard]] bool
    isAsBefore(const scene::ExposureMotion& before, uint32_t index, const PosedEntity& posed) const;
    void place(const Frame& frame, uint32_t index, PosedEntity posed);
    void addDraws(const SceneLayout& layout, uint32_t index);
    void sortDraws(std::vector<DrawItem> DrawList::*part);
    void drawMoving(const SceneLayout& layout);
    void addLights(const Frame& frame);

    ExtractedFrame mFrame;
    std::vector<Row> mRows;
    std::vector<HiddenRow> mHiddenRows;
    std::vector<uint32_t> mRowOfEntity; ///< by entity index: a row, kHiddenRow or kNone
    std::vector<uint32_t> mJoining;     ///< rows that count as moving ones from this frame on
    WorldWatch mWatch;
    MotionCheck mMotionCheck;
    Descendants mDescendants;
    std::unique_ptr<const FrameView> mFrameView; ///< of the frame
    ViewMatrices mView;                          ///< that the rows were placed for
    const SceneLayout* mLayout = nullptr;
    uint32_t mFirstMovingMotion = 0; ///< in the table of motions
    uint32_t mMovesInView = 0;       ///< rows
    bool mViewMirrors = false;       ///< FrameView::mirrors()
    bool mListed = false;            ///< false: the list of rows has to be rebuilt
};

} // namespace shutter::extract
