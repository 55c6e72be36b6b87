// SPDX-License-Identifier: MIT
// Pictures of odd and of large sizes, and more entities than the table of ids holds.
#include "engine/extract/extracted_frame.h"
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/pictures.h"

#include <array>

namespace shutter::stability {

namespace {

struct Size {
    uint32_t width;
    uint32_t height;
};

View makeView(Size size) {
    View view;
    view.width = size.width;
    view.height = size.height;
    view.exposureSeconds = 0.1;
    view.ambient = math::vec3(0.3f); // no pixel of the stage is black
    return view;
}

core::Result<Measurements> measureSmallSizes(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    addWallAndSphere(scene);
    Drawer drawer(device, std::move(scene));
    Measurements all;
    for (const Size size : {Size{1, 1}, Size{40, 40}, Size{41, 39}, Size{1, 50}, Size{81, 1}}) {
        auto found = measureEveryMethod(drawer, makeView(size));
        if (!found)
            return found;
        for (Measured& row : found.value()) {
            row.check += fmt::format(", {}x{}", size.width, size.height);
            all.push_back(std::move(row));
        }
    }
    return all;
}

/// Some methods only, without intermediates: large pictures are slow.
template <size_t N>
core::Result<Measurements>
measureLarge(gpu::Device& device, Size size, const std::array<const char*, N>& methods) {
    SceneBuilder scene = makeEmptyScene();
    addWallAndSphere(scene);
    Drawer drawer(device, std::move(scene));
    View view = makeView(size);
    view.samples = 1;
    Census census;
    for (const char* method : methods) {
        auto frame = drawer.draw(method, view, false);
        if (!frame)
            return frame.error();
        census.add(frame.value());
        // The wall fills the picture: no part of it was left undrawn.
        const image::Image& picture = frame.value().color;
        for (size_t i = 0; i < picture.pixels.size(); i += 4)
            if (picture.pixels[i] <= 0.0f)
                ++census.notFinite;
    }
    return Measurements{describe(census, "finite, and drawn everywhere")};
}

core::Result<Measurements> measureLaptop(gpu::Device& device) {
    return measureLarge(
        device, {1366, 768}, std::array{"own_velocity", "guertin2014", "gather", "hybrid"}
    );
}

core::Result<Measurements> measure8K(gpu::Device& device) {
    return measureLarge(device, {7680, 4320}, std::array{"gather"});
}

/// The table's limit is lowered to what a test can fill.
core::Result<Measurements> measureEntities(gpu::Device& device) {
    constexpr uint32_t kLimit = 7;
    Measured measured{"refused above the limit and not at it", 0.0, 0.0, ""};
    for (uint32_t count = 1; count <= kLimit + 2; ++count) {
        SceneBuilder scene = makeEmptyScene();
        const auto waves = scene.addWaves();
        for (uint32_t i = 0; i < count; ++i)
            addShape(
                scene,
                makeBoxShape(0.1, 0.1, 0.1),
                waves,
                // Every other one is out of the picture: the table holds it, rays may meet it.
                Placement{.position = {i % 2 == 0 ? 0.0 : 90.0, 0, -2}, .velocity = {0.2 * i, 0, 0}}
            );
        render::Renderer renderer(device, scene.world.assets);
        render::FrameRequest request;
        request.view.camera = scene.camera;
        request.view.width = request.view.height = 8;
        request.view.entityLimit = kLimit;
        const auto frame = renderer.renderFrame(scene.world, request, {});
        const bool refused =
            !frame && frame.error().message.find(fmt::format("more than {} entities", kLimit)) !=
                          std::string::npos;
        const bool right = count <= kLimit ? bool(frame) : refused;
        measured.worst += right ? 0.0 : 1.0;
        ++measured.samples;
    }
    return Measurements{measured};
}

} // namespace

std::vector<HardCase> listLimitCases() {
    return {
        {"SmallSizes",
         "Pictures of 1x1, 40x40, 41x39, 1x50 and 81x1 pixels",
         "One pixel, one whole tile, a tile and a bit of one, and pictures one pixel thin.",
         measureSmallSizes},
        {"Size1366x768",
         "A picture of 1366x768",
         "No side is a multiple of a tile or of a group of threads.",
         measureLaptop},
        {"Size7680x4320",
         "A picture of 7680x4320",
         "33 million pixels: indices, strides and memory of every image.",
         measure8K},
        {"TooManyEntities",
         "More entities than ids",
         "The limit of the entity table, lowered to seven, is met, reached and passed.",
         measureEntities},
    };
}

} // namespace shutter::stability
