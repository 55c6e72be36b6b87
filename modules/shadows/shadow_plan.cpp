// SPDX-License-Identifier: MIT
#include "modules/shadows/shadow_plan.h"

#include "engine/core/check.h"
#include "engine/core/words.h"
#include "engine/extract/extracted_frame.h"
#include "engine/extract/frame_view.h"
#include "engine/math/transform.h"
#include "engine/scene/exposure_motion.h"
#include "modules/shadows/shadow_casters.h"
#include "modules/shadows/shadow_movers.h"
#include "modules/shadows/shadow_tiles.h"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

namespace shutter::shadows {

namespace {

using math::dmat4;
using math::dvec3;
using math::dvec4;

/// Share of the scene's extent that a light's near plane is away from it.
constexpr double kNearShare = 1.0e-4;

bool castsShadows(const extract::SceneLayout& layout, uint32_t mesh) {
    for (uint32_t i = layout.firstGeometry[mesh]; i < layout.firstGeometry[mesh + 1]; ++i)
        if (layout.geometries[i].alphaMode != scene::AlphaMode::Blend)
            return true;
    return false;
}

/// Texels of a mover's layer to a pixel of its shadow, and the least that a layer has on a side.
constexpr double kLayerTexelsPerPixel = 1.5;
constexpr uint32_t kMinLayerSize = 16;

/// Plans one frame.
class Planner {
  public:
    Planner(const render::RasterExtract& raster, const ShadowSettings& settings)
        : mWorld(raster.world), mLayout(raster.layout), mView(raster.view), mFrame(raster.frame),
          mFrameView(raster.frameView), mSettings(settings),
          mBlurs(
              settings.mode == ShadowMode::Blurred &&
              (raster.kind != render::RasterKind::Own || !mView.instant) &&
              mView.exposure.close > mView.exposure.open
          ) {}

    ShadowPlan run() {
        mPlan.eye = eye();
        mPlan.shadows = decide();
        mPlan.blur = {false, "no shadow is drawn"};
        if (!mPlan.shadows.run)
            return std::move(mPlan);
        collectMovers();
        followMovers();
        mPlan.lights.assign(
            mFrame.lights.size(), {shader::kNoShadowMap, 0, 0, shader::kNoShadowRun, {}}
        );
        for (const PlacedLight& light : mLights)
            addLightMaps(light);
        mPlan.lightMapCount = static_cast<uint32_t>(mPlan.maps.size());
        for (const PlacedLight& light : mLights)
            addLayers(light);
        const uint32_t instants = mBlurs ? mSettings.instants : 1;
        mMoving = addMovers(mPlan, mMovers, mLights, instants);
        mPlan.instantCount = mMoving == 0 ? 1 : instants;
        markTiles();
        explainBlur();
        return std::move(mPlan);
    }

  private:
    core::Decision decide() {
        if (mSettings.mode == ShadowMode::None)
            return {false, "no shadows are requested"};
        if (mView.unlit)
            return {false, "the picture is unlit"};
        if (mFrame.opaque.empty() && mFrame.blended.empty())
            return {false, "nothing in the picture receives shadows"};
        collectLights();
        if (mLights.empty())
            return {false, "no light casts shadows"};
        size_t casters = 0;
        for (uint32_t row = 0; row < mFrame.entities.size(); ++row) {
            casters += castsShadows(mLayout, mFrame.entityMeshes[row]);
            const math::Bounds box = math::transformBounds(
                mFrame.worldFromObject[row], extract::findRowBounds(mFrame, mLayout, row)
            );
            mScene.add(box);
            // Outside of the box: a box that surrounds the camera gives no bound for the distance.
            const double distance =
                glm::length(glm::max(glm::max(box.min - eye(), eye() - box.max), 0.0));
            if (distance > 0.0)
                mNearest = std::min(mNearest, distance);
        }
        if (casters == 0)
            return {false, "nothing casts shadows"};
        return {
            true,
            fmt::format(
                "{} and {}",
                core::countOf(mLights.size(), "light"),
                core::countOf(casters, "caster")
            )};
    }

    void collectLights() {
        const size_t count = std::min<size_t>(mFrame.lights.size(), shader::kMaxOccludedLights);
        for (uint32_t i = 0; i < count; ++i) {
            const ecs::Entity entity = mFrame.lightEntities[i];
            PlacedLight placed{i, mWorld.registry.get<scene::Light>(entity)};
            const math::vec3 radiance(mFrame.lights[i].radiance);
            if (!(radiance.x > 0.0f || radiance.y > 0.0f || radiance.z > 0.0f))
                continue;
            const dmat4 world =
                mFrameView.motion().worldFromLight(entity, mFrameView.times().raster);
            placed.position = dvec3(world[3]);
            const double size = glm::length(dvec3(world[2]));
            if (size > 0.0)
                placed.direction = -dvec3(world[2]) / size;
            mLights.push_back(placed);
        }
    }

