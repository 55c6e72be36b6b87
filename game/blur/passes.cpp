// SPDX-License-Identifier: MIT
#include "game/blur/passes.h"

#include "engine/io/image_file.h"
#include "shaders/common/transfer.glsl"
#include "shaders/render/scene_shared.h"

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <span>
#include <string>
#include <utility>

namespace shutter::blur {

namespace {

using core::makeError;

/// Channels that belong together. They may follow a layer's name: "ViewLayer.Depth.Z".
using Names = std::span<const std::string_view>;

constexpr std::array<std::string_view, 4> kRgba{"R", "G", "B", "A"};
constexpr std::array<std::string_view, 4> kCombined{
    "Combined.R", "Combined.G", "Combined.B", "Combined.A"};
constexpr std::array<std::string_view, 4> kBlender{"Vector.X", "Vector.Y", "Vector.Z", "Vector.W"};
constexpr std::array<std::string_view, 2> kForward{"forward.u", "forward.v"};
constexpr std::array<std::string_view, 2> kBackward{"backward.u", "backward.v"};
constexpr std::array<std::array<std::string_view, 2>, 6> kPairs{
    {{"motion.x", "motion.y"},
     {"motion.X", "motion.Y"},
     {"u", "v"},
     {"X", "Y"},
     {"x", "y"},
     {"R", "G"}}};
constexpr std::array<std::string_view, 5> kDepths{"Depth.Z", "Depth.V", "depth.Z", "Z", "R"};
constexpr std::array<std::string_view, 3> kIds{"mesh_id", "id", "R"};

struct Picture {
    std::filesystem::path file;
    io::StoredImage stored;

