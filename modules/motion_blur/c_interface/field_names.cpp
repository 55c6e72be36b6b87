// SPDX-License-Identifier: MIT
#include "modules/motion_blur/c_interface/field_names.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace shutter::motion_blur {

namespace {

struct NameRow {
    std::string_view inCpp; ///< one that ends with a dot is the beginning of names
    std::string_view inC;
};

/// The first that fits counts, so longer ones come first.
constexpr NameRow kNames[] = {
    // What C has in another place.
    {"convention.depth.isLinear", "depthIsLinear"},
    {"depth.isLinear", "depthIsLinear"},
    {"convention.vectors.lackCamera", "vectorsLackCamera"},
    {"vectors.lackCamera", "vectorsLackCamera"},
    {"convention.vectors.image.image", "vectors.image"},
    {"convention.vectors.image", "vectors"},
    {"convention.vectors.pixelsPerUnit", "pixelsPerUnit"},
    {"vectors.pixelsPerUnit", "pixelsPerUnit"},
    {"vectors.haveJitter", "vectorsHaveJitter"},
    {"convention.depth.image.image", "depth.image"},
    {"convention.depth.image", "depth"},
    {"convention.depth.metresPerUnit", "metresPerUnit"},
    {"depth.metresPerUnit", "metresPerUnit"},
    {"convention.depth.skyValue", "skyValue"},
    {"depth.skyValue", "skyValue"},
    {"convention.scales.perPixel", "blurScale"},
    {"convention.scales.camera", "cameraScale"},
    {"convention.scales.object", "objectScale"},
    {"convention.scales.", ""},
    {"scales.camera", "cameraScale"},
    {"scales.object", "objectScale"},
    {"scales.", ""},
    {"convention.", ""},
    {"motion.aheadIsPlusZ", "cameras.aheadIsPlusZ"},
    {"motion.", ""},
    {"last.color", "lastColor"},
    {"last.motionDepth", "lastMotionDepth"},
    {"last.entityId", "lastEntityId"},
    {"budget.milliseconds", "budgetMilliseconds"},
    // Callbacks. The C interface traces no rays of its own.
    {"reveal.record is empty, and HostDevice::rayTier was none", "recordReveal is null"},
    {"reveal.record is empty", "recordReveal is null"},
    {"reveal.record", "recordReveal"},
    {"samples.record is empty", "recordSamples is null"},
    {"samples.record", "recordSamples"},
    // Structures and functions.
    {"HostDevice::", "ShutterBlurDevice::"},
    {"HostInputs::", ""},
    {"HostMover::", "ShutterBlurMover::"},
    {"timeOfFrameBefore()", "shutterBlurGetTimeBefore()"},
    {"markDone", "shutterBlurMarkDone"},
    {"startWarmUp", "shutterBlurStartWarmUp"},
    {"isWarm()", "shutterBlurIsWarm()"},
};

bool isPartOfName(char letter) {
    return std::isalnum(static_cast<unsigned char>(letter)) != 0 || letter == '_';
}

/// Whether the text goes on with the name, and not with a longer one; or with a longer one than the
/// name's beginning, and not with a full stop.
bool begins(std::string_view text, std::string_view name) {
    if (!text.starts_with(name))
        return false;
    const bool goesOn = text.size() > name.size() && isPartOfName(text[name.size()]);
    return name.ends_with('.') ? goesOn : !isPartOfName(name.back()) || !goesOn;
}

/// Length of what is quoted at the text's beginning; 0: nothing is.
size_t measureQuoted(std::string_view text) {
    if (!text.starts_with('\''))
        return 0;
    for (size_t i = 1; i < text.size(); ++i)
        if (text[i] == '\'' && (i + 1 == text.size() || !isPartOfName(text[i + 1])))
            return i + 1;
    return 0;
}

} // namespace

std::string nameForC(std::string_view sentence) {
    std::string made;
    char before = ' ';
    while (!sentence.empty()) {
        const bool isStart = !isPartOfName(before) && before != '.' && before != ':';
        const auto row =
            std::find_if(std::begin(kNames), std::end(kNames), [&](const NameRow& one) {
                return isStart && begins(sentence, one.inCpp);
            });
        size_t taken = isPartOfName(before) ? 0 : measureQuoted(sentence);
        if (row != std::end(kNames)) {
            taken = row->inCpp.size();
            made += row->inC;
        } else {
            taken = std::max<size_t>(taken, 1);
            made += sentence.substr(0, taken);
        }
        before = sentence[taken - 1];
        sentence.remove_prefix(taken);
    }
    return made;
}

} // namespace shutter::motion_blur
