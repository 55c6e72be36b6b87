// SPDX-License-Identifier: MIT
#include "engine/extract/timed_tables.h"

#include "engine/core/words.h"
#include "engine/extract/frame_view.h"
#include "engine/math/transform.h"
#include "engine/scene/auto_focus.h"
#include "engine/scene/exposure_motion.h"
#include "engine/scene/lens.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace shutter::extract {

namespace {

using math::Bounds;
using math::dmat4;
using math::dvec3;

constexpr uint32_t kPathIntervals = 16;
/// Intervals of the exposure in which a lens that is focused or zooms counts as linear.
constexpr uint32_t kLensIntervals = 64;
/// Boxes grow by this much of their largest coordinate: rounding of keys and of the ray's way into
/// object space must not leave a surface outside of its box.
constexpr double kBoxGrowth = 1.0e-5;
/// Memory per triangle between two keys: its box, its share of a BLAS, and scratch.
constexpr uint64_t kBytesPerBox = 24 + 200;
/// Deviation of a light's place, of the length of its way, and of its direction, radians.
constexpr double kLightTolerance = 1.0e-3;

bool isFiniteBox(const Bounds& bounds) {
    constexpr double kLargest = 1.0e18; // lavapipe's rays lose themselves beyond 1e20
    for (int axis = 0; axis < 3; ++axis)
        if (!(bounds.min[axis] > -kLargest) || !(bounds.max[axis] < kLargest))
            return false;
    return true;
}

Box growBox(const Bounds& bounds) {
    const dvec3 largest = glm::max(glm::abs(bounds.min), glm::abs(bounds.max));
    const double margin = kBoxGrowth * std::max({largest.x, largest.y, largest.z, 1.0e-3});
    return {math::vec3(bounds.min - margin), math::vec3(bounds.max + margin)};
}

/// Rays have individual times: an entity that appears or is hidden during the exposure is hit only
/// at times at which it is visible.
scene::ExposureInterval showEvents(const scene::ExposureInterval& exposure) {
    return exposure.open < exposure.close ? scene::takePart(exposure, exposure.open, exposure.close)
                                          : exposure;
}

class Builder {
  public:
    Builder(
        const scene::World& world,
        const SceneLayout& layout,
        const ViewRequest& request,
        const ExtractedFrame& frame
    )
        : mWorld(world), mLayout(layout), mRequest(request), mFrame(frame),
          mCamera(world.registry.get<scene::Camera>(request.camera)),
          mMotion(world, request.camera, showEvents(request.exposure)) {
        mOrigin = dvec3(viewAt(request.exposure.rasterTime)[3]);
    }

    core::Result<TimedTables> run() {
        describeView();
        addLens();
        for (size_t row = 0; row < mFrame.entities.size(); ++row)
            mTables.rows.push_back(computeRow(row));
        SHUTTER_TRY(addHiddenEntities());
        addLights();
        SHUTTER_TRY(checkShapes());
        collectMoving();
        return std::move(mTables);
    }

  private:
    dmat4 viewAt(double s) const { return mMotion.worldFromCamera(s); }

    /// How much wider the camera sees at s than at the raster instant, across the view.
    double lensScaleAt(double s) const {
        return std::tan(mMotion.cameraYFov(s) / 2.0) /
               std::tan(mMotion.cameraYFov(mRequest.exposure.rasterTime) / 2.0);
    }

    /// Camera-relative space seen through the raster instant's lens: what that lens has at the
    /// picture's border is at the border at s.
    dmat4 relWorldFromViewAt(double s) const {
        dmat4 eye = toEye(viewAt(s));
        if (!mMotion.mayCameraZoom())
            return eye;
        const double scale = lensScaleAt(s);
        eye[0] *= scale;
        eye[1] *= scale;
        return eye;
    }

    /// Least lensScaleAt, of 17 instants.
    double findNarrowestLens() const {
        double narrowest = 1.0;
        for (uint32_t i = 0; mMotion.mayCameraZoom() && i <= kPathIntervals; ++i)
            narrowest = std::min(narrowest, lensScaleAt(double(i) / kPathIntervals));
        return narrowest;
    }

    dmat4 toEye(dmat4 world) const {
        world[3] -= math::dvec4(mOrigin, 0.0);
        return world;
    }

