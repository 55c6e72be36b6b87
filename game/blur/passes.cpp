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
#include <cstddef>
#include <initializer_list>
#include <span>
#include <string>
#include <utility>

namespace shutter::blur {

namespace {

using core::makeError;

/// Channels that belong together. They may follow a layer's name: "ViewLayer.Depth.Z".
using Names = std::vector<std::string_view>;

const std::vector<Names>& listColors() {
    static const std::vector<Names> kNames{
        {"Combined.R", "Combined.G", "Combined.B", "Combined.A"},
        {"R", "G", "B", "A"},
        {"R", "G", "B"}};
    return kNames;
}

const std::vector<Names>& listDepths() {
    static const std::vector<Names> kNames{{"Depth.Z"}, {"Depth.V"}, {"depth.Z"}, {"Z"}, {"R"}};
    return kNames;
}

const std::vector<Names>& listIds() {
    static const std::vector<Names> kNames{{"mesh_id"}, {"id"}, {"R"}};
    return kNames;
}

/// Channels of motion: first those to the previous frame, then those to the next.
struct MotionRow {
    Vectors kind;
    bool isTelling; ///< the names alone tell the kind
    Names names;
};

std::vector<MotionRow> listMotions() {
    std::vector<MotionRow> rows{
        {Vectors::Exposure, true, {"motion.x", "motion.y"}},
        {Vectors::Blender, true, {"Vector.X", "Vector.Y", "Vector.Z", "Vector.W"}},
        {Vectors::Blender, false, {"R", "G", "B", "A"}},
        {Vectors::Nuke, true, {"backward.u", "backward.v", "forward.u", "forward.v"}},
        {Vectors::Nuke, true, {"forward.u", "forward.v"}},
        {Vectors::Nuke, true, {"backward.u", "backward.v"}}};
    for (const Vectors kind : {Vectors::Exposure, Vectors::Previous, Vectors::Next})
        for (const Names& names : std::initializer_list<Names>{
                 {"motion.x", "motion.y"},
                 {"motion.X", "motion.Y"},
                 {"u", "v"},
                 {"X", "Y"},
                 {"R", "G"}})
            rows.push_back({kind, false, names});
    return rows;
}

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
        names.emplace_back(c < 4 ? std::string(1, "RGBA"[c]) : "");
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

/// The channels of all names. Empty: one of them is missing.
core::Result<std::vector<uint32_t>> findChannels(const Picture& picture, const Names& names) {
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

core::Error explainMissing(const Picture& picture, const Names& wanted) {
    return makeError(
        "'{}' has no channels {}, it has {}",
        picture.file.string(),
        fmt::join(wanted, ", "),
        fmt::join(picture.names(), ", ")
    );
}

/// The channels of the first names that the picture has. Error: it has none of them.
core::Result<std::vector<uint32_t>>
findFirst(const Picture& picture, const std::vector<Names>& choices, const Names& wanted) {
    for (const Names& names : choices) {
        auto channels = findChannels(picture, names);
        if (!channels || !channels.value().empty())
            return channels;
    }
    return explainMissing(picture, wanted);
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
    const auto channels = findFirst(picture, listColors(), {"R", "G", "B"});
    if (!channels)
        return channels.error();
    passes.hasAlpha = channels.value().size() == 4;
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

struct MotionChannels {
    Vectors kind;
    std::vector<uint32_t> previous; ///< two, or none
    std::vector<uint32_t> next;
};

core::Result<MotionChannels> findMotion(const Picture& picture, const PassOptions& options) {
    Names wanted;
    for (const MotionRow& row : listMotions()) {
        if (options.vectors && row.kind != *options.vectors)
            continue;
        if (wanted.empty())
            wanted = row.names;
        auto channels = findChannels(picture, row.names);
        if (!channels)
            return channels.error();
        std::vector<uint32_t>& all = channels.value();
        if (all.empty())
            continue;
        if (!options.vectors && !row.isTelling)
            return makeError(
                "'{}': --vectors must say what the channels {} are: {}",
                picture.file.string(),
                fmt::join(row.names, ", "),
                fmt::join(kVectorsWords, ", ")
            );
        if (row.kind == Vectors::Next || row.names.front() == "forward.u")
            return MotionChannels{row.kind, {}, std::move(all)};
        return MotionChannels{row.kind, {all[0], all[1]}, {all.begin() + 2, all.end()}};
    }
    return explainMissing(picture, wanted);
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
    const auto channel = findFirst(picture, listDepths(), {"Z"});
    if (!channel)
        return channel.error();
    return readPixels(picture, channel.value(), true, [&](size_t i, const auto& values) {
        passes.depth[i] = distanceOf(values[0], options);
    });
}

core::Status readIds(const Picture& picture, Passes& passes) {
    constexpr float kMost = 16777214.0f; // 2^24 - 2: floats hold all whole numbers up to there
    passes.entityId.assign(size_t{passes.width} * passes.height, shader::kNoEntity);
    const auto channel = findFirst(picture, listIds(), {"mesh_id"});
    if (!channel)
        return channel.error();
    bool areIds = true;
    SHUTTER_TRY(readPixels(picture, channel.value(), false, [&](size_t i, const auto& values) {
        areIds = areIds && values[0] == std::floor(values[0]) && values[0] <= kMost;
        if (areIds && values[0] >= 0.0f)
            passes.entityId[i] = uint32_t(values[0]);
    }));
    return areIds
               ? core::Status()
               : makeError(
                     "'{}': ids must be whole numbers of at most {}", picture.file.string(), kMost
                 );
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
