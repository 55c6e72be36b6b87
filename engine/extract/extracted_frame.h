// SPDX-License-Identifier: MIT
// The world, copied for one frame into what rendering reads: the entity table (one row per
// drawn entity; the row's index is its mesh id), lights, draws and constants.
#pragma once

#include "engine/core/result.h"
#include "engine/extract/deformed_entity.h"
#include "engine/math/bounds.h"
#include "engine/math/math.h"
#include "engine/scene/assets.h"
#include "engine/scene/deformed_bounds.h"
#include "engine/scene/motion.h"
#include "engine/scene/world.h"
#include "shaders/render/scene_shared.h"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace shutter::extract {

/// Maximum number of rows of the entity table: instance indices of ray tracing have 24 bits.
inline constexpr uint32_t kMaxEntities = (1u << 24) - 1;

/// Where inside the pixel a sample is taken.
enum class PixelModel : uint8_t {
    Centre, ///< at the centre: isolates motion from anti-aliasing
    Box,    ///< anywhere, evenly: a box filter one pixel wide
};

/// The data of a scene's meshes that extraction needs once they are on the device.
struct SceneLayout {
    struct GeometryInfo {
        uint32_t firstIndex = 0;
        uint32_t indexCount = 0;
        scene::AlphaMode alphaMode = scene::AlphaMode::Opaque;
        bool doubleSided = false;
        uint32_t vertexCount = 0;
        /// First index of the same triangles in reverse order, for blended geometries.
        uint32_t firstReversed = 0;
        bool premultiplies = false; ///< blended, and not scene::BlendMode::Over
    };

    std::vector<uint32_t> firstGeometry;   ///< one per mesh, and one past the last
    std::vector<GeometryInfo> geometries;  ///< all meshes' primitives in order
    std::vector<math::Bounds> bounds;      ///< one per mesh, object space, undeformed
    std::vector<scene::PoseReach> reaches; ///< one per mesh
    bool hasEnvironment = false;           ///< the scene is lit by one
    bool hasBlended = false;               ///< a geometry is scene::AlphaMode::Blend
};

/// How a camera's frame lies in a picture of another shape; it is in the middle, and pixels are
/// square.
enum class FrameFit : uint8_t {
    Whole, ///< the whole frame is visible (glTF 2.0, 3.10.3), with margins where the shapes differ
    Height ///< it is as high as the picture: a narrower picture crops its sides
};

/// What ViewRequest::jitterPx moves.
enum class Jittered : uint8_t {
    All,
    /// Entities that did not move since the previous frame and do not move during the exposure;
    /// none while the camera moves.
    Static,
};

struct ViewRequest {
    ecs::Entity camera;
    scene::ExposureInterval exposure;
    /// Shutter time of a sharp picture of one instant of the exposure; nothing: the raster instant,
    /// with the motion over the exposure.
    std::optional<double> instant;
    /// Where the picture is taken and its motion begins and ends, for a part of the exposure;
    /// nothing: all of it. `instant` takes precedence.
    std::optional<ShutterTimes> part{};
    uint32_t width = 1280; ///< pixels, above 0
    uint32_t height = 720; ///< pixels, above 0
    FrameFit frameFit = FrameFit::Whole;
    math::dvec2 jitterPx{0.0}; ///< moves the sample inside the pixel, [-0.5, 0.5]
    Jittered jittered = Jittered::All;
    /// Edges are drawn with several samples per pixel while the camera moves or its lens spreads
    /// something, where the device can.
    bool samplesEdges = false;
    /// The camera has a lens (scene::hasLens()), and the method samples many points of it. False:
    /// the view of a pinhole at its centre.
    bool usesLens = false;
    /// Where in the lens the raster is taken from, [0, 1)^2 (aperturePoint()); nothing: its middle.
    std::optional<math::dvec2> lensPlace{};
    /// Index of this frame among those that are averaged to a picture: with usesLens each uses
    /// other lens samples (math::spreadLensPairs()). Nothing: the frame is the picture.
    std::optional<uint32_t> lensTurn{};
    math::vec3 background{0.0f}; ///< linear RGB for the background
    math::vec3 ambient{0.0f};    ///< uniform radiance from everywhere, linear RGB
    float lodBias = 0.0f;        ///< added to texture levels; negative is sharper
    /// Added to lodBias in the raster for entities without motion, if the camera does not move.
    float staticLodBias = 0.0f;
    bool unlit = false; ///< base colour only
    /// Where the scene has an environment: it is seen and lights, in place of the two colours.
    bool environment = true;
    /// What is outside of the picture changes it, as what holds a light back does.
    bool unseenMatters = false;
    uint32_t entityLimit = kMaxEntities; ///< most rows of the entity table, up to kMaxEntities
};

struct DrawItem {
    uint32_t entity = 0;   ///< row of the entity table
    uint32_t geometry = 0; ///< index into SceneLayout::geometries
    /// Row of the frame's geometry table: `geometry`, unless the entity's mesh is deformed.
    uint32_t geometryRow = 0;
    scene::AlphaMode alphaMode = scene::AlphaMode::Opaque;
    bool doubleSided = false;
    bool mirrored = false; ///< the transform, the skeleton or the view reverses the winding
    float distance = 0.0f; ///< of the bounds' centre from the camera, metres
};

