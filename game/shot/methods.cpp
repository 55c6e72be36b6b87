// SPDX-License-Identifier: MIT
#include "game/shot/methods.h"

#include "modules/motion_blur/presets.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

namespace shutter::game {

namespace {

MethodInfo describe(const motion_blur::Method& blur) {
    return {
        .name = blur.name,
        .description = blur.description,
        .publication = blur.publication,
        .family = MethodFamily::MotionBlur,
        .blur = &blur,
        .rays = blur.rays,
        .hasLens = blur.readsLens,
        .sampleUnit = blur.sampleUnit,
        .defaultSamples = blur.defaultSamples,
        .aovs = {blur.views.begin(), blur.views.end()}};
}

std::vector<MethodInfo> makeMethods() {
    std::vector<MethodInfo> methods;
    methods.push_back(
        {.name = "sharp",
         .description = "the raster image, no motion blur",
         .publication = "",
         .family = MethodFamily::Sharp}
    );
    for (const motion_blur::Method* blur : motion_blur::listMethods())
        methods.push_back(describe(*blur));
    methods.push_back(
        {.name = "accumulate",
         .description = "truth: sharp frames at many instants, averaged",
         .publication = "Haeberli and Akeley 1990",
         .family = MethodFamily::Accumulate,
         .hasLens = true,
         .sampleUnit = SampleUnit::Instants,
         .defaultSamples = 256}
    );
    methods.push_back(
        {.name = "truth",
         .description = "truth: rays that each have their own time, averaged",
         .publication = "Cook, Porter, Carpenter 1984",
         .family = MethodFamily::Truth,
         .rays = RayNeed::Query,
         .hasLens = true,
         .sampleUnit = SampleUnit::Rays,
         .defaultSamples = 256,
         .aovs = {"error"}}
    );
    return methods;
}

bool canRun(const MethodInfo& method, const gpu::DeviceInfo& device) {
    switch (method.rays) {
    case RayNeed::None:
        return true;
    case RayNeed::Any:
        return device.rayTier != gpu::RayTier::None;
    case RayNeed::Query:
        return device.rayTier == gpu::RayTier::RayQuery;
    }
    return false;
}

} // namespace

std::span<const MethodInfo> listMethods() {
    static const std::vector<MethodInfo> kMethods = makeMethods();
    return kMethods;
}

bool canRun(const MethodInfo& method, const gpu::Device& device) {
    return canRun(method, device.info());
}

const gpu::DeviceInfo*
findDeviceFor(const MethodInfo& method, std::span<const gpu::DeviceInfo> devices) {
    for (const gpu::DeviceInfo& device : devices)
        if (device.missing.empty() && canRun(method, device))
            return &device;
    return nullptr;
}

core::Result<const MethodInfo*> findMethod(std::string_view name) {
    std::string names;
    for (const MethodInfo& method : listMethods()) {
        if (method.name == name)
            return &method;
        names += fmt::format("{}{}", names.empty() ? "" : ", ", method.name);
    }
    return core::makeError("--method '{}' is not one of {}", name, names);
}

std::string listLensMethods(std::string_view before) {
    std::vector<std::string_view> names;
    for (const MethodInfo& method : listMethods())
        if (method.hasLens)
            names.emplace_back(method.name);
    const std::string_view last = names.back();
    names.pop_back();
    return fmt::format("{} {} {}", fmt::join(names, ", "), before, last);
}

std::span<const Preset> listPresets() {
    static const std::vector<Preset> kPresets = [] {
        std::vector<Preset> presets;
        for (const motion_blur::Preset& preset : motion_blur::listPresets())
            presets.push_back(
                {preset.name,
                 preset.description,
                 preset.isOff ? "sharp" : preset.settings.method->name,
                 preset.settings}
            );
        return presets;
    }();
    return kPresets;
}

core::Result<const Preset*> findPreset(std::string_view name) {
    const auto known = motion_blur::findPreset(name);
    if (!known)
        return core::makeError("--preset {}", known.error().message);
    return &listPresets()[known.value() - motion_blur::listPresets().data()];
}

PassGroup groupOf(const MethodInfo& method, render::PassOwner owner) {
    const bool drawsScene =
        method.family == MethodFamily::Accumulate || method.family == MethodFamily::Truth;
    switch (owner) {
    case render::PassOwner::Scene:
        return drawsScene ? PassGroup::Blur : PassGroup::Scene;
    case render::PassOwner::Rays:
        return method.rays != RayNeed::None ? PassGroup::Blur : PassGroup::Other;
    case render::PassOwner::Blur: // of a frame that another method drew, if this one is sharp
        return method.family == MethodFamily::Sharp && !method.lensFilter ? PassGroup::Scene
                                                                          : PassGroup::Blur;
    case render::PassOwner::Other:
        return PassGroup::Other;
    case render::PassOwner::Display:
        break;
    }
    return PassGroup::Display;
}

double sumBlurMilliseconds(const MethodInfo& method, const render::FrameStatistics& statistics) {
    double sum = 0.0;
    for (const render::PassTime& pass : statistics.passes)
        if (groupOf(method, pass.owner) == PassGroup::Blur)
            sum += pass.gpuMilliseconds;
    return sum;
}

double sumFrameMilliseconds(const render::FrameStatistics& statistics) {
    double sum = 0.0;
    for (const render::PassTime& pass : statistics.passes)
        if (pass.owner != render::PassOwner::Display)
            sum += pass.gpuMilliseconds;
    return sum;
}

} // namespace shutter::game