    dmat4 objectAt(ecs::Entity entity, double s) const {
        return toEye(mMotion.worldFromObject(entity, s));
    }

    void describeView() {
        const bool perspective = mCamera.kind == scene::CameraKind::Perspective;
        const double raster = mRequest.exposure.rasterTime;
        const math::dvec2 half = computeHalfExtents(mCamera, mMotion.cameraYFov(raster), mRequest);
        mTables.view = {
            float(half.x), float(half.y), float(mCamera.near), perspective ? 1.0f : 0.0f};
        const double pixel = 2.0 * std::abs(half.y) * findNarrowestLens() / mRequest.height;
        mTolerance.near = perspective ? mCamera.near : 0.0;
        (perspective ? mTolerance.pixelAtOne : mTolerance.pixelAnywhere) = pixel;

        const auto relWorldFromView = [&](double s) { return relWorldFromViewAt(s); };
        auto keys = computeCameraKeys(relWorldFromView, half, mTolerance);
        if (keys)
            mTables.camera = std::move(*keys);
        else // a camera without a finite pose for a while uses that of the raster instant
            mTables.camera.keys = {makeKey(toEye(viewAt(mRequest.exposure.rasterTime)))};
        for (uint32_t i = 0; i <= kPathIntervals; ++i)
            mTolerance.cameraPath.push_back(
                dvec3(interpolateKeys(mTables.camera.keys, double(i) / kPathIntervals)[3])
            );
    }

    void addLens() {
        if (!mRequest.usesLens)
            return;
        const ecs::Registry& registry = mWorld.registry;
        const bool changes = registry.has<scene::FocusMotion>(mRequest.camera) ||
                             registry.has<scene::AutoFocus>(mRequest.camera) ||
                             mMotion.mayCameraZoom();
        const uint32_t last = changes ? kLensIntervals : 0;
        for (uint32_t i = 0; i <= last; ++i) {
            const double s = changes ? double(i) / last : mRequest.exposure.rasterTime;
            const scene::CameraLens lens = mMotion.cameraLens(s);
            mTables.lens.push_back(
                {float(scene::computeLensRadius(lens, mMotion.cameraYFov(s))),
                 float(1.0 / lens.focusDistance)}
            );
            const shader::Aperture aperture = scene::describeAperture(lens);
            mTables.aperture = {
                float(aperture.blades), aperture.rotation, aperture.roundness, aperture.squeeze};
        }
    }

    MotionKeys computeRow(size_t row) {
        if (mNextDeformed < mFrame.deformed.size() && mFrame.deformed[mNextDeformed].row == row)
            return computeDeformedRow(mFrame.deformed[mNextDeformed++]);
        const ecs::Entity entity = mFrame.entityHandles[row];
        const Bounds& bounds = mLayout.bounds[mFrame.entityMeshes[row]];
        if (mMotion.mayObjectMove(entity))
            if (auto keys = computeKeys(entity, bounds))
                return std::move(*keys);
        return holdStill(row, bounds);
    }

    MotionKeys holdStill(size_t row, const Bounds& bounds) const {
        MotionKeys still;
        const auto& matrix = mFrame.entities[row].relWorldFromObject;
        still.keys = {{{matrix[0], matrix[1], matrix[2]}}};
        still.swept = math::transformBounds(expandKey(still.keys[0]), bounds);
        return still;
    }

    MotionKeys computeDeformedRow(const DeformedEntity& drawn) {
        const ecs::Entity entity = mFrame.entityHandles[drawn.row];
        auto deformed = computeDeformedKeys(entity, drawn.mesh);
        if (!deformed) {
            addShape(drawn.row, drawn.mesh, {{drawn.raster}, drawn.bounds, true});
            return holdStill(drawn.row, drawn.bounds);
        }
        const Bounds bounds = deformed->shape.swept;
        addShape(drawn.row, drawn.mesh, std::move(deformed->shape));
        return mMotion.mayObjectMove(entity) ? std::move(deformed->object)
                                             : holdStill(drawn.row, bounds);
    }

    std::optional<DeformedMotion> computeDeformedKeys(ecs::Entity entity, uint32_t mesh) const {
        DeformationAt deformAt = [&, entity](double s) { return mMotion.deformationAt(entity, s); };
        if (!mMotion.mayDeform(entity)) {
            const auto still = mMotion.deformationAt(entity, mMotion.exposure().rasterTime);
            deformAt = [still](double) { return still; };
        }
        return computeDeformedMotion(
            [&](double s) { return objectAt(entity, s); },
            deformAt,
            mLayout.reaches.at(mesh),
            mTolerance
        );
    }

