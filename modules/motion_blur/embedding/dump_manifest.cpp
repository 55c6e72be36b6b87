// SPDX-License-Identifier: MIT
#include "modules/motion_blur/embedding/host_blended.h"
#include "modules/motion_blur/embedding/host_dump.h"
#include "modules/motion_blur/embedding/host_input_check.h"
#include "modules/motion_blur/embedding/host_ways.h"
#include "modules/motion_blur/methods.h"

#include <nlohmann/json.hpp>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace shutter::motion_blur {

namespace {

using nlohmann::ordered_json;

ordered_json describeMatrix(const glm::dmat4& matrix) {
    ordered_json numbers = ordered_json::array();
    for (int column = 0; column < 4; ++column)
        for (int row = 0; row < 4; ++row)
            numbers.push_back(matrix[column][row]);
    return numbers;
}

/// Null for what JSON cannot hold.
ordered_json describeNumber(double number) {
    return std::isfinite(number) ? ordered_json(number) : ordered_json();
}

ordered_json describeCameras(const HostCameras& cameras) {
    ordered_json root;
    root["aheadIsPlusZ"] = cameras.aheadIsPlusZ;
    root["viewFromWorld"] = describeMatrix(cameras.viewFromWorld);
    root["clipFromView"] = describeMatrix(cameras.clipFromView);
    root["viewFromWorldBefore"] = describeMatrix(cameras.viewFromWorldBefore);
    root["clipFromViewBefore"] = describeMatrix(cameras.clipFromViewBefore);
    root["jitterPx"] = {cameras.jitterPx.x, cameras.jitterPx.y};
    root["jitterPxBefore"] = {cameras.jitterPxBefore.x, cameras.jitterPxBefore.y};
    return root;
}

ordered_json describeViewModel(const HostViewModel& model) {
    ordered_json matrices = ordered_json::array();
    for (const glm::dmat4& matrix : model.viewFromObject)
        matrices.push_back(describeMatrix(matrix));
    return {
        {"depthMin", model.depthMin},
        {"depthMax", model.depthMax},
        {"clipFromView", describeMatrix(model.clipFromView)},
        {"viewFromObject", std::move(matrices)}};
}

ordered_json describeConvention(const HostConvention& convention) {
    ordered_json root;
    root["pixelsPerUnit"] = {
        convention.vectors.pixelsPerUnit.x, convention.vectors.pixelsPerUnit.y};
    root["haveCamera"] = !convention.vectors.lackCamera;
    root["haveJitter"] = convention.vectors.haveJitter;
    root["depthIsRaw"] = !convention.depth.isLinear;
    root["metresPerUnit"] = convention.depth.metresPerUnit;
    root["skyValue"] = describeNumber(convention.depth.skyValue);
    // Ignored fields may hold any value, so they are omitted.
    root["cameras"] =
        convention.cameras.areGiven ? describeCameras(countedCameras(convention)) : ordered_json();
    root["exposureShare"] = convention.scales.exposureShare;
    root["cameraScale"] = convention.scales.camera;
    root["objectScale"] = convention.scales.object;
    root["displayedPerRendered"] = convention.scales.displayedPerRendered;
    root["isCut"] = convention.scales.isCut;
    if (convention.viewModel.isGiven())
        root["viewModel"] = describeViewModel(convention.viewModel);
    return root;
}

ordered_json describeLens(const HostLens& lens) {
    ordered_json root;
    root["radius"] = lens.radius;
    root["focusDistance"] = describeNumber(lens.focusDistance);
    root["focusDistances"] = ordered_json::array();
    for (const double distance : lens.focusDistances)
        root["focusDistances"].push_back(distance);
    root["bladeRotation"] = lens.bladeRotation;
    root["roundness"] = lens.roundness;
    root["squeeze"] = lens.squeeze;
    root["blades"] = lens.blades;
    return root;
}

ordered_json describeMotion(const HostMotion& motion) {
    ordered_json root;
    root["aheadIsPlusZ"] = motion.aheadIsPlusZ;
    root["rowCount"] = motion.rowCount;
    root["followsLast"] = motion.followsLast;
    ordered_json& keys = root["keys"] = ordered_json::array();
    for (const HostCameraKey& key : motion.keys)
        keys.push_back(
            {{"time", key.time},
             {"viewFromWorld", describeMatrix(key.viewFromWorld)},
             {"clipFromView", describeMatrix(key.clipFromView)}}
        );
    ordered_json& movers = root["movers"] = ordered_json::array();
    for (const HostMover& mover : motion.movers) {
        ordered_json matrices = ordered_json::array();
        for (const glm::dmat4& matrix : mover.worldFromObject)
            matrices.push_back(describeMatrix(matrix));
        movers.push_back({{"row", mover.row}, {"worldFromObject", std::move(matrices)}});
    }
    // 64 bits are more than JSON's numbers hold.
    ordered_json& ids = root["rowIds"] = ordered_json::array();
    for (const uint64_t id : motion.rowIds)
        ids.push_back(std::to_string(id));
    if (!motion.viewModelRows.empty())
        root["viewModelRows"] =
            std::vector(motion.viewModelRows.begin(), motion.viewModelRows.end());
    if (motion.lens.isOpen())
        root["lens"] = describeLens(motion.lens);
    return root;
}

ordered_json describeSettings(const MotionBlurSettings& settings) {
    ordered_json root = ordered_json::object();
    for (const auto& row : listSettingRows())
        root[row.name] = core::describeValue(row, settings);
    return root;
}

/// Describes the host's drawing over the picture.
ordered_json describeDraws(const HostInputs& inputs, const MotionBlurSettings& settings) {
    const shader::InstantSurfaces head = describeDrawn(inputs, settings, nullptr).rectangle;
    return {
        {"area", {head.originPx.x, head.originPx.y, head.sizePx.x, head.sizePx.y}},
        {"instants", head.instantCount},
        {"parts", head.partCount},
        {"opacityInAlpha", inputs.drawn.isOpacityInAlpha}};
}

} // namespace

