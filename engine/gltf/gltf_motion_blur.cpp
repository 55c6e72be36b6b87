// SPDX-License-Identifier: MIT
#include "engine/gltf/gltf_motion_blur.h"

#include "engine/gltf/gltf_error.h"
#include "engine/gltf/gltf_value.h"

namespace shutter::gltf {

std::optional<scene::MotionBlur>
readMotionBlur(GltfContext& context, const tinygltf::Node& node, const std::string& path) {
    if (!node.extras.IsObject() || !node.extras.Has("motionBlur"))
        return std::nullopt;
    const tinygltf::Value& object = node.extras.Get("motionBlur");
    const std::string at = path + ".extras.motionBlur";
    if (!object.IsObject())
        failGltf("{} is not an object", at);
    for (const std::string& key : object.Keys())
        if (key != "scale" && key != "exclude")
            context.warnings.add(fmt::format("{} has a member '{}': not used", at, key));
    scene::MotionBlur blur;
    blur.scale = findNumber(object, "scale", at).value_or(blur.scale);
    if (!(blur.scale >= 0.0 && blur.scale <= 2.0))
        failGltf("{}.scale is {}, it must lie in [0, 2]", at, blur.scale);
    blur.exclude = findBool(object, "exclude", at).value_or(blur.exclude);
    return blur;
}

} // namespace shutter::gltf