    [[nodiscard]] const std::vector<std::string>& names() const {
        return stored.image.channelNames;
    }
};

core::Result<Picture> readPicture(const std::filesystem::path& file) {
    auto stored = io::readStoredImage(file);
    if (!stored)
        return stored.error();
    io::cropToDisplay(stored.value());
    Picture picture{file, std::move(stored).value()};
    std::vector<std::string>& names = picture.stored.image.channelNames;
    for (uint32_t c = uint32_t(names.size()); c < picture.stored.image.channels; ++c)
        names.emplace_back(c < kRgba.size() ? kRgba[c] : "");
    return picture;
}

/// The channel of that name, or else the only one that a layer has of it.
core::Result<std::optional<uint32_t>> findChannel(const Picture& picture, std::string_view name) {
    std::optional<uint32_t> found;
    const std::string suffix = fmt::format(".{}", name);
    const auto exact = std::find(picture.names().begin(), picture.names().end(), name);
    if (exact != picture.names().end())
        return std::optional<uint32_t>(exact - picture.names().begin());
    for (uint32_t c = 0; c < picture.names().size(); ++c) {
        if (!picture.names()[c].ends_with(suffix))
            continue;
        if (found)
            return makeError(
                "'{}': {} and {} may both be {}",
                picture.file.string(),
                picture.names()[*found],
                picture.names()[c],
                name
            );
        found = c;
    }
    return found;
}

/// The channels of all names; empty: one of them is missing.
core::Result<std::vector<uint32_t>> findChannels(const Picture& picture, Names names) {
    std::vector<uint32_t> channels;
    for (const std::string_view name : names) {
        const auto channel = findChannel(picture, name);
        if (!channel)
            return channel.error();
        if (!channel.value())
            return std::vector<uint32_t>();
        channels.push_back(*channel.value());
    }
    return channels;
}

core::Error explainMissing(const Picture& picture, std::string_view wanted) {
    return makeError(
        "'{}' has no channels {}, it has {}",
        picture.file.string(),
        wanted,
        fmt::join(picture.names(), ", ")
    );
}

/// Calls `take` with each pixel's index and the channels' values. Error: a value is NaN, or
/// infinite where it may not be.
template <class Take>
core::Status readPixels(
    const Picture& picture, std::span<const uint32_t> channels, bool mayBeInfinite, Take take
) {
    const io::StoredImage& stored = picture.stored;
    const auto left = uint32_t(stored.data.x - stored.display.x);
    const auto top = uint32_t(stored.data.y - stored.display.y);
    for (uint32_t y = 0; y < stored.image.height; ++y)
        for (uint32_t x = 0; x < stored.image.width; ++x) {
            std::array<float, 4> values{};
            for (size_t c = 0; c < channels.size(); ++c) {
                values[c] = stored.image.at(x, y, channels[c]);
                if (std::isnan(values[c]) || (!mayBeInfinite && std::isinf(values[c])))
                    return makeError(
                        "'{}': the channel {} is {} at pixel {}, {}",
                        picture.file.string(),
                        picture.names()[channels[c]],
                        std::isnan(values[c]) ? "NaN" : "infinite",
                        left + x,
                        top + y
                    );
            }
            take(size_t(top + y) * stored.display.width + left + x, values);
        }
    return {};
}

core::Status readColor(const Picture& picture, Passes& passes) {
    core::Result<std::vector<uint32_t>> channels = std::vector<uint32_t>();
    for (const Names names : {Names(kCombined), Names(kRgba), Names(kRgba).first(3)}) {
        channels = findChannels(picture, names);
        if (!channels)
            return channels.error();
        if (!channels.value().empty())
            break;
    }
    if (channels.value().empty())
        return explainMissing(picture, "R, G, B");
    passes.hasAlpha = channels.value().size() == kRgba.size();
    passes.isDisplayEncoded = picture.stored.isDisplayEncoded;
    passes.color.assign(size_t{passes.width} * passes.height, glm::vec4(0.0f));
    return readPixels(picture, channels.value(), false, [&](size_t i, const auto& values) {
        glm::vec4& pixel = passes.color[i] = {values[0], values[1], values[2], values[3]};
        if (!passes.hasAlpha)
            pixel.a = 1.0f;
        if (passes.isDisplayEncoded)
            for (int c = 0; c < 3; ++c)
                pixel[c] = shader::decodeSrgbCurve(pixel[c]);
    });
}

/// Channels of a picture of motion, and what they are.
struct MotionChannels {
    Vectors kind = Vectors::Exposure;
    std::vector<uint32_t> previous; ///< two, or none
    std::vector<uint32_t> next;
};

core::Result<MotionChannels> findMotion(const Picture& picture, const PassOptions& options) {
    MotionChannels found;
    const auto search = [&](Names names, std::vector<uint32_t>& channels) -> core::Status {
        auto all = findChannels(picture, names);
        if (!all)
            return all.error();
        channels = std::move(all).value();
        return {};
    };
    const auto mayBe = [&](Vectors kind) { return !options.vectors || options.vectors == kind; };
    if (mayBe(Vectors::Blender)) {
        found.kind = Vectors::Blender;
        SHUTTER_TRY(search(kBlender, found.previous));
        if (found.previous.empty() && options.vectors)
            SHUTTER_TRY(search(kRgba, found.previous));
        if (!found.previous.empty()) {
            found.next.assign(found.previous.begin() + 2, found.previous.end());
            found.previous.resize(2);
            return found;
        }
        if (options.vectors)
            return explainMissing(picture, "Vector.X, Vector.Y, Vector.Z, Vector.W");
    }
    if (mayBe(Vectors::Nuke)) {
        found.kind = Vectors::Nuke;
        SHUTTER_TRY(search(kForward, found.next));
        SHUTTER_TRY(search(kBackward, found.previous));
        if (!found.next.empty() || !found.previous.empty())
            return found;
        if (options.vectors)
            return explainMissing(picture, "forward.u, forward.v");
    }
    found.kind = options.vectors.value_or(Vectors::Exposure);
    std::vector<uint32_t>& pair = found.kind == Vectors::Next ? found.next : found.previous;
    for (const auto& names : kPairs) {
        SHUTTER_TRY(search(names, pair));
        if (pair.empty())
            continue;
        if (!options.vectors && names[0] != "motion.x")
            return makeError(
                "'{}': --vectors must say what the channels {} are: {}",
                picture.file.string(),
                fmt::join(names, ", "),
                fmt::join(kVectorsWords, ", ")
            );
        return found;
    }
    return explainMissing(picture, "motion.x, motion.y");
}

core::Status readMotion(const Picture& picture, const PassOptions& options, Passes& passes) {
    const auto found = findMotion(picture, options);
    if (!found)
        return found.error();
    const MotionChannels& motion = found.value();
    // From a channel's value to pixels right and down, along the time.
    glm::vec2 previous = options.motionScale;
    glm::vec2 next = options.motionScale;
    if (motion.kind == Vectors::Exposure)
        previous /= float(options.exposureShare);
    if (motion.kind == Vectors::Blender) { // before minus now, and now minus after
        previous *= glm::vec2(-1.0f, 1.0f);
        next *= glm::vec2(-1.0f, 1.0f);
    }
    if (motion.kind == Vectors::Nuke) { // before minus now, and after minus now
        previous *= glm::vec2(-1.0f, 1.0f);
        next *= glm::vec2(1.0f, -1.0f);
    }
    float share = float(options.rasterTime); // of the previous motion
    if (motion.next.empty())
        share = 1.0f;
    if (motion.previous.empty())
        share = 0.0f;
    passes.motion.assign(size_t{passes.width} * passes.height, glm::vec2(0.0f));
    const auto add = [&](std::span<const uint32_t> channels, glm::vec2 factor) {
        if (factor == glm::vec2(0.0f))
            return core::Status();
        return readPixels(picture, channels, false, [&](size_t i, const auto& values) {
            passes.motion[i] += glm::vec2(values[0], values[1]) * factor;
        });
    };
    SHUTTER_TRY(add(motion.previous, previous * share));
    return add(motion.next, next * (1.0f - share));
}

float distanceOf(double value, const PassOptions& options) {
    double distance = value;
    if (options.depth == Depth::Inverse)
        distance = 1.0 / value;
    if (options.depth == Depth::Device || options.depth == Depth::Reversed) {
        const double nearness = options.depth == Depth::Reversed ? value : 1.0 - value;
        const double far = options.far > 0.0 ? options.near / options.far : 0.0;
        distance = nearness > 0.0 ? options.near / (far + (1.0 - far) * nearness) : INFINITY;
    }
    // Not above 0: nothing is drawn there.
    return distance > 0.0 && distance < shader::kSkyDepth ? float(distance) : shader::kSkyDepth;
}

core::Status readDepth(const Picture& picture, const PassOptions& options, Passes& passes) {
    passes.depth.assign(size_t{passes.width} * passes.height, shader::kSkyDepth);
    for (const std::string_view name : kDepths) {
        const auto channel = findChannels(picture, {&name, 1});
        if (!channel)
            return channel.error();
        if (!channel.value().empty())
            return readPixels(picture, channel.value(), true, [&](size_t i, const auto& values) {
                passes.depth[i] = distanceOf(values[0], options);
            });
    }
    return explainMissing(picture, "Z");
}

core::Status readIds(const Picture& picture, Passes& passes) {
    constexpr float kMost = 16777214.0f; // 2^24 - 2: floats hold all whole numbers up to there
    passes.entityId.assign(size_t{passes.width} * passes.height, shader::kNoEntity);
    for (const std::string_view name : kIds) {
        const auto channel = findChannels(picture, {&name, 1});
        if (!channel)
            return channel.error();
        if (channel.value().empty())
            continue;
        bool areIds = true;
        SHUTTER_TRY(readPixels(picture, channel.value(), false, [&](size_t i, const auto& values) {
            areIds = areIds && values[0] == std::floor(values[0]) && values[0] <= kMost;
            if (areIds && values[0] >= 0.0f)
                passes.entityId[i] = uint32_t(values[0]);
        }));
        if (areIds)
            return {};
        return makeError(
            "'{}': ids must be whole numbers of at most {}", picture.file.string(), kMost
        );
    }
    return explainMissing(picture, "mesh_id");
}

} // namespace

core::Result<Passes> readPasses(const PassFiles& files, const PassOptions& options) {
    Passes passes;
    const auto read = [&](const std::filesystem::path& file, auto take) -> core::Status {
        const auto picture = readPicture(file);
        if (!picture)
            return picture.error();
        const io::PixelWindow& window = picture.value().stored.display;
        if (passes.width == 0) {
            passes.width = window.width;
            passes.height = window.height;
        }
        if (window.width != passes.width || window.height != passes.height)
            return makeError(
                "'{}' has {} x {} pixels, '{}' has {} x {}",
                file.string(),
                window.width,
                window.height,
                files.color.string(),
                passes.width,
                passes.height
            );
        return take(picture.value());
    };
    SHUTTER_TRY(read(files.color, [&](const Picture& one) { return readColor(one, passes); }));
    SHUTTER_TRY(read(files.motion, [&](const Picture& one) {
        return readMotion(one, options, passes);
    }));
    SHUTTER_TRY(read(files.depth, [&](const Picture& one) {
        return readDepth(one, options, passes);
    }));
    if (!files.ids.empty())
        SHUTTER_TRY(read(files.ids, [&](const Picture& one) { return readIds(one, passes); }));
    return passes;
}

} // namespace shutter::blur