ordered_json describeInputs(
    const HostInputs& inputs, const MotionBlurSettings& settings, bool isPacked, bool hasResponse
) {
    const Method& method = *settings.method;
    ordered_json root = ordered_json::object();
    root["format"] = "shutter motion blur dump";
    root["version"] = 1;
    root["width"] = inputs.width;
    root["height"] = inputs.height;
    root["method"] = method.name;
    root["settings"] = describeSettings(settings);
    root["rasterTime"] = inputs.rasterTime;
    root["frameNumber"] = inputs.frameNumber;
    root["view"] = inputs.motion.view;
    root["noEntity"] = inputs.noEntity;
    root["inPlace"] = !inputs.output.image;
    HostConvention convention = inputs.convention;
    if (isPacked) {
        convention = describeMotionDepth(inputs.motionDepth, inputs.convention);
        if (method.readsCamera)
            convention.scales = inputs.convention.scales;
        // They determine the time of the previous frame's raster.
        convention.scales.exposureShare = inputs.convention.scales.exposureShare;
        convention.scales.displayedPerRendered = inputs.convention.scales.displayedPerRendered;
    }
    const bool hasConvention =
        !isPacked || convention.cameras.areGiven || inputs.lastDeformedMotion.image;
    root["convention"] = hasConvention ? describeConvention(convention) : ordered_json();
    std::vector<HostMover> movers;
    root["motion"] =
        method.readsInstantMotions ? describeMotion(countedMotion(inputs, movers)) : ordered_json();
    const bool hasReveal = method.rays == RayNeed::Any;
    root["reveal"] = !hasReveal ? "none" : inputs.reveal.record ? "own" : "tables";
    root["drawn"] = inputs.drawn.record ? describeDraws(inputs, settings) : ordered_json();
    root["response"] = hasResponse ? "file" : inputs.response == 0 ? "box" : "address";
    return root;
}

} // namespace shutter::motion_blur
