// SPDX-License-Identifier: MIT
#include "game/methods.h"

namespace shutter::game {

std::span<const MethodInfo> listMethods() {
    using motion_blur::Method;
    static const std::vector<MethodInfo> kMethods = {
        {.name = "sharp",
         .description = "the raster image, no motion blur",
         .publication = "",
         .family = MethodFamily::Sharp,
         .blur = {},
         .rays = RayNeed::None,
         .dial = Dial::None,
         .defaultSamples = 0,
         .aovs = {}},
        {.name = "own_velocity",
         .description = "mean of samples along each pixel's own motion",
         .publication = "three.js, Babylon.js; Bevy with occluderTest=velocity",
         .family = MethodFamily::MotionBlur,
         .blur = Method::OwnVelocity,
         .rays = RayNeed::None,
         .dial = Dial::Samples,
         .defaultSamples = 16,
         .aovs = {}},
        {.name = "mcguire2012",
         .description = "gather along dominant motion, soft depth test",
         .publication = "McGuire, Hennessy, Bukowski, Osman 2012",
         .family = MethodFamily::MotionBlur,
         .blur = Method::McGuire2012,
         .rays = RayNeed::None,
         .dial = Dial::Samples,
         .defaultSamples = 15,
         .aovs = {"tiles"}},
        {.name = "guertin2014",
         .description = "gather along two directions, feature-aware",
         .publication = "Guertin, McGuire, Nowrouzezahrai 2014",
         .family = MethodFamily::MotionBlur,
         .blur = Method::Guertin2014,
         .rays = RayNeed::None,
         .dial = Dial::Samples,
         .defaultSamples = 35,
         .aovs = {"tiles", "variance"}},
        {.name = "jimenez2014",
         .description = "scatter as you gather, mirrored weights",
         .publication = "Jimenez 2014",
         .family = MethodFamily::MotionBlur,
         .blur = Method::Jimenez2014,
         .rays = RayNeed::None,
         .dial = Dial::Samples,
         .defaultSamples = 8,
         .aovs = {"tiles"}},
        {.name = "gather",
         .description = "gather along dominant motion (the paper's post-process)",
         .publication = "Tan, Cui, Bhojan, Hybrid MBlur, post-process",
         .family = MethodFamily::MotionBlur,
         .blur = Method::Gather,
         .rays = RayNeed::None,
         .dial = Dial::Samples,
         .defaultSamples = 15,
         .aovs = {"tiles"}},
        {.name = "hybrid",
         .description = "gather with the background that rays reveal (the paper)",
         .publication = "Tan, Cui, Bhojan, Hybrid MBlur",
         .family = MethodFamily::MotionBlur,
         .blur = Method::Hybrid,
         .rays = RayNeed::Any,
         .dial = Dial::Samples,
         .defaultSamples = 15,
         .aovs = {"tiles", "edge", "mask", "reveal"}},
        {.name = "denoised",
         .description = "a ray a pixel at a random time, filtered along the motion",
         .publication = "Oberberger, Chajdas, Westermann 2022",
         .family = MethodFamily::MotionBlur,
         .blur = Method::Denoised,
         .rays = RayNeed::Query,
         .dial = Dial::Rays,
         .defaultSamples = 1,
         .aovs = {"tiles", "noisy"}},
        {.name = "accumulate",
         .description = "truth: sharp frames at many instants, averaged",
         .publication = "Haeberli and Akeley 1990",
         .family = MethodFamily::Accumulate,
         .blur = {},
         .rays = RayNeed::None,
         .dial = Dial::Instants,
         .defaultSamples = 256,
         .aovs = {}},
        {.name = "truth",
         .description = "truth: rays that each have their own time, averaged",
         .publication = "Cook, Porter, Carpenter 1984",
         .family = MethodFamily::Truth,
         .blur = {},
         .rays = RayNeed::Query,
         .dial = Dial::Rays,
         .defaultSamples = 256,
         .aovs = {"error"}},
    };
    return kMethods;
}

bool canRun(const MethodInfo& method, const gpu::Device& device) {
    switch (method.rays) {
    case RayNeed::None:
        return true;
    case RayNeed::Any:
        return device.hasRays();
    case RayNeed::Query:
        return device.hasRayQuery();
    }
    return false;
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

} // namespace shutter::game
