// SPDX-License-Identifier: MIT
#include "modules/glass/blended_layer.h"

#include "engine/extract/frame_view.h"
#include "engine/extract/raster_record.h"
#include "engine/extract/swept_scene.h"
#include "engine/math/lens_pairs.h"
#include "engine/math/sampling.h"
#include "modules/glass/decals.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>

namespace shutter::glass {

namespace {

using math::dmat4;
using math::dvec2;
using math::dvec4;

constexpr double kFar = std::numeric_limits<double>::infinity();

/// Shorter motion counts as none.
constexpr double kStillWayPx = 0.5;

/// A row with blended surfaces.
struct Blended {
    uint32_t row = 0;
    extract::SweptBox box;
    bool isInLayer = false;
    bool isDecal = false; ///< moves as its background does: nothing else needs to be drawn with it
};

std::vector<Blended> listBlended(const extract::SweptScene& scene) {
    std::vector<Blended> rows;
    const auto add = [&](uint32_t row, bool moves) {
        const extract::SweptBox box = scene.sweep(row);
        if (scene.isInPicture(box))
            rows.push_back({row, box, moves, false});
    };
    for (const uint32_t row : scene.frame.movingRows)
        if (scene.hasGeometry(row, true))
            add(row, scene.moves(row));
    std::vector<uint32_t> still;
    for (const extract::DrawItem& item : scene.frame.blended.still)
        still.push_back(item.entity);
    std::sort(still.begin(), still.end());
    still.erase(std::unique(still.begin(), still.end()), still.end());
    for (const uint32_t row : still)
        add(row, false);
    return rows;
}

/// Adds rows that overlap rows already added, until no more do.
void closeOver(std::vector<Blended>& rows) {
    std::vector<size_t> reached;
    for (size_t i = 0; i < rows.size(); ++i)
        if (rows[i].isInLayer)
            reached.push_back(i);
    while (!reached.empty()) {
        const extract::SweptBox box = rows[reached.back()].box;
        reached.pop_back();
        for (size_t i = 0; i < rows.size(); ++i)
            if (!rows[i].isInLayer && extract::overlap(rows[i].box, box) &&
                !(rows[i].isDecal && rows[i].box.nearest > box.farthest)) {
                rows[i].isInLayer = true;
                reached.push_back(i);
            }
    }
}

/// Clip space of an instant's camera from its picture space, the depth apart: only the near plane
/// clips.
dmat4 clipFromPicture(const extract::ViewRequest& view, bool isPerspective, double nearest) {
    const double width = view.width;
    const double height = view.height;
    dmat4 rows(0.0);
    rows[3] = isPerspective ? dvec4(0.0, 0.0, 1.0, 0.0) : dvec4(0.0, 0.0, 0.0, 1.0);
    rows[0] = dvec4(2.0 / width, 0.0, 0.0, 0.0) - rows[3];
    rows[1] = dvec4(0.0, 2.0 / height, 0.0, 0.0) - rows[3];
    // z exceeds w before the near plane alone. Perspective: z = near, w is the depth. Orthographic:
    // z is 1 at the near plane and falls by 1e-6 per metre.
    rows[2] = isPerspective ? dvec4(0.0, 0.0, 0.0, nearest)
                            : dvec4(0.0, 0.0, -1.0e-6, 1.0 + 1.0e-6 * nearest);
    return glm::transpose(rows);
}

/// Builds the layer of one frame.
class LayerPlanner {
  public:
    LayerPlanner(const extract::SweptSource& source, const render::OverlayLimits& limits)
        : mScene(source), mLimits(limits) {}

    BlendedLayer run(std::span<const uint32_t> taken) {
        for (const uint32_t row : taken) {
            const extract::SweptBox box = mScene.sweep(row);
            if (mScene.isInPicture(box))
                mRows.push_back({row, box, true, false});
        }
        if (mRows.empty())
            return {};
        placeRectangle();
        findDifferences();
        mLayer.readsInstants = mLimits.findsInstants && (mIsHidden || mIsCorrelated);
        uint32_t count = countInstants();
        if (mLayer.readsInstants)
            count = fitLayer(count);
        mLayer.partCount = mLayer.readsInstants ? std::min(count, shader::kMaxSurfaceParts) : 1;
        addInstants(count);
        addItems();
        return std::move(mLayer);
    }

  private:
    void placeRectangle() {
        const dvec2 size(mScene.view.width, mScene.view.height);
        dvec2 least = size;
        dvec2 most(0.0);
        for (const Blended& one : mRows) {
            least = glm::min(least, glm::max(one.box.least, dvec2(0.0)));
            most = glm::max(most, glm::min(one.box.most, size));
            mLayer.longestWayPx = std::max(mLayer.longestWayPx, one.box.wayPx);
        }
        mLayer.originPx = math::uvec2(glm::floor(least));
        mLayer.sizePx = math::uvec2(glm::ceil(most)) - mLayer.originPx;
    }

