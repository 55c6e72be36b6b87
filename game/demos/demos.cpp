// SPDX-License-Identifier: MIT
#include "game/demos/demo.h"
#include "game/demos/gallery_demo.h"
#include "game/demos/rally_demo.h"
#include "game/demos/spin_demo.h"
#include "game/demos/stage.h"

#include <array>
#include <utility>

namespace shutter::game {

namespace {

using Create = core::Result<std::unique_ptr<Demo>> (*)(scene::World world, std::string_view file);

constexpr std::array kInfos = {
    DemoInfo{
        "rally",
        "two laps by car, through gates and past posts, against the clock",
        {"steer", "throttle and brake", "hand brake", "car"}},
    DemoInfo{
        "gallery",
        "45 seconds of throwing balls at targets that cross on rails",
        {"aim sideways", "aim up and down", "throw", "launcher"}},
    DemoInfo{
        "spin",
        "45 seconds of keeping a carousel's rate and catching its ring",
        {"walk round", "faster and slower", "grab the ring as the golden horse passes", "hub"}}};

constexpr std::array<Create, kInfos.size()> kCreators = {
    &RallyDemo::create, &GalleryDemo::create, &SpinDemo::create};

} // namespace

std::span<const DemoInfo> listDemos() {
    return kInfos;
}

core::Result<std::unique_ptr<Demo>>
makeDemo(std::string_view name, const std::filesystem::path& assetFolder) {
    std::string names;
    for (size_t i = 0; i < kInfos.size(); ++i) {
        names += (i ? ", " : "") + std::string(kInfos[i].name);
        if (name != kInfos[i].name)
            continue;
        const std::filesystem::path file = assetFolder / (std::string(name) + ".glb");
        auto world = loadDemoScene(file);
        if (!world)
            return world.error();
        return kCreators[i](std::move(world).value(), file.string());
    }
    return core::makeError("demo '{}' is none of: {}", name, names);
}

} // namespace shutter::game