/// Draws sorted by distance, then by row. Static entities are in a separate list, whose order is
/// preserved from frame to frame.
struct DrawList {
    bool farFirst = false;
    std::vector<DrawItem> still;
    std::vector<DrawItem> moving;

    [[nodiscard]] size_t size() const { return still.size() + moving.size(); }

    [[nodiscard]] bool empty() const { return still.empty() && moving.empty(); }

    [[nodiscard]] bool isBefore(const DrawItem& a, const DrawItem& b) const {
        if (a.distance != b.distance)
            return farFirst ? a.distance > b.distance : a.distance < b.distance;
        return a.entity != b.entity ? a.entity < b.entity : a.geometry < b.geometry;
    }

    /// Visits all items in drawing order.
    template <class Visit> void forEach(Visit&& visit) const {
        auto next = moving.begin();
        for (const DrawItem& item : still) {
            for (; next != moving.end() && isBefore(*next, item); ++next)
                visit(*next);
            visit(item);
        }
        std::for_each(next, moving.end(), visit);
    }

    /// Returns all items in drawing order.
    [[nodiscard]] std::vector<DrawItem> merge() const {
        std::vector<DrawItem> all;
        forEach([&](const DrawItem& item) { all.push_back(item); });
        return all;
    }
};

/// Which rows of the entity table are not as they were at an earlier frame of the same
/// FrameExtractor.
struct RowChanges {
    uint64_t revision = 0; ///< process-unique revision of this frame's rows
    uint64_t since = 0;    ///< revision of the earlier frame's; 0: there was none
    bool all = true;
    std::vector<uint32_t> rows; ///< unless `all`
};

struct ExtractedFrame {
    std::vector<shader::EntityRow> entities;
    /// Rows that move in the picture; EntityRow::motion indexes the two lists as one.
    std::vector<shader::EntityMotion> staticMotions; ///< ... while they are static in the world
    std::vector<shader::EntityMotion> movingMotions;
    RowChanges changes; ///< of `entities`
    /// Rows that move, deform, have a MotionBlur's scale, or were written to since the rows were
    /// listed; in rising order. The others are static in the world.
    std::vector<uint32_t> movingRows;
    /// Changes whenever other rows are static; no two frame extractors have the same.
    uint64_t staticSet = 0;
    /// Changes whenever a static row changes, also in camera-relative space, as when the camera
    /// moves.
    uint64_t staticRevision = 0;
    /// With Jittered::Static: whether the camera has not moved since the previous frame and does
    /// not move.
    bool isCameraAtRest = false;
    /// One per row, with Jittered::Static: whether the entity is at rest and does not deform.
    /// Such entities are jittered unless the camera moves.
    std::vector<bool> atRest;
    std::vector<math::dmat4> worldFromObject; ///< one per row: at the raster instant
    std::vector<uint32_t> entityMeshes;       ///< one per row: index into Assets::meshes
    std::vector<ecs::Entity> entityHandles;   ///< one per row: its entity
    /// Entities whose mesh is skinned or morphed, in the order of their rows. Their rows of the
    /// frame's geometry table follow the scene's own, entity after entity.
    std::vector<DeformedEntity> deformed;
    DrawList opaque{.farFirst = false, .still = {}, .moving = {}}; ///< opaque and masked
    DrawList blended{.farFirst = true, .still = {}, .moving = {}};
    std::vector<shader::LightRow> lights;
    std::vector<ecs::Entity> lightEntities; ///< one per light: its entity
    shader::FrameConstants constants{};     ///< without the tables' addresses and rows
    bool moves = false;                     ///< something in the picture, or the camera, moves
    bool mirrors = false;                   ///< the view turns windings round (FrameView::mirrors)
};

/// Whether `row` is one of `rows`, which are in rising order.
[[nodiscard]] inline bool isTaken(std::span<const uint32_t> rows, uint32_t row) {
    return std::binary_search(rows.begin(), rows.end(), row);
}

/// The error for a scene with more entities than `limit`.
[[nodiscard]] core::Error describeFullTable(uint32_t limit);

/// Extracts from scratch; FrameExtractor (frame_extractor.h) gives the same more cheaply from frame
/// to frame.
/// Entities whose transform or shape is singular or not finite, or whose mesh has no triangles, get
/// no row.
/// Error: the world draws more entities than ViewRequest::entityLimit.
[[nodiscard]] core::Result<ExtractedFrame>
extractFrame(const scene::World& world, const SceneLayout& layout, const ViewRequest& request);

/// Null: the row's mesh is not deformed.
[[nodiscard]] const DeformedEntity* findDeformed(const ExtractedFrame& frame, uint32_t row);

/// Object space, raster instant: the deformed mesh's where there is one.
[[nodiscard]] const math::Bounds&
findRowBounds(const ExtractedFrame& frame, const SceneLayout& layout, uint32_t row);

/// True when the box lies wholly beyond one of the side planes or behind the near plane. Depth is
/// reversed, and nothing is too far.
[[nodiscard]] bool isOutsideView(const math::dmat4& clipFromObject, const math::Bounds& bounds);

} // namespace shutter::extract