    /// How the instants differ, apart from where the layer is.
    void findDifferences() {
        // Movers seen through static glass are blurred as if the glass were not there.
        const auto behind = mScene.sweepOpaqueMovers();
        const auto before = mScene.hasParallax() ? mScene.sweepOpaque() : behind;
        for (const Blended& one : mRows) {
            const bool moves = one.box.wayPx > kStillWayPx;
            const auto touches = [&](const extract::SweptBox& box) {
                return extract::overlap(box, one.box);
            };
            const auto mayHide = [&](const extract::SweptBox& box) {
                return touches(box) && box.nearest < one.box.farthest;
            };
            mIsHidden =
                mIsHidden || !before || std::any_of(before->begin(), before->end(), mayHide);
            mIsCorrelated =
                mIsCorrelated || (moves && (mScene.cameraMoves || !behind ||
                                            std::any_of(behind->begin(), behind->end(), touches)));
        }
    }

    uint32_t countInstants() const {
        // Copies lie side by side in the disc of a lens, not in a line.
        const bool isSpread = mLimits.hasLens && mLayer.longestWayPx > kStillWayPx;
        if (isSpread || (mLayer.readsInstants && mIsHidden))
            return mLimits.instants;
        const uint32_t least = mLayer.readsInstants ? shader::kMaxSurfaceParts : 1;
        const double wanted = std::ceil(mLayer.longestWayPx / kLayerStepPx);
        return std::min(
            std::max(
                static_cast<uint32_t>(std::min(wanted, 1.0e6)),
                std::max(least, mLimits.leastInstants)
            ),
            mLimits.instants
        );
    }

    /// As many as fit into memory; 0 without room for one.
    uint32_t fitLayer(uint32_t count) {
        shader::InstantSurfaces wanted = mLayer.surfaces();
        wanted.instantCount = count;
        wanted.partCount = shader::kMaxSurfaceParts;
        if (const uint32_t fitting = render::fitInstants(wanted, mLimits.surfaceBytes))
            return fitting;
        mLayer.readsInstants = false;
        return countInstants();
    }

    void addInstants(uint32_t count) {
        const extract::ViewRequest& view = mScene.view;
        const auto& camera = mScene.world.registry.get<scene::Camera>(view.camera);
        const dmat4 clip = clipFromPicture(view, mScene.isPerspective, camera.near);
        const double raster = view.exposure.rasterTime;
        mEye = math::dvec3(mScene.motion.worldFromCamera(raster)[3]);
        dmat4 worldFromRelWorld(1.0);
        worldFromRelWorld[3] = dvec4(mEye, 1.0);
        const dmat4 rasterPicture =
            extract::pictureFromWorldAt(mScene.world, view, mScene.motion, raster);
        mTimes = scene::middlesOfLight(view.exposure, count);
        for (uint32_t i = 0; i < count; ++i) {
            const double s = mTimes[i];
            extract::ViewRequest jittered = view;
            if (mLimits.hasLens && count > 1)
                jittered.lensPlace = placeInLens(i, count);
            if (mLimits.leastInstants > 1)
                jittered.jitterPx += math::halton23(i + 1) - 0.5;
            const dmat4 picture =
                extract::pictureFromWorldAt(mScene.world, jittered, mScene.motion, s);
            const dmat4 test = glm::transpose(
                (mLayer.readsInstants ? picture : rasterPicture) * worldFromRelWorld
            );
            shader::LayerInstant& one = mLayer.instants.emplace_back();
            for (int row = 0; row < 3; ++row)
                one.testFromRelWorld[row] = math::vec4(test[row]);
            one.time = float(s);
            one.weight = 1.0f / float(count);
            mClips.push_back(clip * picture);
        }
    }

    /// The place in the lens at an instant. It is that of the sample that supplies the instant's
    /// depth in the set of samples that all pixels share.
    math::dvec2 placeInLens(uint32_t instant, uint32_t count) const {
        const uint32_t all = mLayer.readsInstants ? mLimits.instants : count;
        const uint32_t taken = shader::takenInstant(instant, count, all);
        return math::spreadLensPairs(all, mScene.view.lensTurn.value_or(0))
            .at(size_t{taken} * shader::kLensSets + shader::kMiddleLensSet)
            .place;
    }

