// SPDX-License-Identifier: MIT
#include "game/blur/picture_frame.h"

#include "shaders/motion_blur/prepare.glsl"
#include "shaders/render/scene_shared.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <map>
#include <optional>
#include <span>
#include <utility>

namespace shutter::blur {

namespace {

using core::makeError;
using motion_blur::HostConvention;
using motion_blur::Method;
using replay::DumpFrame;
using replay::Texels;

template <class Texel>
void addImage(DumpFrame& frame, const char* name, Texels texels, std::span<const Texel> values) {
    replay::DumpImage& image = frame.images[name];
    image.file = name;
    image.texels = texels;
    image.width = frame.width;
    image.height = frame.height;
    image.area = {{0, 0}, {frame.width, frame.height}};
    image.bytes.resize(values.size_bytes());
    std::memcpy(image.bytes.data(), values.data(), values.size_bytes());
}

void giveCameras(
    HostConvention& convention, const PictureCamera& now, const PictureCamera& before
) {
    convention.cameras.areGiven = true;
    convention.cameras.viewFromWorld = now.viewFromWorld;
    convention.cameras.clipFromView = now.clipFromView;
    convention.cameras.viewFromWorldBefore = before.viewFromWorld;
    convention.cameras.clipFromViewBefore = before.clipFromView;
}

/// The cameras of the exposure, and the one on either side of it.
core::Result<std::vector<motion_blur::HostCameraKey>>
findKeys(const Cameras& cameras, const PictureShutter& shutter, int number) {
    if (cameras.list.size() == 1)
        return std::vector<motion_blur::HostCameraKey>{
            {shutter.rasterTime, cameras.list[0].viewFromWorld, cameras.list[0].clipFromView}};
    const auto timeOf = [&](const PictureCamera& one) {
        return shutter.rasterTime + (one.frame - number) / shutter.exposureShare;
    };
    std::vector<motion_blur::HostCameraKey> keys;
    const std::vector<PictureCamera>& list = cameras.list;
    for (size_t i = 0; i < list.size(); ++i) {
        const bool isBefore = i + 1 < list.size() && timeOf(list[i + 1]) <= 0.0;
        const bool isAfter = i > 0 && timeOf(list[i - 1]) >= 1.0;
        if (!isBefore && !isAfter)
            keys.push_back(
                {&list[i] == cameras.find(number) ? shutter.rasterTime : timeOf(list[i]),
                 list[i].viewFromWorld,
                 list[i].clipFromView}
            );
    }
    constexpr double kTolerance = 1.0e-6;
    const bool beginsLate = keys.front().time > kTolerance;
    if (beginsLate || keys.back().time < 1.0 - kTolerance) {
        const double open = number - shutter.rasterTime * shutter.exposureShare;
        return makeError(
            "the camera of frame {} is missing, which the exposure of frame {} needs",
            int(beginsLate ? std::floor(open + kTolerance)
                           : std::ceil(open + shutter.exposureShare - kTolerance)),
            number
        );
    }
    return keys;
}

/// Motion of static surfaces between two frames by the cameras alone.
class CameraMotion {
  public:
    CameraMotion(const DumpFrame& frame, const Cameras& cameras) {
        const PictureCamera* now = cameras.find(double(frame.frameNumber));
        // What pictures hold of two motions, as readPasses() weighs them.
        const std::array<std::pair<int, double>, 2> others{
            {{-1, frame.rasterTime}, {1, 1.0 - frame.rasterTime}}};
        for (const auto& [offset, share] : others)
            if (const auto* other = cameras.find(double(frame.frameNumber) + offset);
                other && now) {
                HostConvention convention = frame.convention;
                giveCameras(convention, *now, *other);
                mOthers.push_back(
                    {motion_blur::makePrepareTable(convention, {frame.width, frame.height}),
                     -float(offset),
                     float(share)}
                );
            }
        // One of them serves for both.
        if (mOthers.size() == 1)
            mOthers.front().share = 1.0f;
    }

    /// Nothing: the cameras do not tell.
    [[nodiscard]] std::optional<glm::vec2> find(glm::vec2 place, float depth) const {
        if (mOthers.empty())
            return std::nullopt;
        glm::vec2 motion(0.0f);
        for (const Other& other : mOthers)
            motion +=
                shader::motionOfCamera(other.table, place, depth) * (other.sign * other.share);
        return motion;
    }

  private:
    struct Other {
        shader::PrepareTable table;
        float sign;
        float share;
    };

