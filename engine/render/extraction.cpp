// SPDX-License-Identifier: MIT
#include "engine/render/extraction.h"

#include "engine/core/check.h"
#include "engine/math/projection.h"
#include "engine/render/poses.h"
#include "engine/scene/exposure_motion.h"

#include <algorithm>
#include <array>
#include <cmath>

namespace shutter::render {

namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

/// The camera at one instant.
struct CameraPose {
    dmat4 clipFromWorld{1.0};
    dvec3 position{0.0};
    dvec3 forward{0.0, 0.0, -1.0};
    dmat4 viewFromWorld{1.0};
};

dmat4 makeProjection(const scene::Camera& camera, double aspect) {
    if (camera.kind == scene::CameraKind::Perspective)
        return math::clipFromViewPerspective(camera.yFov, aspect, camera.near);
    return math::clipFromViewOrthographic(
        camera.yMag * aspect, camera.yMag, camera.near, camera.far
    );
}

CameraPose poseCamera(const scene::ExposureMotion& motion, const dmat4& clipFromView, double s) {
    const dmat4 worldFromView = computeWorldFromView(motion.worldFromCamera(s));
    CameraPose pose;
    pose.viewFromWorld = glm::inverse(worldFromView);
    pose.clipFromWorld = clipFromView * pose.viewFromWorld;
    pose.position = dvec3(worldFromView[3]);
    pose.forward = -glm::normalize(dvec3(worldFromView[2]));
    return pose;
}

struct Poses {
    CameraPose open, raster, close;
};

ShapeTimes findPoseTimes(const ViewRequest& request) {
    if (request.instant)
        return {*request.instant, *request.instant, *request.instant};
    return {0.0, request.exposure.rasterShare, 1.0};
}

/// True when the box lies wholly beyond one of the side planes or behind the near plane.
bool isOutside(const dmat4& clipFromObject, const math::Bounds& bounds) {
    std::array<int, 5> outside{};
    for (int corner = 0; corner < 8; ++corner) {
        const dvec3 point(
            corner & 1 ? bounds.max.x : bounds.min.x,
            corner & 2 ? bounds.max.y : bounds.min.y,
            corner & 4 ? bounds.max.z : bounds.min.z
        );
        const dvec4 clip = clipFromObject * dvec4(point, 1.0);
        outside[0] += clip.x < -clip.w;
        outside[1] += clip.x > clip.w;
        outside[2] += clip.y < -clip.w;
        outside[3] += clip.y > clip.w;
        outside[4] += clip.z > clip.w; // reversed depth: nearer than the near plane
    }
    return std::any_of(outside.begin(), outside.end(), [](int count) { return count == 8; });
}

class Extractor {
  public:
    Extractor(const scene::World& world, const SceneLayout& layout, const ViewRequest& request)
        : mWorld(world), mLayout(layout), mRequest(request),
          mCamera(world.registry.get<scene::Camera>(request.camera)),
          mMotion(world, request.camera, request.exposure), mTimes(findPoseTimes(request)),
          mNextDeformedGeometry(static_cast<uint32_t>(layout.geometries.size())),
          mClipFromView(makeProjection(mCamera, double(request.width) / request.height)) {
        mPoses.open = poseCamera(mMotion, mClipFromView, mTimes.open);
        mPoses.raster = poseCamera(mMotion, mClipFromView, mTimes.raster);
        mPoses.close = poseCamera(mMotion, mClipFromView, mTimes.close);
    }

