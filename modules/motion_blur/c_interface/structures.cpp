// SPDX-License-Identifier: MIT
#include "modules/motion_blur/c_interface/structures.h"

#include "engine/core/setting_row.h"
#include "modules/motion_blur/presets.h"

#include <string>
#include <string_view>

namespace shutter::motion_blur {

namespace {

using core::makeError;

std::string describeVersion(uint32_t version) {
    return fmt::format("{}.{}.{}", version >> 22, version >> 12 & 0x3FF, version & 0xFFF);
}

graph::OutsideUse convert(const ShutterBlurUse& given) {
    graph::OutsideUse use;
    use.layout = given.layout;
    if (given.stages == 0)
        return use; // any command
    use.stages = given.stages;
    use.access = given.access;
    return use;
}

HostImage convert(const ShutterBlurImage& given) {
    HostImage image;
    image.image = given.image;
    image.before = convert(given.before);
    image.after = convert(given.after);
    image.format = given.format;
    image.extent = given.extent;
    image.area = given.area;
    image.usage = given.usage;
    image.layer = given.layer;
    image.samples = given.samples;
    return image;
}

glm::dmat4 convertMatrix(const double* columns) {
    glm::dmat4 matrix;
    std::memcpy(&matrix[0].x, columns, sizeof(matrix));
    return matrix;
}

HostCameras convert(const ShutterBlurCameras& given) {
    HostCameras cameras;
    cameras.areGiven = given.areGiven != VK_FALSE;
    cameras.aheadIsPlusZ = given.aheadIsPlusZ != VK_FALSE;
    cameras.viewFromWorld = convertMatrix(given.viewFromWorld);
    cameras.clipFromView = convertMatrix(given.clipFromView);
    cameras.viewFromWorldBefore = convertMatrix(given.viewFromWorldBefore);
    cameras.clipFromViewBefore = convertMatrix(given.clipFromViewBefore);
    cameras.jitterPx = {given.jitterPx[0], given.jitterPx[1]};
    cameras.jitterPxBefore = {given.jitterPxBefore[0], given.jitterPxBefore[1]};
    return cameras;
}

HostConvention convertConvention(const ShutterBlurInputs& given) {
    HostConvention convention;
    convention.vectors.image = convert(given.vectors);
    convention.vectors.pixelsPerUnit = {given.pixelsPerUnit[0], given.pixelsPerUnit[1]};
    convention.vectors.lackCamera = given.vectorsLackCamera != VK_FALSE;
    convention.vectors.haveJitter = given.vectorsHaveJitter != VK_FALSE;
    convention.depth.image = convert(given.depth);
    convention.depth.isLinear = given.depthIsLinear != VK_FALSE;
    convention.depth.metresPerUnit = given.metresPerUnit;
    convention.depth.skyValue = given.skyValue;
    convention.cameras = convert(given.cameras);
    convention.cameras.cutDistance = given.cutDistance;
    convention.cameras.cutDegrees = given.cutDegrees;
    convention.scales.exposureShare = given.exposureShare;
    convention.scales.camera = given.cameraScale;
    convention.scales.object = given.objectScale;
    convention.scales.displayedPerRendered = given.displayedPerRendered;
    convention.scales.perPixel = convert(given.blurScale);
    convention.scales.isCut = given.isCut != VK_FALSE;
    convention.viewModel.depthMin = given.viewModel.depthMin;
    convention.viewModel.depthMax = given.viewModel.depthMax;
    convention.viewModel.clipFromView = convertMatrix(given.viewModel.clipFromView);
    return convention;
}

core::Status checkArray(const char* name, const void* array, const char* count, uint32_t length) {
    if (length > 0 && !array)
        return makeError("motion blur: {} is null, {} is {}", name, count, length);
    return {};
}

core::Status checkArrays(const ShutterBlurInputs& given) {
    SHUTTER_TRY(checkArray("keys", given.keys, "keyCount", given.keyCount));
    SHUTTER_TRY(checkArray("movers", given.movers, "moverCount", given.moverCount));
    SHUTTER_TRY(checkArray(
        "viewModelRows", given.viewModelRows, "viewModelRowCount", given.viewModelRowCount
    ));
    return checkArray(
        "responsePoints", given.responsePoints, "responsePointCount", given.responsePointCount
    );
}

/// Number of matrices of each mover: one per key, or without keys those of two frames.
uint32_t countMatrices(const ShutterBlurInputs& given) {
    return given.keyCount > 0 ? given.keyCount : 2;
}

HostLens convertLens(const ShutterBlurInputs& given) {
    HostLens lens;
    lens.radius = given.lens.radius;
    lens.focusDistance = given.lens.focusDistance;
    if (given.lens.focusDistances)
        lens.focusDistances = {given.lens.focusDistances, countMatrices(given)};
    lens.bladeRotation = given.lens.bladeRotation;
    lens.roundness = given.lens.roundness;
    lens.squeeze = given.lens.squeeze;
    lens.blades = given.lens.blades;
    return lens;
}

/// Copies matrices, one per key.
std::span<const glm::dmat4> convertViewModel(const ShutterBlurInputs& given, InputArrays& arrays) {
    arrays.viewFromObject.clear();
    if (const double* matrices = given.viewModel.viewFromObject)
        for (uint32_t key = 0; key < countMatrices(given); ++key)
            arrays.viewFromObject.push_back(convertMatrix(matrices + 16 * size_t{key}));
    return arrays.viewFromObject;
}

HostMotion convertMotion(const ShutterBlurInputs& given, InputArrays& arrays) {
    arrays.keys.clear();
    for (uint32_t i = 0; i < given.keyCount; ++i) {
        const ShutterBlurCameraKey& key = given.keys[i];
        arrays.keys.push_back(
            {key.time, convertMatrix(key.viewFromWorld), convertMatrix(key.clipFromView)}
        );
    }
    arrays.matrices.clear();
    for (uint32_t i = 0; i < given.moverCount; ++i)
        if (const double* matrices = given.movers[i].worldFromObject)
            for (uint32_t key = 0; key < countMatrices(given); ++key)
                arrays.matrices.push_back(convertMatrix(matrices + 16 * size_t{key}));
    arrays.movers.clear();
    size_t first = 0; // the matrices have their places from here on
    for (uint32_t i = 0; i < given.moverCount; ++i) {
        HostMover mover{given.movers[i].row, {}};
        if (given.movers[i].worldFromObject) {
            mover.worldFromObject = {arrays.matrices.data() + first, countMatrices(given)};
            first += countMatrices(given);
        }
        arrays.movers.push_back(mover);
    }
    HostMotion motion;
    motion.keys = arrays.keys;
    motion.aheadIsPlusZ = given.cameras.aheadIsPlusZ != VK_FALSE;
    motion.rowCount = given.rowCount;
    motion.movers = arrays.movers;
    if (given.rowIds)
        motion.rowIds = {given.rowIds, given.rowCount};
    if (given.viewModelRows)
        motion.viewModelRows = {given.viewModelRows, given.viewModelRowCount};
    motion.view = given.view;
    motion.followsLast = given.followsLast != VK_FALSE;
    motion.lens = convertLens(given);
    return motion;
}

template <class Task>
void setAnswer(
    HostAnswer<Task>& answer,
    void (*record)(void* user, const Task* task),
    void* user,
    VkBool32 byRayPipeline
) {
    answer.byRayPipeline = byRayPipeline != VK_FALSE;
    if (record)
        answer.record = [record, user](const Task& task) { record(user, &task); };
}

HostBlended convertDrawn(const ShutterBlurInputs& given) {
    HostBlended drawn;
    if (given.recordBlended)
        drawn.record = [record = given.recordBlended,
                        user = given.blendedUser](const BlendedTask& task) { record(user, &task); };
    drawn.area = given.blendedArea;
    drawn.instantCount = given.blendedInstants;
    drawn.partCount = given.blendedParts;
    drawn.isOpacityInAlpha = given.blendedOpacityInAlpha != VK_FALSE;
    return drawn;
}

core::Result<const Method*> findHostMethod(const char* name) {
    if (!name)
        return nullptr; // the default
    const Method* method = findMethod(name);
    if (method && isForHosts(*method))
        return method;
    std::string names;
    for (const Method* one : listMethods())
        if (isForHosts(*one))
            names += (names.empty() ? "" : ", ") + std::string(one->name);
    return makeError("motion blur: settings.method is '{}', it must be one of {}", name, names);
}

core::Status apply(const ShutterBlurValue& given, MotionBlurSettings& settings) {
    if (!given.name || !given.value)
        return makeError("motion blur: a name or value of settings.values is null");
    const auto* row = core::findRow(listSettingRows(), given.name);
    if (!row)
        return makeError("motion blur: settings.values has no '{}'", given.name);
    if (const core::Status parsed = core::parseValue(*row, given.value, settings); !parsed)
        return makeError("motion blur: {}: {}", given.name, parsed.error().message);
    return {};
}

} // namespace

bool isForHosts(const Method& method) {
    return method.readsRaster;
}

core::Status checkVersion(uint32_t headerVersion) {
    constexpr uint32_t kPatch = 0xFFF;
    if (headerVersion >> 12 == SHUTTER_BLUR_VERSION >> 12 &&
        (headerVersion & kPatch) <= (SHUTTER_BLUR_VERSION & kPatch))
        return {};
    return makeError(
        "motion blur: the host was compiled with headers of version {}, the library is {}",
        describeVersion(headerVersion),
        describeVersion(SHUTTER_BLUR_VERSION)
    );
}

core::Result<HostDevice> convert(const ShutterBlurDevice* given) {
    const auto taken = takeStructure("device", given, shutterBlurDefaultDevice());
    if (!taken)
        return taken.error();
    if (taken.value().headerVersion != 0)
        SHUTTER_TRY(checkVersion(taken.value().headerVersion));
    HostDevice device;
    device.physical = taken.value().physical;
    device.device = taken.value().device;
    device.queueFamily = taken.value().queueFamily;
    device.framesInFlight = taken.value().framesInFlight;
    device.hasDebugUtils = taken.value().hasDebugUtils != VK_FALSE;
    device.pipelineCache = taken.value().pipelineCache;
    device.tracesIndirect = taken.value().tracesIndirect != VK_FALSE;
    device.apiVersion = taken.value().apiVersion;
    device.enabledFeatures = taken.value().enabledFeatures;
    device.measures = taken.value().measures != VK_FALSE;
    device.checksInputs = taken.value().checksInputs != VK_FALSE;
    if (taken.value().message)
        device.message = [send = taken.value().message,
                          user = taken.value().messageUser](std::string_view sentence) {
            send(user, std::string(sentence).c_str());
        };
    return device;
}

core::Result<HostSettings> convert(const ShutterBlurSettings* given) {
    const ShutterBlurSettings defaults = shutterBlurDefaultSettings();
    const auto taken = takeStructure("settings", given ? given : &defaults, defaults);
    if (!taken)
        return taken.error();
    const ShutterBlurSettings& wanted = taken.value();
    HostSettings made;
    MotionBlurSettings& settings = made.settings;
    if (wanted.preset) {
        const auto preset = findPreset(wanted.preset);
        if (!preset)
            return makeError("motion blur: settings.preset {}", preset.error().message);
        settings = preset.value()->settings;
        made.isOff = preset.value()->isOff;
    } else {
        const auto method = findHostMethod(wanted.method);
        if (!method)
            return method.error();
        settings.method = method.value();
    }
    if (wanted.sampleCount != 0)
        settings.sampleCount = wanted.sampleCount;
    SHUTTER_TRY(checkArray("settings.values", wanted.values, "valueCount", wanted.valueCount));
    for (uint32_t i = 0; i < wanted.valueCount; ++i)
        SHUTTER_TRY(apply(wanted.values[i], settings));
    return made;
}

core::Result<HostPlan> convert(const ShutterBlurPlan* given) {
    const auto taken = takeStructure("plan", given, shutterBlurDefaultPlan());
    if (!taken)
        return taken.error();
    const ShutterBlurPlan& wanted = taken.value();
    const auto settings = convert(wanted.settings);
    if (!settings)
        return settings.error();
    HostPlan plan;
    plan.settings = settings.value().settings;
    plan.width = wanted.width;
    plan.height = wanted.height;
    plan.viewCount = wanted.viewCount;
    plan.colorFormat = wanted.colorFormat;
    plan.outputFormat = wanted.outputFormat;
    plan.entityIdFormat = wanted.entityIdFormat;
    plan.areParts = wanted.areParts != VK_FALSE;
    plan.hasVectors = wanted.hasVectors != VK_FALSE;
    plan.lendsLast = wanted.lendsLast != VK_FALSE;
    plan.rowCount = wanted.rowCount;
    plan.moverCount = wanted.moverCount;
    plan.givesDeformedMotion = wanted.givesDeformedMotion != VK_FALSE;
    plan.blendedPixels = wanted.blendedPixels;
    plan.drawsBlended = wanted.drawsBlended != VK_FALSE;
    plan.blendedInstants = wanted.blendedInstants;
    plan.blendedParts = wanted.blendedParts;
    plan.isBlendedOpacityInAlpha = wanted.blendedOpacityInAlpha != VK_FALSE;
    plan.hasLens = wanted.hasLens != VK_FALSE;
    return plan;
}

core::Result<HostInputs> convert(const ShutterBlurInputs* given, InputArrays& arrays) {
    const auto taken = takeStructure("inputs", given, shutterBlurDefaultInputs());
    if (!taken)
        return taken.error();
    const ShutterBlurInputs& wanted = taken.value();
    SHUTTER_TRY(checkArrays(wanted));
    HostInputs inputs;
    inputs.width = wanted.width;
    inputs.height = wanted.height;
    inputs.color = convert(wanted.color);
    inputs.output = convert(wanted.output);
    inputs.motionDepth = convert(wanted.motionDepth);
    inputs.convention = convertConvention(wanted);
    inputs.convention.viewModel.viewFromObject = convertViewModel(wanted, arrays);
    inputs.transfer = {uint32_t(wanted.transfer), wanted.transferPower, wanted.transferScale};
    inputs.entityId = convert(wanted.entityId);
    inputs.noEntity = wanted.noEntity;
    inputs.rasterTime = wanted.rasterTime;
    arrays.response.clear();
    for (uint32_t i = 0; i < wanted.responsePointCount; ++i)
        arrays.response.push_back(
            {wanted.responsePoints[i].time, wanted.responsePoints[i].sensitivity}
        );
    inputs.responsePoints = arrays.response;
    inputs.frameNumber = wanted.frameNumber;
    inputs.motion = convertMotion(wanted, arrays);
    inputs.normal = convert(wanted.normal);
    setAnswer(inputs.reveal, wanted.recordReveal, wanted.revealUser, wanted.revealByRayPipeline);
    setAnswer(
        inputs.samples, wanted.recordSamples, wanted.samplesUser, wanted.samplesByRayPipeline
    );
    inputs.last = {
        convert(wanted.lastColor), convert(wanted.lastMotionDepth), convert(wanted.lastEntityId)};
    inputs.deformedMotion = convert(wanted.deformedMotion);
    inputs.lastDeformedMotion = convert(wanted.lastDeformedMotion);
    inputs.blended = convert(wanted.blended);
    inputs.drawn = convertDrawn(wanted);
    if (wanted.budgetMilliseconds != 0.0)
        inputs.budget.milliseconds = wanted.budgetMilliseconds;
    inputs.showsInputs = wanted.showsInputs != VK_FALSE;
    return inputs;
}

} // namespace shutter::motion_blur