    void collectMovers() {
        std::vector<ShadowCaster> movers;
        const auto cap = std::min<size_t>(kMaxShadowMovers, kMaxShadowLayers / mLights.size());
        size_t next = 0; // of movingRows
        for (uint32_t row = 0; row < mFrame.entities.size(); ++row) {
            const bool moving = next < mFrame.movingRows.size() && mFrame.movingRows[next] == row;
            next += moving;
            if (!castsShadows(mLayout, mFrame.entityMeshes[row]))
                continue;
            if (!moving) {
                mPlan.mapCasters.push_back(row);
                continue;
            }
            movers.push_back(makeShadowCaster(mFrame, mLayout, row, eye()));
        }
        std::stable_sort(
            movers.begin(),
            movers.end(),
            [](const ShadowCaster& a, const ShadowCaster& b) { return a.seenSize > b.seenSize; }
        );
        mPlan.casterRevision = mFrame.staticSet;
        for (const ShadowCaster& mover : movers) {
            if (mMovers.size() < cap && fitsLayers(mover.sphere)) {
                mMovers.push_back({mover, {}, {}});
                continue;
            }
            mPlan.mapCasters.push_back(mover.row);
            mPlan.casterRevision = mFrame.changes.revision; // other maps in each frame
            ++mSharpMovers;
        }
    }

    [[nodiscard]] bool fitsLayers(const Sphere& mover) const {
        return std::all_of(mLights.begin(), mLights.end(), [&](const PlacedLight& light) {
            return light.isDirectional() || fitsPointLayer(light.position, mover);
        });
    }

    /// Finds the poses of movers during the exposure. The largest on screen get parts of it first.
    void followMovers() {
        if (!mBlurs)
            return;
        std::vector<LightPlace> lights;
        for (const PlacedLight& light : mLights)
            lights.push_back(light.place());
        size_t left = kMaxPartLayers / lights.size();
        for (PlannedMover& mover : mMovers) {
            mover.path = followCaster(mover.caster, mFrameView, mFrame, mSettings.instants);
            const uint32_t parts = countParts(mover.caster, mover.path, lights);
            if (parts == 0 || parts > left)
                continue;
            mover.parts = followCaster(mover.caster, mFrameView, mFrame, parts).instants;
            if (!std::all_of(
                    mover.parts.begin(),
                    mover.parts.end(),
                    [&](const CasterInstant& part) { return fitsPart(mover, part); }
                ))
                mover.parts.clear();
            left -= mover.parts.size();
        }
    }

    [[nodiscard]] bool fitsPart(const PlannedMover& mover, const CasterInstant& part) const {
        return std::all_of(mLights.begin(), mLights.end(), [&](const PlacedLight& light) {
            const LightPlace seen = seeLight(part.rasterFromInstant, light.place());
            return seen.w == 0.0 || fitsPointLayer(dvec3(seen), mover.caster.sphere);
        });
    }

    [[nodiscard]] dvec3 eye() const { return mFrameView.matrices().eye; }

    void addMap(const LightView& view, uint32_t sizePx, uint32_t mover, float shapeShift = 0.0f) {
        const auto first = static_cast<uint32_t>(mPlan.texelCount);
        mPlan.maps.push_back({view, sizePx, first, mover, shapeShift});
        mPlan.texelCount += uint64_t{shader::shadowRowTexels(sizePx)} * sizePx;
    }

    void addLightMaps(const PlacedLight& light) {
        const uint32_t size = mSettings.mapSize;
        const double near = kNearShare * std::max(glm::length(mScene.size()), 1.0e-3);
        shader::ShadowLight& row = mPlan.lights[light.index];
        row.firstMap = static_cast<uint32_t>(mPlan.maps.size());
        if (light.isDirectional()) {
            const math::dmat3 axes = glm::transpose(makeLightAxes(-light.direction));
            for (int i = 0; i < 3; ++i)
                row.axes[i] = math::vec4(math::vec3(axes[i]), 0.0f);
            for (const LightView& view :
                 fitCascades(sliceOfCamera(), -light.direction, mScene, findFarthest(), size))
                addMap(view, size, shader::kNoEntity);
        } else if (light.light.kind == scene::LightKind::Spot && light.light.outerConeAngle <= kWidestSpot) {
            addMap(
                fitSpot(light.position, light.direction, light.light.outerConeAngle, near, size),
                size,
                shader::kNoEntity
            );
        } else {
            for (const LightView& view : fitCube(light.position, near, size / 2))
                addMap(view, size / 2, shader::kNoEntity);
        }
        row.mapCount = static_cast<uint32_t>(mPlan.maps.size()) - row.firstMap;
    }

    /// Width of the layers of a mover, texels.
    [[nodiscard]] uint32_t
    findLayerSize(const PlacedLight& light, const PlannedMover& mover) const {
        const uint32_t most = mSettings.mapSize / 4;
        if (!light.isDirectional())
            return most;
        const double wanted = kLayerTexelsPerPixel *
                              findShadowWidth(picture(), mover.caster.sphere, -light.direction);
        if (!(wanted < double(most))) // NaN too
            return most;
        return std::clamp(std::bit_ceil(uint32_t(std::ceil(wanted))), kMinLayerSize, most);
    }