    core::Result<ExtractedFrame> run() {
        fillConstants();
        for (auto [entity, instance] : mWorld.registry.view<scene::MeshInstance>()) {
            if (scene::isHidden(mWorld, entity))
                continue;
            addEntity(entity, instance.mesh);
            if (mFrame.entities.size() > mRequest.entityLimit)
                return describeFullTable(mRequest.entityLimit);
        }
        for (auto [entity, light] : mWorld.registry.view<scene::Light>())
            if (!scene::isHidden(mWorld, entity))
                addLight(entity, light);
        mFrame.constants.lightCount = static_cast<uint32_t>(mFrame.lights.size());
        std::stable_sort(
            mFrame.opaque.begin(),
            mFrame.opaque.end(),
            [](const DrawItem& a, const DrawItem& b) { return a.distance < b.distance; }
        );
        std::stable_sort(
            mFrame.blended.begin(),
            mFrame.blended.end(),
            [](const DrawItem& a, const DrawItem& b) { return a.distance > b.distance; }
        );
        return std::move(mFrame);
    }

  private:
    /// Clip space moved by a part of a pixel, for sampling inside it.
    dmat4 jitterClip() const {
        const math::dvec2 shift =
            -2.0 * mRequest.jitterPx / math::dvec2(double(mRequest.width), double(mRequest.height));
        return glm::translate(dmat4(1.0), dvec3(shift, 0.0));
    }

    void fillConstants() {
        shader::FrameConstants& constants = mFrame.constants;
        const dmat4 worldFromEye = glm::translate(dmat4(1.0), mPoses.raster.position);
        const dmat4 clipFromEye = jitterClip() * mPoses.raster.clipFromWorld * worldFromEye;
        constants.clipFromEye = math::mat4(clipFromEye);
        constants.eyeFromClip = math::mat4(glm::inverse(clipFromEye));
        constants.clipFromDirectionOpen = math::mat4(directionMatrix(mPoses.open));
        constants.clipFromDirectionClose = math::mat4(directionMatrix(mPoses.close));
        const bool perspective = mCamera.kind == scene::CameraKind::Perspective;
        // Clip w is the distance for a perspective camera and 1 for an orthographic one.
        const double minW = perspective ? mCamera.near : 0.5;
        constants.forward = math::vec4(math::vec3(mPoses.raster.forward), float(minW));
        constants.background = math::vec4(mRequest.background, 1.0f);
        constants.ambient = math::vec4(mRequest.ambient, 1.0f);
        constants.sizePx = {float(mRequest.width), float(mRequest.height)};
        const double height = double(mRequest.height);
        constants.pixelFootprint =
            perspective ? math::vec2(float(2.0 * std::tan(mCamera.yFov / 2.0) / height), 0.0f)
                        : math::vec2(0.0f, float(2.0 * mCamera.yMag / height));
        constants.lodBias = mRequest.lodBias;
        constants.flags = mRequest.unlit ? shader::kFrameUnlit : 0u;
        // A motion that ends where it began is one too: the raster instant tells.
        const math::mat4 direction(directionMatrix(mPoses.raster));
        mFrame.moves = constants.clipFromDirectionOpen != direction ||
                       constants.clipFromDirectionClose != direction ||
                       mPoses.open.position != mPoses.raster.position ||
                       mPoses.close.position != mPoses.raster.position;
    }

    dmat4 directionMatrix(const CameraPose& pose) const {
        return mClipFromView * dmat4(math::dmat3(pose.viewFromWorld));
    }

    /// A light that is nowhere lights nothing; its NaN would blacken the picture.
    void addLight(ecs::Entity entity, const scene::Light& light) {
        const dmat4 world = mMotion.worldFromEntity(entity, mTimes.raster);
        if (!math::isFinite(world))
            return;
        mFrame.lights.push_back(makeLight(light, world, mPoses.raster.position));
        mFrame.lightEntities.push_back(entity);
    }

