// SPDX-License-Identifier: MIT
#include "tests/stability/soak_script.h"

#include "game/demos/random.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <algorithm>
#include <array>
#include <map>
#include <utility>

namespace shutter::stability {

namespace {

using nlohmann::ordered_json;

constexpr double kFrameSeconds = 1.0 / 30.0;
constexpr uint32_t kKeptPictures = 20;

/// The events of one cycle by frame.
using Cycle = std::map<uint32_t, std::vector<ordered_json>>;

/// What is tapped every third frame: methods twice as often as the rest. M walks through all
/// methods, N through those of the left side, V through the intermediates.
constexpr std::array kToggles = {
    "m", "m", "m", "n", "v", "x", "b", "f1", "1", "2", "3", "4", "5", "comma", "slash"};
constexpr uint32_t kToggleEvery = 3;
/// From here on a cycle goes back to how it began.
constexpr uint32_t kReturn = 225;

ordered_json tap(const char* key) {
    return {{"key", key}};
}

ordered_json makeResize(uint32_t width, uint32_t height) {
    return {{"resize", {std::max(width, 1u), std::max(height, 1u)}}};
}

void addToggles(Cycle& cycle) {
    game::Random random(1);
    for (uint32_t frame = 4; frame < 195; frame += kToggleEvery)
        cycle[frame].push_back(
            tap(kToggles[static_cast<size_t>(random.next() * double(kToggles.size()))])
        );
}

void addSizes(Cycle& cycle, const game::PictureSize& size) {
    const auto [width, height] = size;
    cycle[31].push_back(makeResize(width * 3 / 2, height * 3 / 2));
    cycle[72].push_back(makeResize(width / 2, height));
    cycle[113].push_back(makeResize(width + 1, height - height / 3));
    cycle[154].push_back(makeResize(width, height));
}

void addPlay(Cycle& cycle) {
    cycle[10].push_back({{"leftStick", {0.5, 1.0}}});
    cycle[20].push_back({{"key", "space"}, {"action", "press"}});
    cycle[60].push_back({{"leftStick", {-0.7, 0.3}}});
    cycle[120].push_back({{"key", "space"}, {"action", "release"}});
    cycle[130].push_back({{"leftStick", {0.0, 0.0}}});
    // Six, so that demos of two and of three cameras end a cycle with the one they began with.
    for (uint32_t frame = 12; frame < 190; frame += 30)
        cycle[frame].push_back(tap("c"));
}

/// Photo mode, a pause and single steps, and then everything as at the start.
void addPauses(Cycle& cycle) {
    cycle[200].push_back(tap("t"));
    cycle[204].push_back(tap("p")); // leaves photo mode and the pause that comes with it
    cycle[208].push_back(tap("p"));
    cycle[210].push_back(tap("period"));
    cycle[212].push_back(tap("period"));
    cycle[214].push_back(tap("p"));
    cycle[kReturn].push_back(tap("f9"));
    // As many as there are speeds: the last of them is the usual one.
    for (uint32_t i = 1; i <= 5; ++i)
        cycle[kReturn + i].push_back(tap("slash"));
}

} // namespace

std::vector<uint32_t> chooseFrames(uint32_t frameCount) {
    std::vector<uint32_t> frames;
    const uint32_t count = std::min(kKeptPictures, frameCount);
    for (uint32_t i = 0; i < count; ++i) {
        const uint64_t spread = uint64_t{frameCount} * (i + 1) / (count + 1);
        frames.push_back(
            static_cast<uint32_t>(spread - spread % kCycleFrames) +
            kCycleFrames * (i + 1) / (count + 1)
        );
    }
    std::erase_if(frames, [&](uint32_t frame) { return frame >= frameCount; });
    return frames;
}

std::filesystem::path pictureFile(const std::filesystem::path& folder, uint32_t frame) {
    return folder / fmt::format("frame_{:06}.png", frame);
}

ordered_json makeSoakScript(
    uint32_t frameCount, const game::PictureSize& size, const std::filesystem::path& pictures
) {
    Cycle cycle;
    addToggles(cycle);
    addSizes(cycle, size);
    addPlay(cycle);
    addPauses(cycle);
    const std::vector<uint32_t> kept = chooseFrames(frameCount);
    ordered_json events = ordered_json::array();
    const auto add = [&](uint32_t frame, ordered_json event) {
        // Half a frame before its frame: no rounding puts it into the next.
        event["time"] = std::max(double(frame) - 0.5, 0.0) * kFrameSeconds;
        events.push_back(std::move(event));
    };
    for (uint32_t frame = 0; frame < frameCount; ++frame) {
        if (const auto found = cycle.find(frame % kCycleFrames); found != cycle.end())
            for (const ordered_json& event : found->second)
                add(frame, event);
        if (std::find(kept.begin(), kept.end(), frame) != kept.end())
            add(frame, {{"screenshot", pictureFile(pictures, frame).string()}});
    }
    add(frameCount, {{"window", "quit"}});
    return {{"version", 1}, {"frameSeconds", kFrameSeconds}, {"events", std::move(events)}};
}

ordered_json makeSoakSettings() {
    return {
        {"version", 1},
        {"method", "resolved"},
        {"instants", 2},
        {"rays", 1},
        {"denoisedRays", 1},
        {"showPanel", false}};
}

} // namespace shutter::stability