    void addShape(uint32_t row, uint32_t mesh, DeformationKeys shape) {
        const bool mirrored = isMirrored(shape.keys.front(), mLayout.reaches.at(mesh));
        mTables.shapes.push_back({row, mesh, std::move(shape.keys), shape.swept, mirrored});
    }

    /// Nothing where it is nowhere to be met, or the same at all times.
    std::optional<MotionKeys> computeHiddenRow(ecs::Entity entity, uint32_t row, uint32_t mesh) {
        const bool deformable = scene::isDeformable(mWorld, entity);
        if (!mMotion.mayObjectMove(entity) && !(deformable && mMotion.mayDeform(entity)))
            return std::nullopt;
        if (!deformable) {
            auto keys = computeKeys(entity, mLayout.bounds[mesh]);
            return keys && keys->keys.size() > 1 ? std::move(keys) : std::nullopt;
        }
        auto deformed = computeDeformedKeys(entity, mesh);
        if (!deformed || (deformed->object.keys.size() == 1 && deformed->shape.keys.size() == 1))
            return std::nullopt;
        addShape(row, mesh, std::move(deformed->shape));
        return std::move(deformed->object);
    }

    std::optional<MotionKeys> computeKeys(ecs::Entity entity, const Bounds& bounds) const {
        return computeMotionKeys([&](double s) { return objectAt(entity, s); }, bounds, mTolerance);
    }

    core::Status addHiddenEntities() {
        const std::vector<ecs::Entity>& drawn = mFrame.entityHandles;
        size_t next = 0; // rows are in the order of the registry's view
        for (auto [entity, instance] : mWorld.registry.view<scene::MeshInstance>()) {
            if (next < drawn.size() && drawn[next] == entity) {
                ++next;
                continue;
            }
            if (mMotion.isHidden(entity))
                continue;
            const Bounds& bounds = mLayout.bounds[instance.mesh];
            const uint32_t firstGeometry = mLayout.firstGeometry[instance.mesh];
            if (bounds.isEmpty() || firstGeometry == mLayout.firstGeometry[instance.mesh + 1])
                continue;
            const auto index = static_cast<uint32_t>(mTables.rows.size());
            auto keys = computeHiddenRow(entity, index, instance.mesh);
            if (!keys)
                continue;
            if (index >= mRequest.entityLimit)
                return describeFullTable(mRequest.entityLimit);
            shader::EntityRow row{};
            row.firstGeometry = firstGeometry;
            row.handedness = 1.0f;
            row.motion = shader::kNoMotion;
            mTables.extra.push_back({row, instance.mesh});
            mTables.rows.push_back(std::move(*keys));
        }
        return {};
    }

    shader::LightRow lightAt(size_t index, double s) const {
        const ecs::Entity entity = mFrame.lightEntities[index];
        const dmat4 world = mMotion.worldFromLight(entity, s);
        if (math::isFinite(world))
            return makeLight(mWorld.registry.get<scene::Light>(entity), world, mOrigin);
        shader::LightRow dark = mFrame.lights[index];
        dark.radiance = math::vec4(0.0f);
        return dark;
    }

    /// Counts the intervals needed for linear interpolation of the light to stay within the
    /// tolerance.
    uint32_t countLightIntervals(size_t index) const {
        if (!mMotion.mayMove(mFrame.lightEntities[index]))
            return 0;
        const auto far = [](const math::vec4& a, const math::vec4& b) {
            return double(glm::length(math::vec3(a - b)));
        };
        const shader::LightRow open = lightAt(index, 0.0);
        double way = 0.0;
        double turn = 0.0;
        for (uint32_t i = 1; i <= kPathIntervals; ++i) {
            const shader::LightRow row = lightAt(index, double(i) / kPathIntervals);
            way = std::max(way, far(row.positionRange, open.positionRange));
            turn = std::max(turn, far(row.direction, open.direction));
        }
        if (way == 0.0 && turn == 0.0)
            return 0;
        uint32_t intervals = kPathIntervals;
        for (; intervals < kMaxLightIntervals; intervals *= 2) {
            bool follows = true;
            for (uint32_t i = 0; i < intervals && follows; ++i) {
                const shader::LightRow a = lightAt(index, double(i) / intervals);
                const shader::LightRow b = lightAt(index, (i + 1.0) / intervals);
                const shader::LightRow m = lightAt(index, (i + 0.5) / intervals);
                follows = far(m.positionRange, (a.positionRange + b.positionRange) * 0.5f) <=
                              kLightTolerance * way &&
                          far(m.direction, (a.direction + b.direction) * 0.5f) <= kLightTolerance;
            }
            if (follows)
                break;
        }
        return intervals;
    }

