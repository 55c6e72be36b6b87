// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_convention.h"

#include "engine/math/layer_tables.h"
#include "engine/math/transform.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "shaders/render/scene_shared.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <optional>
#include <string_view>

namespace shutter::motion_blur {

namespace {

using core::makeError;
using math::dmat4;

constexpr float kMaxScale = 16.0f;

constexpr std::array kVectorFormats{
    VK_FORMAT_R16G16_SFLOAT,
    VK_FORMAT_R32G32_SFLOAT,
    VK_FORMAT_R16G16B16A16_SFLOAT,
    VK_FORMAT_R32G32B32A32_SFLOAT};
constexpr std::array kDepthFormats{
    VK_FORMAT_D32_SFLOAT,
    VK_FORMAT_D16_UNORM,
    VK_FORMAT_X8_D24_UNORM_PACK32,
    VK_FORMAT_D24_UNORM_S8_UINT,
    VK_FORMAT_D32_SFLOAT_S8_UINT,
    VK_FORMAT_D16_UNORM_S8_UINT,
    VK_FORMAT_R32_SFLOAT,
    VK_FORMAT_R16_SFLOAT,
    VK_FORMAT_R32G32_SFLOAT,
    VK_FORMAT_R32G32B32A32_SFLOAT};
constexpr std::array kShareFormats{VK_FORMAT_R8_UNORM, VK_FORMAT_R16_SFLOAT, VK_FORMAT_R32_SFLOAT};

core::Status checkScale(std::string_view name, float value, float least) {
    if (value >= least && value <= kMaxScale)
        return {};
    return makeError("motion blur: {} is {}, it must be {} to {}", name, value, least, kMaxScale);
}

struct CameraPair {
    HostCamera now;
    HostCamera before;
};

std::optional<CameraPair> normalize(const HostCameras& cameras) {
    const auto now = motion_blur::normalize(
        HostCameraKey{0.0, cameras.viewFromWorld, cameras.clipFromView}, cameras.aheadIsPlusZ
    );
    const auto before = motion_blur::normalize(
        HostCameraKey{0.0, cameras.viewFromWorldBefore, cameras.clipFromViewBefore},
        cameras.aheadIsPlusZ
    );
    if (!now || !before)
        return std::nullopt;
    return CameraPair{*now, *before};
}

core::Status checkView(std::string_view name, const dmat4& viewFromWorld) {
    if (!math::isFinite(viewFromWorld))
        return makeError("motion blur: cameras.{} is not finite", name);
    if (!isAffine(viewFromWorld))
        return makeError("motion blur: cameras.{} is not affine", name);
    if (!math::isFinite(glm::inverse(viewFromWorld)))
        return makeError("motion blur: cameras.{} is singular", name);
    return {};
}

/// \param name of the field
core::Status checkProjection(
    std::string_view name, const dmat4& clipFromView, bool aheadIsPlusZ, VkExtent2D picture
) {
    if (!math::isFinite(clipFromView))
        return makeError("motion blur: {} is not finite", name);
    const HostCameraKey key{0.0, dmat4(1.0), clipFromView};
    const auto camera = motion_blur::normalize(key, aheadIsPlusZ);
    if (!camera && motion_blur::normalize(key, !aheadIsPlusZ))
        return makeError(
            "motion blur: {} faces {}Z, cameras.aheadIsPlusZ "
            "means {}Z",
            name,
            aheadIsPlusZ ? "-" : "+",
            aheadIsPlusZ ? "+" : "-"
        );
    if (!camera)
        return makeError("motion blur: {} is neither perspective nor orthographic", name);
    const dmat4 place = camera->pictureFromWorld({picture.width, picture.height});
    if (!math::isFinite(glm::inverse(place)))
        return makeError("motion blur: {} is singular", name);
    return {};
}

core::Status checkViewModel(const HostConvention& convention, VkExtent2D picture) {
    const HostViewModel& model = convention.viewModel;
    if (!std::isfinite(model.depthMin) || !std::isfinite(model.depthMax) ||
        model.depthMin > model.depthMax)
        return makeError(
            "motion blur: viewModel.depthMin is {} and depthMax {}, they must be finite and rise",
            model.depthMin,
            model.depthMax
        );
    if (!model.isGiven() || !model.hasProjection())
        return {};
    if (convention.depth.isLinear)
        return makeError("motion blur: viewModel.clipFromView is given, but depthIsLinear is true");
    const bool isAhead = convention.cameras.aheadIsPlusZ;
    SHUTTER_TRY(checkProjection("viewModel.clipFromView", model.clipFromView, isAhead, picture));
    const auto normalizeProjection = [&](const dmat4& clipFromView) {
        return motion_blur::normalize(HostCameraKey{0.0, dmat4(1.0), clipFromView}, isAhead);
    };
    const auto own = normalizeProjection(model.clipFromView);
    const auto cameras = normalizeProjection(convention.cameras.clipFromView);
    if (own && cameras && own->isPerspective != cameras->isPerspective)
        return makeError(
            "motion blur: viewModel.clipFromView is {}, cameras.clipFromView is not",
            own->isPerspective ? "perspective" : "orthographic"
        );
    return {};
}

/// Names the field that requires cameras.
const char* findNeedForCameras(const HostConvention& convention) {
    if (!convention.depth.isLinear)
        return "depthIsLinear is false";
    if (!convention.vectors.image.image)
        return "vectors.image is null";
    if (convention.vectors.lackCamera)
        return "vectorsLackCamera is true";
    if (convention.scales.camera != convention.scales.object)
        return "cameraScale is not objectScale";
    return nullptr;
}

/// (x + y value) / (z + w value) of a raw depth buffer.
glm::vec4 depthFromRaw(const HostCamera& camera) {
    // Clip z is a - b * metres, and its divisor is the metres (perspective) or 1.
    const auto a = float(camera.clipFromView[3].z);
    const auto b = float(camera.clipFromView[2].z);
    return camera.isPerspective ? glm::vec4(a, 0.0f, b, 1.0f) : glm::vec4(a, -1.0f, b, 0.0f);
}

} // namespace

const HostImageRule kVectorsRule{
    .name = "vectors", .formats = kVectorFormats, .hasPictureSize = false};
const HostImageRule kDepthRule{
    .name = "depth", .formats = kDepthFormats, .hasPictureSize = false, .isDepth = true};
const HostImageRule kBlurScaleRule{
    .name = "blurScale", .formats = kShareFormats, .hasPictureSize = false};

core::Status checkHostCameras(const HostCameras& cameras, VkExtent2D picture) {
    if (!std::isfinite(cameras.jitterPx.x) || !std::isfinite(cameras.jitterPx.y) ||
        !std::isfinite(cameras.jitterPxBefore.x) || !std::isfinite(cameras.jitterPxBefore.y))
        return makeError("motion blur: cameras.jitterPx is not finite");
    if (!(cameras.cutDistance >= 0.0))
        return makeError(
            "motion blur: cutDistance is {}, it must be 0 or more", cameras.cutDistance
        );
    if (!(cameras.cutDegrees >= 0.0))
        return makeError("motion blur: cutDegrees is {}, it must be 0 or more", cameras.cutDegrees);
    if (!cameras.areGiven)
        return {};
    SHUTTER_TRY(checkView("viewFromWorld", cameras.viewFromWorld));
    SHUTTER_TRY(checkView("viewFromWorldBefore", cameras.viewFromWorldBefore));
    SHUTTER_TRY(
        checkProjection("cameras.clipFromView", cameras.clipFromView, cameras.aheadIsPlusZ, picture)
    );
    SHUTTER_TRY(checkProjection(
        "cameras.clipFromViewBefore", cameras.clipFromViewBefore, cameras.aheadIsPlusZ, picture
    ));
    const auto pair = normalize(cameras);
    if (pair && pair->now.isPerspective != pair->before.isPerspective)
        return makeError(
            "motion blur: cameras.clipFromViewBefore is {}, clipFromView is not",
            pair->before.isPerspective ? "perspective" : "orthographic"
        );
    return {};
}

core::Status checkScales(const HostScales& scales, VkExtent2D picture) {
    SHUTTER_TRY(checkScale("exposureShare", scales.exposureShare, 0.0f));
    SHUTTER_TRY(checkScale("cameraScale", scales.camera, 0.0f));
    SHUTTER_TRY(checkScale("objectScale", scales.object, 0.0f));
    SHUTTER_TRY(checkScale("displayedPerRendered", scales.displayedPerRendered, 1.0f));
    if (scales.perPixel.image)
        SHUTTER_TRY(checkImage(scales.perPixel, kBlurScaleRule, picture));
    return {};
}

HostCameras countedCameras(const HostConvention& convention) {
    HostCameras cameras = convention.cameras;
    if (convention.scales.isCut) {
        cameras.viewFromWorldBefore = cameras.viewFromWorld;
        cameras.clipFromViewBefore = cameras.clipFromView;
        cameras.jitterPxBefore = cameras.jitterPx;
    }
    return cameras;
}

core::Status checkConvention(const HostConvention& convention, VkExtent2D picture) {
    const HostVectors& vectors = convention.vectors;
    const HostDepth& depth = convention.depth;
    if (vectors.image.image)
        SHUTTER_TRY(checkImage(vectors.image, kVectorsRule, picture));
    SHUTTER_TRY(checkImage(depth.image, kDepthRule, picture));
    for (const float scale : {vectors.pixelsPerUnit.x, vectors.pixelsPerUnit.y})
        if (!std::isfinite(scale) || scale == 0.0f)
            return makeError(
                "motion blur: pixelsPerUnit holds {}, it must be finite and not "
                "0",
                scale
            );
    if (depth.isLinear && !(depth.metresPerUnit > 0.0f && std::isfinite(depth.metresPerUnit)))
        return makeError(
            "motion blur: metresPerUnit is {}, it must be finite and above 0", depth.metresPerUnit
        );
    SHUTTER_TRY(checkHostCameras(countedCameras(convention), picture));
    SHUTTER_TRY(checkScales(convention.scales, picture));
    SHUTTER_TRY(checkViewModel(convention, picture));
    const char* need = findNeedForCameras(convention);
    if (need && !convention.cameras.areGiven)
        return makeError(
            "motion blur: {}, which needs cameras, and their areGiven is "
            "false",
            need
        );
    return {};
}

bool isJump(const HostCameras& cameras) {
    if (!cameras.areGiven)
        return false;
    const dmat4 now = glm::inverse(cameras.viewFromWorld);
    const dmat4 before = glm::inverse(cameras.viewFromWorldBefore);
    if (cameras.cutDistance > 0.0 &&
        glm::distance(glm::dvec3(now[3]), glm::dvec3(before[3])) > cameras.cutDistance)
        return true;
    if (!(cameras.cutDegrees > 0.0))
        return false;
    const double least = std::cos(glm::radians(std::min(cameras.cutDegrees, 180.0)));
    for (const int axis : {1, 2}) { // up, and the direction of view
        const glm::dvec3 a(now[axis]);
        const glm::dvec3 b(before[axis]);
        if (glm::dot(a, b) < least * glm::length(a) * glm::length(b))
            return true;
    }
    return false;
}

HostConvention describeMotionDepth(const HostImage& motionDepth, const HostConvention& given) {
    HostConvention convention;
    convention.vectors.image = motionDepth;
    convention.depth = {.image = motionDepth, .isLinear = true, .skyValue = shader::kSkyDepth};
    convention.cameras = given.cameras;
    convention.scales.isCut = given.scales.isCut;
    return convention;
}

shader::PrepareArea makeArea(const HostImage& image, VkExtent2D picture) {
    const VkRect2D area = areaOf(image, picture);
    const VkExtent2D extent = extentOf(image, picture);
    const glm::vec2 whole(extent.width, extent.height);
    shader::PrepareArea result{};
    result.origin = glm::vec2(area.offset.x, area.offset.y) / whole;
    result.perPixel = glm::vec2(area.extent.width, area.extent.height) /
                      (glm::vec2(picture.width, picture.height) * whole);
    return result;
}

shader::PrepareTable makePrepareTable(const HostConvention& convention, VkExtent2D picture) {
    const HostCameras cameras = countedCameras(convention);
    const HostScales& scales = convention.scales;
    shader::PrepareTable table{};
    table.depth = makeArea(convention.depth.image, picture);
    if (scales.perPixel.image) {
        table.flags |= shader::kPrepareHasBlurScale;
        table.blurScale = makeArea(scales.perPixel, picture);
    }
    if (convention.vectors.image.image) {
        table.flags |= shader::kPrepareHasVectors;
        table.vectors = makeArea(convention.vectors.image, picture);
        if (!convention.vectors.lackCamera)
            table.flags |= shader::kPrepareVectorsHaveCamera;
        if (convention.vectors.haveJitter)
            table.jitterPx = glm::vec2(cameras.jitterPxBefore - cameras.jitterPx);
    }
    if (convention.depth.isLinear)
        table.flags |= shader::kPrepareSkyBeyond;
    table.skyValue = convention.depth.skyValue;
    table.depthFromValue = glm::vec4(0.0f, convention.depth.metresPerUnit, 1.0f, 0.0f);
    table.pixelsPerUnit = convention.vectors.pixelsPerUnit;
    const float share = scales.isCut ? 0.0f : scales.exposureShare / scales.displayedPerRendered;
    table.cameraScale = share * scales.camera;
    table.objectScale = share * scales.object;
    const HostViewModel& model = convention.viewModel;
    if (model.isGiven()) {
        table.flags |= shader::kPrepareHasViewModel;
        table.viewModelRange = {model.depthMin, model.depthMax};
        table.viewModelFromValue = table.depthFromValue;
    }
    if (!cameras.areGiven)
        return table;
    const auto pair = normalize(cameras);
    table.flags |= shader::kPrepareHasCameras;
    if (pair->now.isPerspective)
        table.flags |= shader::kPreparePerspective;
    if (!convention.depth.isLinear)
        table.depthFromValue = table.viewModelFromValue = depthFromRaw(pair->now);
    if (model.hasProjection() && !convention.depth.isLinear)
        table.viewModelFromValue = depthFromRaw(*motion_blur::normalize(
            HostCameraKey{0.0, dmat4(1.0), model.clipFromView}, cameras.aheadIsPlusZ
        ));
    // Both with this frame's jitter: places are those of its pixels, and it leaves their
    // differences.
    const auto pictureFromWorld = [&](const HostCamera& camera) {
        const math::uvec2 sizePx(picture.width, picture.height);
        return math::pictureFromView(camera.clipFromView, sizePx, cameras.jitterPx) *
               camera.viewFromWorld;
    };
    const dmat4 beforeFromNow =
        pictureFromWorld(pair->before) * glm::inverse(pictureFromWorld(pair->now));
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 4; ++column)
            table.beforeFromNow[row][column] = float(beforeFromNow[column][row]);
    return table;
}

} // namespace shutter::motion_blur