    void addEntity(ecs::Entity entity, uint32_t mesh) {
        const uint32_t firstGeometry = mLayout.firstGeometry[mesh];
        const uint32_t endGeometry = mLayout.firstGeometry[mesh + 1];
        if (mLayout.bounds[mesh].isEmpty() || firstGeometry == endGeometry)
            return;
        const dmat4 open = mMotion.worldFromObject(entity, mTimes.open);
        const dmat4 raster = mMotion.worldFromObject(entity, mTimes.raster);
        const dmat4 close = mMotion.worldFromObject(entity, mTimes.close);
        if (!isDrawable(raster) || !math::isFinite(open) || !math::isFinite(close))
            return;
        std::optional<DeformedEntity> shape;
        if (scene::isDeformable(mWorld, entity)) {
            shape = poseEntity(mMotion, entity, mLayout.reaches.at(mesh), mTimes);
            if (!shape)
                return;
        }
        const math::Bounds& bounds = shape ? shape->bounds : mLayout.bounds[mesh];

        const dmat4 clipRaster = jitterClip() * mPoses.raster.clipFromWorld * raster;
        shader::EntityRow row{};
        row.clipFromObjectOpen = math::mat4(mPoses.open.clipFromWorld * open);
        row.clipFromObjectRaster = math::mat4(clipRaster);
        row.clipFromObjectClose = math::mat4(mPoses.close.clipFromWorld * close);
        const dmat4 eye = glm::translate(dmat4(1.0), -mPoses.raster.position) * raster;
        for (int i = 0; i < 3; ++i)
            row.eyeFromObject[i] = math::vec4(eye[0][i], eye[1][i], eye[2][i], eye[3][i]);
        row.firstGeometry = shape ? mNextDeformedGeometry : firstGeometry;
        const bool mirrored =
            (glm::determinant(math::dmat3(raster)) < 0.0) != (shape && shape->mirrored);
        row.handedness = mirrored ? -1.0f : 1.0f;

        const auto index = static_cast<uint32_t>(mFrame.entities.size());
        mFrame.entities.push_back(row);
        mFrame.entityMeshes.push_back(mesh);
        mFrame.entityHandles.push_back(entity);
        const bool changes = shape && shape->changes;
        if (!isOutside(clipRaster, bounds)) {
            const math::mat4 unjittered(mPoses.raster.clipFromWorld * raster);
            mFrame.moves = mFrame.moves || changes || row.clipFromObjectOpen != unjittered ||
                           row.clipFromObjectClose != unjittered;
            const dvec3 centre(eye * dvec4(bounds.centre(), 1.0));
            addDraws(index, mesh, mirrored, float(glm::length(centre)));
        }
        if (!shape)
            return;
        shape->row = index;
        shape->mesh = mesh;
        mFrame.deformed.push_back(std::move(*shape));
        mNextDeformedGeometry += endGeometry - firstGeometry;
    }

    void addDraws(uint32_t row, uint32_t mesh, bool mirrored, float distance) {
        const uint32_t first = mLayout.firstGeometry[mesh];
        for (uint32_t geometry = first; geometry < mLayout.firstGeometry[mesh + 1]; ++geometry) {
            const SceneLayout::GeometryInfo& info = mLayout.geometries[geometry];
            const bool blended = info.alphaMode == scene::AlphaMode::Blend;
            (blended ? mFrame.blended : mFrame.opaque)
                .push_back(
                    {row,
                     geometry,
                     mFrame.entities[row].firstGeometry + geometry - first,
                     info.alphaMode,
                     info.doubleSided,
                     mirrored,
                     distance}
                );
        }
    }

    const scene::World& mWorld;
    const SceneLayout& mLayout;
    const ViewRequest& mRequest;
    const scene::Camera& mCamera;
    scene::ExposureMotion mMotion;
    ShapeTimes mTimes;
    uint32_t mNextDeformedGeometry; ///< row of the frame's geometry table
    dmat4 mClipFromView;
    Poses mPoses;
    ExtractedFrame mFrame;
};

} // namespace

core::Error describeFullTable(uint32_t limit) {
    return {fmt::format(
        "the scene draws more than {} entities, the most the entity table holds", limit
    )};
}

core::Result<ExtractedFrame>
extractFrame(const scene::World& world, const SceneLayout& layout, const ViewRequest& request) {
    SHUTTER_CHECK(request.width > 0 && request.height > 0, "an empty picture");
    return Extractor(world, layout, request).run();
}

} // namespace shutter::render