    void addLights() {
        uint32_t intervals = 0;
        for (size_t i = 0; i < mFrame.lights.size(); ++i)
            intervals = std::max(intervals, countLightIntervals(i));
        mTables.lightKeyCount = intervals + 1;
        if (intervals == 0) {
            mTables.lights = mFrame.lights;
            return;
        }
        for (uint32_t key = 0; key <= intervals; ++key)
            for (size_t i = 0; i < mFrame.lights.size(); ++i)
                mTables.lights.push_back(lightAt(i, double(key) / intervals));
    }

    core::Status checkShapes() const {
        uint64_t bytes = 0;
        size_t mostKeys = 0;
        for (const TimedDeformation& shape : mTables.shapes) {
            mostKeys = std::max(mostKeys, shape.keys.size());
            for (uint32_t geometry = mLayout.firstGeometry[shape.mesh];
                 geometry < mLayout.firstGeometry[shape.mesh + 1];
                 ++geometry) {
                const SceneLayout::GeometryInfo& info = mLayout.geometries[geometry];
                bytes += shape.keys.size() * info.vertexCount * sizeof(shader::Vertex);
                bytes += (shape.keys.size() - 1) * (info.indexCount / 3) * kBytesPerBox;
            }
        }
        if (bytes > kMaxDeformedBytes)
            return core::makeError(
                "rays that each have their own time need {} MiB for {} with up to {} each, more "
                "than the {} MiB there may be: shorten the exposure",
                bytes >> 20,
                core::countOf(
                    mTables.shapes.size(),
                    "skinned or morphed entity",
                    "skinned or morphed entities"
                ),
                core::countOf(mostKeys, "shape"),
                kMaxDeformedBytes >> 20
            );
        return {};
    }

    bool hasTriangles(uint32_t row) const {
        const uint32_t mesh = mTables.findRow(mFrame, row).mesh;
        const auto begin = mLayout.geometries.begin();
        return std::any_of(
            begin + mLayout.firstGeometry[mesh],
            begin + mLayout.firstGeometry[mesh + 1],
            [](const SceneLayout::GeometryInfo& info) { return info.indexCount > 0; }
        );
    }

    void collectMoving() {
        std::vector<uint32_t> rows;
        std::vector<Box> boxes;
        std::vector<bool> deforms(mTables.rows.size(), false);
        for (const TimedDeformation& shape : mTables.shapes)
            deforms[shape.row] = shape.changes();
        for (uint32_t row = 0; row < mTables.rows.size(); ++row) {
            const MotionKeys& keys = mTables.rows[row];
            if ((keys.keys.size() == 1 && !deforms[row]) || !isFiniteBox(keys.swept) ||
                !hasTriangles(row))
                continue;
            rows.push_back(row);
            boxes.push_back(growBox(keys.swept));
        }
        for (const uint32_t index : computeSpatialOrder(boxes)) {
            mTables.moving.push_back(rows[index]);
            mTables.boxes.push_back(boxes[index]);
        }
    }

    const scene::World& mWorld;
    const SceneLayout& mLayout;
    const ViewRequest& mRequest;
    const ExtractedFrame& mFrame;
    const scene::Camera& mCamera;
    scene::ExposureMotion mMotion;
    dvec3 mOrigin{0.0};
    KeyTolerance mTolerance;
    TimedTables mTables;
    size_t mNextDeformed = 0; ///< of ExtractedFrame::deformed
};

} // namespace

core::Result<TimedTables> computeTimedTables(
    const scene::World& world,
    const SceneLayout& layout,
    const ViewRequest& request,
    const ExtractedFrame& frame
) {
    return Builder(world, layout, request, frame).run();
}

} // namespace shutter::extract