    void addItems() {
        for (const Blended& one : mRows) {
            const auto firstPlace = static_cast<uint32_t>(mLayer.places.size());
            addPlaces(one.row);
            const uint32_t mesh = mScene.frame.entityMeshes[one.row];
            const extract::SceneLayout& layout = mScene.layout;
            const uint32_t first = layout.firstGeometry[mesh];
            for (uint32_t i = first; i < layout.firstGeometry[mesh + 1]; ++i)
                if (layout.geometries[i].alphaMode == scene::AlphaMode::Blend)
                    mLayer.items.push_back({describeDraw(one.row, i, first), firstPlace});
        }
        // Behind one another as in the raster, which draws the farthest first.
        std::sort(
            mLayer.items.begin(),
            mLayer.items.end(),
            [&](const LayerItem& a, const LayerItem& b) {
                return mScene.frame.blended.isBefore(b.draw, a.draw);
            }
        );
    }

    void addPlaces(uint32_t row) {
        const ecs::Entity entity = mScene.frame.entityHandles[row];
        const bool isStatic = !mScene.motion.mayObjectMove(entity);
        for (size_t i = 0; i < mTimes.size(); ++i) {
            const dmat4 world = isStatic ? mScene.frame.worldFromObject[row]
                                         : mScene.motion.worldFromObject(entity, mTimes[i]);
            shader::LayerPlace& place = mLayer.places.emplace_back();
            place.clipFromObject = math::mat4(mClips[i] * world);
            dmat4 eye = world;
            eye[3] -= dvec4(mEye, 0.0);
            for (int axis = 0; axis < 3; ++axis)
                place.relWorldFromObject[axis] =
                    math::vec4(eye[0][axis], eye[1][axis], eye[2][axis], eye[3][axis]);
        }
    }

    extract::DrawItem describeDraw(uint32_t row, uint32_t geometry, uint32_t firstOfMesh) const {
        const extract::ExtractedFrame& frame = mScene.frame;
        const extract::SceneLayout::GeometryInfo& info = mScene.layout.geometries[geometry];
        const math::Bounds& bounds = extract::findRowBounds(frame, mScene.layout, row);
        const math::dvec3 centre(
            frame.worldFromObject[row] * dvec4(math::dvec3(bounds.centre()), 1.0)
        );
        const double distance = glm::length(centre - mEye);
        return {
            row,
            geometry,
            frame.entities[row].firstGeometry + geometry - firstOfMesh,
            info.alphaMode,
            info.doubleSided,
            (frame.entities[row].handedness < 0.0f) != frame.mirrors,
            std::isnan(distance) ? std::numeric_limits<float>::infinity() : float(distance)};
    }

    extract::SweptScene mScene;
    render::OverlayLimits mLimits;
    BlendedLayer mLayer;
    bool mIsHidden = false; ///< opaque surfaces may hide other parts of it at other instants
    /// Both the layer and its background move. Parts of the exposure see through all of a lens
    /// alike.
    bool mIsCorrelated = false;
    std::vector<Blended> mRows;
    std::vector<double> mTimes; ///< of the instants
    std::vector<dmat4> mClips;  ///< clip space from the world at each of them
    math::dvec3 mEye{0.0};      ///< at the raster instant
};

} // namespace

std::vector<uint32_t> findLayerRows(
    const scene::World& world,
    const extract::SceneLayout& layout,
    const extract::ViewRequest& view,
    const scene::ExposureMotion& motion,
    const extract::ExtractedFrame& frame,
    bool hasLens
) {
    if (!layout.hasBlended)
        return {};
    const extract::SweptScene scene({world, layout, view, motion, frame, hasLens});
    std::vector<Blended> rows = listBlended(scene);
    if (rows.empty())
        return {};
    const auto movers = scene.sweepOpaqueMovers();
    DecalSearch decals(scene);
    for (Blended& one : rows) {
        one.isInLayer =
            one.isInLayer || !movers ||
            std::any_of(movers->begin(), movers->end(), [&](const extract::SweptBox& mover) {
                return extract::overlap(mover, one.box);
            });
        if (one.isInLayer || !scene.hasParallax())
            continue;
        one.isDecal = decals.movesWithBackground(one.row);
        one.isInLayer = !one.isDecal;
    }
    closeOver(rows);
    std::vector<uint32_t> result;
    for (const Blended& one : rows)
        if (one.isInLayer)
            result.push_back(one.row);
    std::sort(result.begin(), result.end());
    return result;
}

BlendedLayer planBlendedLayer(
    const scene::World& world,
    const extract::SceneLayout& layout,
    const extract::ViewRequest& view,
    const scene::ExposureMotion& motion,
    const extract::ExtractedFrame& frame,
    std::span<const uint32_t> taken,
    const render::OverlayLimits& limits
) {
    if (taken.empty())
        return {};
    return LayerPlanner({world, layout, view, motion, frame, limits.hasLens}, limits).run(taken);
}

} // namespace shutter::glass