    std::vector<Other> mOthers; ///< frames next to this one
};

/// Which pixels move otherwise than the camera makes them.
std::vector<bool> findMoving(const DumpFrame& frame, const Passes& passes, const Cameras& cameras) {
    constexpr float kLeastPx = 0.25f;            ///< over the exposure
    constexpr float kLeastShare = 1.0f / 128.0f; ///< of a vector, which half floats round
    const CameraMotion camera(frame, cameras);
    const float share = frame.convention.scales.exposureShare;
    std::vector<bool> moves(passes.motion.size());
    for (size_t i = 0; i < moves.size(); ++i) {
        const glm::vec2 place(float(i % passes.width) + 0.5f, float(i / passes.width) + 0.5f);
        const auto still = camera.find(place, passes.depth[i]);
        const glm::vec2 motion = passes.motion[i];
        moves[i] = !still || glm::length(motion - *still) * share >
                                 kLeastPx + kLeastShare * glm::length(motion) * share;
    }
    return moves;
}

/// Gives what moves by itself rows of movers that follow motion vectors. Without ids there is one
/// row for all of it, and one for the rest.
void giveEntities(DumpFrame& frame, const Passes& passes, const Cameras& cameras) {
    const std::vector<bool> moves = findMoving(frame, passes, cameras);

    struct Entity {
        size_t pixels = 0;
        size_t moving = 0;
        uint32_t row = 0;
    };

    std::map<uint32_t, Entity> entities;
    const bool hasIds = !passes.entityId.empty();
    std::vector<uint32_t> ids(moves.size(), shader::kNoEntity);
    for (size_t i = 0; i < ids.size(); ++i) {
        if (passes.depth[i] >= shader::kSkyDepth)
            continue;
        ids[i] = hasIds ? passes.entityId[i] : uint32_t(moves[i]);
        Entity& entity = entities[ids[i]];
        ++entity.pixels;
        entity.moving += moves[i];
    }
    entities.erase(shader::kNoEntity);
    frame.hasMotion = true;
    for (auto& [id, entity] : entities) {
        entity.row = uint32_t(frame.rowIds.size());
        frame.rowIds.push_back(id);
        // Edges of pictures mix vectors.
        if (20 * entity.moving > entity.pixels) {
            frame.moverRows.push_back(entity.row);
            frame.moverMatrices.emplace_back();
        }
    }
    if (frame.rowIds.empty())
        frame.rowIds.push_back(0);
    frame.motion.rowCount = uint32_t(frame.rowIds.size());
    for (uint32_t& id : ids)
        if (id != shader::kNoEntity)
            id = entities.at(id).row;
    addImage<uint32_t>(frame, "entityId", Texels::Uint1, ids);
}

} // namespace

core::Status checkMethod(const Method* method, const char* name, bool hasCameras) {
    std::vector<std::string_view> usable;
    for (const Method* one : motion_blur::listMethods())
        if (one->readsRaster && one->rays == motion_blur::RayNeed::None)
            usable.push_back(one->name);
    if (!method || !method->readsRaster || method->rays == motion_blur::RayNeed::Query)
        return makeError(
            "--method {} draws from the scene, which pictures do not hold; these do without: {}",
            name,
            fmt::join(usable, ", ")
        );
    if (method->rays == motion_blur::RayNeed::Any)
        return makeError(
            "--method {} needs what lies behind moving surfaces, which rays find in the scene and "
            "pictures do not hold; these do without: {}",
            name,
            fmt::join(usable, ", ")
        );
    if (!method->readsImagesOnly() && !hasCameras)
        return makeError("--method {} needs --camera, the cameras of the pictures", name);
    return {};
}

core::Result<DumpFrame> makeFrame(
    const Passes& passes,
    const Cameras* cameras,
    const PictureShutter& shutter,
    const motion_blur::MotionBlurSettings& settings,
    int number,
    bool followsLast
) {
    DumpFrame frame;
    frame.name = fmt::format("frame {}", number);
    frame.width = passes.width;
    frame.height = passes.height;
    frame.settings = settings;
    frame.rasterTime = shutter.rasterTime;
    frame.frameNumber = number;
    frame.noEntity = shader::kNoEntity;
    frame.hasConvention = true;
    frame.convention.depth.isLinear = true;
    frame.convention.depth.skyValue = shader::kSkyDepth;
    frame.convention.scales.exposureShare = float(shutter.exposureShare);
    addImage<glm::vec4>(frame, "color", Texels::Float4, passes.color);
    addImage<glm::vec2>(frame, "vectors", Texels::Float2, passes.motion);
    addImage<float>(frame, "depth", Texels::Float1, passes.depth);
    if (!cameras)
        return frame;
    frame.convention.cameras.aheadIsPlusZ = cameras->aheadIsPlusZ;
    const PictureCamera* now = cameras->find(number);
    if (!now)
        return makeError(
            "the camera of frame {} is missing; --frames, 0 by default, is the pictures' frame",
            number
        );
    const PictureCamera* before = cameras->find(number - 1.0);
    if (before)
        giveCameras(frame.convention, *now, *before);
    else if (settings.method->readsCamera)
        return makeError(
            "the camera of frame {} is missing, which {} needs for frame {}",
            number - 1,
            settings.method->name,
            number
        );
    if (!settings.method->readsInstantMotions)
        return frame;
    auto keys = findKeys(*cameras, shutter, number);
    if (!keys)
        return keys.error();
    frame.keys = std::move(keys).value();
    frame.motion.aheadIsPlusZ = cameras->aheadIsPlusZ;
    frame.motion.followsLast = followsLast;
    giveEntities(frame, passes, *cameras);
    return frame;
}

void showAlpha(DumpFrame& frame, const Passes& passes) {
    std::vector<glm::vec4> alpha;
    alpha.reserve(passes.color.size());
    for (const glm::vec4& pixel : passes.color)
        alpha.emplace_back(pixel.a);
    addImage<glm::vec4>(frame, "color", Texels::Float4, alpha);
}

} // namespace shutter::blur
