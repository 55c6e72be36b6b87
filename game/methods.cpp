// SPDX-License-Identifier: MIT
#include "game/methods.h"

namespace shutter::game {

std::span<const MethodInfo> listMethods() {
    static const std::vector<MethodInfo> kMethods = {
        {MethodId::Sharp, "sharp", "the raster image, no motion blur", false, 0, {}},
        {MethodId::Gather,
         "gather",
         "gather along dominant motion (the paper's post-process)",
         false,
         15,
         {"tiles"}},
        {MethodId::Hybrid,
         "hybrid",
         "gather with the background that rays reveal (the paper)",
         true,
         15,
         {"tiles", "edge", "mask", "reveal"}},
        {MethodId::Accumulate,
         "accumulate",
         "truth: sharp frames at many instants, averaged",
         false,
         256,
         {}},
    };
    return kMethods;
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
