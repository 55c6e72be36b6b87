// SPDX-License-Identifier: MIT
// How much light each method loses or makes: the sum over the picture of a mover that never leaves
// it, before a background of one colour, against the sharp picture's.
#include "tests/conformance/stability/case_lists.h"
#include "tests/conformance/stability/pictures.h"

#include <array>
#include <cmath>
#include <string_view>
#include <utility>

namespace shutter::stability {

namespace {

struct Row {
    std::string_view method;
    double expected; ///< change, percent of the sharp picture's light
    double bound;    ///< of the difference from that, percent
};

/// A truth conserves light to 0.5 %. No published filter does: a gather's weights do not sum to
/// what a pixel is covered for, so the filters are held to what was measured here.
constexpr std::array kRows = {
    Row{"own_velocity", -20.6, 2.0},
    Row{"mcguire2012", 22.7, 2.0},
    Row{"guertin2014", 37.9, 2.0},
    Row{"jimenez2014", 0.0, 0.5},
    Row{"gather", 22.7, 2.0},
    Row{"hybrid", 7.5, 2.0},
    Row{"resolved", 0.2, 0.5},
    Row{"denoised", -2.1, 1.0},
    Row{"accumulate", 0.0, 0.5},
    Row{"truth", 0.0, 0.5},
};

double sumLight(const image::Image& picture) {
    double sum = 0.0;
    for (size_t i = 0; i + 2 < picture.pixels.size(); i += picture.channels)
        for (size_t c = 0; c < 3; ++c)
            sum += picture.pixels[i + c];
    return sum;
}

core::Result<Measurements> measureMover(gpu::Device& device) {
    SceneBuilder scene = makeEmptyScene();
    scene.setPixelView(64);
    addShape(
        scene,
        makeSheetShape(24, 20),
        scene.addColor({0.8f, 0.5f, 0.2f}),
        Placement{.position = {0.3, 0.2, -5}, .velocity = {16, 4, 0}}
    );
    View view{.width = 96, .height = 64, .samples = 64};
    Drawer drawer(device, std::move(scene));
    auto sharp = drawer.draw("sharp", view, false);
    if (!sharp)
        return sharp.error();
    const double light = sumLight(sharp.value().color);
    Measurements found;
    for (const Row& row : kRows) {
        auto frame = drawer.draw(row.method, view, false);
        if (!frame)
            return frame.error();
        const double change = 100.0 * (sumLight(frame.value().color) - light) / light;
        Worst worst;
        worst.add(std::abs(change - row.expected));
        worst.samples = uint64_t(view.width) * view.height;
        worst.note = fmt::format("{:+.2f} %", change);
        found.push_back(describe(
            worst,
            fmt::format("{}, from {} percent", row.method, row.expected),
            "percent",
            row.bound
        ));
    }
    return found;
}

} // namespace

std::vector<HardCase> listEnergyCases() {
    return {
        {"InteriorMover",
         "Light of a mover within the picture",
         "A sheet of one colour moves by 16 pixels before black and never leaves the picture: the "
         "sum of all pixels against the sharp picture's.",
         measureMover},
    };
}

} // namespace shutter::stability
