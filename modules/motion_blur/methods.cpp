// SPDX-License-Identifier: MIT
#include "modules/motion_blur/methods.h"

#include "engine/core/check.h"

#include <array>

namespace shutter::motion_blur {

// Each is defined in methods/, in the file of its name.
extern const Method kRosado2007;
extern const Method kOwnVelocity;
extern const Method kMcGuire2012;
extern const Method kGuertin2014;
extern const Method kJimenez2014;
extern const Method kGather;
extern const Method kHybrid;
extern const Method kResolved;
extern const Method kAdaptive;
extern const Method kDenoised;

const Method& getDefaultMethod(bool knowsMotions) {
    return knowsMotions ? kResolved : kGather;
}

std::span<const Method* const> listMethods() {
    static const std::array kMethods{
        &kRosado2007,
        &kOwnVelocity,
        &kMcGuire2012,
        &kGuertin2014,
        &kJimenez2014,
        &kGather,
        &kHybrid,
        &kResolved,
        &kAdaptive,
        &kDenoised};
    return kMethods;
}

const Method* findMethod(std::string_view name) {
    for (const Method* method : listMethods())
        if (method->name == name)
            return method;
    return nullptr;
}

const Method& getMethod(std::string_view name) {
    const Method* method = findMethod(name);
    SHUTTER_CHECK(method, "there is no method {}", name);
    return *method;
}

} // namespace shutter::motion_blur