    void addLayers(const PlacedLight& light) {
        mPlan.lights[light.index].firstLayer = static_cast<uint32_t>(mPlan.maps.size());
        for (const PlannedMover& mover : mMovers) {
            const uint32_t size = findLayerSize(light, mover);
            addLayer(light.place(), mover, {}, size);
            for (const CasterInstant& part : mover.parts)
                addLayer(light.place(), mover, part, size);
        }
    }

    /// In the mover's space it is the light that turns.
    void addLayer(
        const LightPlace& light,
        const PlannedMover& mover,
        const CasterInstant& instant,
        uint32_t sizePx
    ) {
        const LightPlace seen = seeLight(instant.rasterFromInstant, light);
        const Sphere& sphere = mover.caster.sphere;
        addMap(
            seen.w == 0.0 ? fitLayer(dvec3(seen), sphere, sizePx)
                          : fitPointLayer(dvec3(seen), sphere, sizePx),
            sizePx,
            mover.caster.row,
            instant.shapeShift
        );
    }

    [[nodiscard]] CameraSlice sliceOfCamera() const {
        const shader::FrameConstants& constants = mFrame.constants;
        CameraSlice slice;
        slice.eye = eye();
        slice.forward = glm::normalize(dvec3(math::vec3(constants.forward)));
        slice.isPerspective = constants.pixelFootprint.x > 0.0f;
        const double pixel =
            slice.isPerspective ? constants.pixelFootprint.x : constants.pixelFootprint.y;
        slice.cornerReach =
            0.5 * pixel * std::hypot(double(constants.sizePx.x), double(constants.sizePx.y));
        // Rounded down, so that moving on moves no cascade for a while.
        slice.near = mWorld.registry.get<scene::Camera>(mView.camera).near;
        if (std::isfinite(mNearest))
            slice.near = std::max(slice.near, std::exp2(std::floor(std::log2(mNearest))));
        return slice;
    }

    /// Distance along the view that nothing is beyond.
    [[nodiscard]] double findFarthest() const {
        const dvec3 forward(math::vec3(mFrame.constants.forward));
        double farthest = 0.0;
        for (int corner = 0; corner < 8; ++corner) {
            const dvec3 point(
                corner & 1 ? mScene.max.x : mScene.min.x,
                corner & 2 ? mScene.max.y : mScene.min.y,
                corner & 4 ? mScene.max.z : mScene.min.z
            );
            farthest = std::max(farthest, glm::dot(point - eye(), forward));
        }
        const double least = 2.0 * mWorld.registry.get<scene::Camera>(mView.camera).near;
        if (mSettings.distance > 0.0)
            farthest = std::min(farthest, mSettings.distance);
        return std::max(farthest, least);
    }

    [[nodiscard]] ShadowPicture picture() const {
        return {
            mFrameView.matrices().clipFromWorldJittered,
            mFrame.constants.sizePx,
            mScene,
            eye(),
            mFrame.constants.pixelFootprint};
    }

    void markTiles() {
        ShadowTiles tiles(mFrame.constants.sizePx);
        for (uint32_t i = 0; i < mMovers.size(); ++i) {
            const PlannedMover& mover = mMovers[i];
            const Sphere& sphere =
                mover.path.instants.empty() ? mover.caster.sphere : mover.path.swept;
            for (const PlacedLight& light : mLights)
                tiles.mark(i, boundShadow(picture(), sphere, light.place()));
        }
        mPlan.tiles = {tiles.across()};
        mPlan.tiles.insert(mPlan.tiles.end(), tiles.movers().begin(), tiles.movers().end());
    }

    void explainBlur() {
        if (mSettings.mode != ShadowMode::Blurred)
            mPlan.blur = {false, "sharp shadows are requested"};
        else if (!mBlurs)
            mPlan.blur = {false, "the picture is of one instant"};
        else if (mMoving == 0)
            mPlan.blur = {false, "no caster moves during the exposure"};
        else
            mPlan.blur = {
                true,
                fmt::format(
                    "{} in motion, {}{}",
                    core::countOf(mMoving, "caster"),
                    core::countOf(mPlan.instantCount, "instant"),
                    mSharpMovers == 0
                        ? std::string()
                        : "; " + core::countOf(mSharpMovers, "more stays sharp", "more stay sharp")
                )};
    }

    const scene::World& mWorld;
    const extract::SceneLayout& mLayout;
    const extract::ViewRequest& mView;
    const extract::ExtractedFrame& mFrame;
    const extract::FrameView& mFrameView;
    const ShadowSettings& mSettings;
    bool mBlurs = false;
    std::vector<PlacedLight> mLights;
    math::Bounds mScene; ///< all rows, world space
    /// Distance of the nearest row's box from the camera, of those that it is not in; metres.
    double mNearest = std::numeric_limits<double>::infinity();
    std::vector<PlannedMover> mMovers;
    uint32_t mMoving = 0;    ///< of mMovers, in the exposure
    size_t mSharpMovers = 0; ///< that have no layers
    ShadowPlan mPlan;
};

} // namespace

ShadowPlan planShadows(const render::RasterExtract& raster, const ShadowSettings& settings) {
    return Planner(raster, settings).run();
}

} // namespace shutter::shadows
