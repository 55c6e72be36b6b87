// SPDX-License-Identifier: MIT
#include "game/film/film_estimate.h"

#include "engine/core/progress.h"
#include "game/film/film_plan.h"
#include "game/shot/picture_drawer.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <utility>

namespace shutter::film {

namespace {

/// Enough for the costs of a flight through a few places, in seconds.
constexpr uint32_t kMostSamples = 16;
/// The least of as many measurements counts.
constexpr uint32_t kPasses = 3;
constexpr double kSmallWidth = 96.0;

/// Frame indices, the first and the last among them.
std::vector<uint32_t> chooseSamples(uint32_t frames) {
    const uint32_t count = std::min(frames, kMostSamples);
    std::vector<uint32_t> chosen;
    for (uint32_t i = 0; i < count; ++i)
        chosen.push_back(count == 1 ? 0 : uint32_t(uint64_t{frames - 1} * i / (count - 1)));
    return chosen;
}

game::ShotOptions shrink(game::ShotOptions shot) {
    const double factor = std::min(1.0, kSmallWidth / std::max(shot.width, shot.height));
    shot.width = std::max(1u, uint32_t(std::lround(shot.width * factor)));
    shot.height = std::max(1u, uint32_t(std::lround(shot.height * factor)));
    return shot;
}

} // namespace

core::Result<std::vector<double>>
estimateCosts(const game::RenderOptions& options, const game::Shot& shot, gpu::Device& device) {
    SHUTTER_TRY(
        game::PictureDrawer::check(device, options.method, options.shot.width, options.shot.height)
    );
    const game::ShotOptions small = shrink(options.shot);
    render::Renderer renderer(device, shot.world.assets);
    game::PictureDrawer drawer(device, renderer);
    const auto frames = uint32_t(small.frameTimes.size());
    const std::vector<uint32_t> chosen = chooseSamples(frames);
    core::Progress progress("estimating", chosen.size() * kPasses);
    const auto measure = [&](uint32_t frame) -> core::Result<double> {
        const auto start = std::chrono::steady_clock::now();
        auto request = game::makePicture(shot, small, options.method, small.frameTimes[frame]);
        request.frame.wantColor = true;
        if (auto drawn = drawer.draw(shot.world, request); !drawn)
            return drawn.error();
        progress.advance();
        const std::chrono::duration<double, std::milli> taken =
            std::chrono::steady_clock::now() - start;
        return taken.count();
    };
    std::vector<std::pair<uint32_t, double>> samples;
    for (const uint32_t frame : chosen)
        samples.emplace_back(frame, std::numeric_limits<double>::infinity());
    // The first pictures also pay for pipelines and uploads, and any may meet a busy machine.
    for (uint32_t pass = 0; pass < kPasses; ++pass)
        for (auto& [frame, least] : samples) {
            const auto cost = measure(frame);
            if (!cost)
                return cost.error();
            least = std::min(least, cost.value());
        }
    return interpolateCosts(samples, frames);
}

} // namespace shutter::film
