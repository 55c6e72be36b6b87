// SPDX-License-Identifier: MIT
#include "game/replay/dump_reader.h"

#include "engine/core/words.h"
#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"
#include "modules/motion_blur/methods.h"
#include "shaders/common/shutter_response_shared.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <charconv>
#include <limits>
#include <string_view>
#include <system_error>
#include <utility>

namespace shutter::replay {

namespace {

using json::JsonNode;
using json::JsonObject;
using json::JsonRange;

constexpr int64_t kMaxPixels = 32768;
constexpr double kMaxFloat = std::numeric_limits<float>::max();
constexpr JsonRange kFloats{-kMaxFloat, kMaxFloat};
constexpr JsonRange kKeyTimes{-motion_blur::kMaxKeyTime, motion_blur::kMaxKeyTime};

constexpr std::array<std::pair<std::string_view, Texels>, 5> kTexels{
    {{"half4", Texels::Half4},
     {"float1", Texels::Float1},
     {"float2", Texels::Float2},
     {"float4", Texels::Float4},
     {"uint1", Texels::Uint1}}};
constexpr std::array<std::pair<std::string_view, DumpedReveal>, 3> kReveals{
    {{"none", DumpedReveal::None}, {"own", DumpedReveal::Own}, {"tables", DumpedReveal::Tables}}};
constexpr std::array<std::pair<std::string_view, DumpedResponse>, 3> kResponses{
    {{"box", DumpedResponse::Box},
     {"file", DumpedResponse::File},
     {"address", DumpedResponse::Address}}};

/// Allowed texels of each image.
struct ImageRow {
    std::string_view name;
    std::array<Texels, 2> texels;
    bool hasPictureSize; ///< of its area
};

constexpr std::array<ImageRow, 22> kImages{
    {{"color", {Texels::Half4, Texels::Float4}, true},
     {"motionDepth", {Texels::Float4, Texels::Float4}, true},
     {"vectors", {Texels::Float2, Texels::Float2}, false},
     {"depth", {Texels::Float1, Texels::Float1}, false},
     {"blurScale", {Texels::Float1, Texels::Float1}, false},
     {"normal", {Texels::Half4, Texels::Float4}, true},
     {"entityId", {Texels::Uint1, Texels::Uint1}, false},
     {"deformedMotion", {Texels::Half4, Texels::Float4}, true},
     {"lastDeformedMotion", {Texels::Half4, Texels::Float4}, true},
     {"blended", {Texels::Half4, Texels::Float4}, true},
     {"drawnColor0", {Texels::Half4, Texels::Half4}, false},
     {"drawnColor1", {Texels::Half4, Texels::Half4}, false},
     {"drawnColor2", {Texels::Half4, Texels::Half4}, false},
     {"drawnColor3", {Texels::Half4, Texels::Half4}, false},
     {"drawnOpacity0", {Texels::Half4, Texels::Half4}, false},
     {"drawnOpacity1", {Texels::Half4, Texels::Half4}, false},
     {"drawnOpacity2", {Texels::Half4, Texels::Half4}, false},
     {"drawnOpacity3", {Texels::Half4, Texels::Half4}, false},
     {"revealColor", {Texels::Half4, Texels::Half4}, true},
     {"revealMotionDepth", {Texels::Float4, Texels::Float4}, true},
     {"revealEntityId", {Texels::Uint1, Texels::Uint1}, true},
     {"picture", {Texels::Half4, Texels::Half4}, true}}};

glm::dmat4 readMatrix(const JsonNode& node) {
    const std::array<double, 16> numbers = node.readNumbers<16>();
    glm::dmat4 matrix;
    for (int i = 0; i < 16; ++i)
        matrix[i / 4][i % 4] = numbers[size_t(i)];
    return matrix;
}

glm::dvec2 readPair(const JsonNode& node, const JsonRange& range = {}) {
    const std::array<double, 2> numbers = node.readNumbers<2>(range);
    return {numbers[0], numbers[1]};
}

motion_blur::HostCameras readCameras(const JsonNode& node) {
    motion_blur::HostCameras cameras;
    if (node.isNull())
        return cameras;
    const JsonObject object = node.readObject(
        {"aheadIsPlusZ",
         "viewFromWorld",
         "clipFromView",
         "viewFromWorldBefore",
         "clipFromViewBefore",
         "jitterPx",
         "jitterPxBefore"}
    );
    cameras.areGiven = true;
    cameras.aheadIsPlusZ = object.require("aheadIsPlusZ").readBoolean();
    cameras.viewFromWorld = readMatrix(object.require("viewFromWorld"));
    cameras.clipFromView = readMatrix(object.require("clipFromView"));
    cameras.viewFromWorldBefore = readMatrix(object.require("viewFromWorldBefore"));
    cameras.clipFromViewBefore = readMatrix(object.require("clipFromViewBefore"));
    cameras.jitterPx = readPair(object.require("jitterPx"));
    cameras.jitterPxBefore = readPair(object.require("jitterPxBefore"));
    return cameras;
}

/// The values are checked by the recording, as a host's are.
void readViewModel(
    const JsonNode& node, motion_blur::HostViewModel& model, std::vector<glm::dmat4>& viewFromObject
) {
    const JsonObject object =
        node.readObject({"depthMin", "depthMax", "clipFromView", "viewFromObject"});
    model.depthMin = float(object.require("depthMin").readNumber(kFloats));
    model.depthMax = float(object.require("depthMax").readNumber(kFloats));
    model.clipFromView = readMatrix(object.require("clipFromView"));
    for (const JsonNode& matrix : object.require("viewFromObject").readArray())
        viewFromObject.push_back(readMatrix(matrix));
}

motion_blur::HostConvention
readConvention(const JsonNode& node, std::vector<glm::dmat4>& viewFromObject) {
    const JsonObject object = node.readObject(
        {"pixelsPerUnit",
         "haveCamera",
         "haveJitter",
         "depthIsRaw",
         "metresPerUnit",
         "skyValue",
         "cameras",
         "exposureShare",
         "cameraScale",
         "objectScale",
         "displayedPerRendered",
         "isCut",
         "viewModel"}
    );
    const auto readFloat = [&](const char* field) {
        return float(object.require(field).readNumber(kFloats));
    };
    motion_blur::HostConvention convention;
    convention.vectors.pixelsPerUnit = readPair(object.require("pixelsPerUnit"), kFloats);
    convention.vectors.lackCamera = !object.require("haveCamera").readBoolean();
    convention.vectors.haveJitter = object.require("haveJitter").readBoolean();
    convention.depth.isLinear = !object.require("depthIsRaw").readBoolean();
    convention.depth.metresPerUnit = readFloat("metresPerUnit");
    const JsonNode sky = object.require("skyValue");
    convention.depth.skyValue =
        sky.isNull() ? std::numeric_limits<float>::quiet_NaN() : float(sky.readNumber(kFloats));
    convention.cameras = readCameras(object.require("cameras"));
    convention.scales.exposureShare = readFloat("exposureShare");
    convention.scales.camera = readFloat("cameraScale");
    convention.scales.object = readFloat("objectScale");
    convention.scales.displayedPerRendered = readFloat("displayedPerRendered");
    convention.scales.isCut = object.require("isCut").readBoolean();
    if (const auto model = object.find("viewModel"); model && !model->isNull())
        readViewModel(*model, convention.viewModel, viewFromObject);
    return convention;
}

uint64_t readId(const JsonNode& node) {
    const std::string text = node.readString(20);
    uint64_t id = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), id);
    if (error != std::errc() || end != text.data() + text.size())
        node.fail("must be a whole number of 64 bits in quotes");
    return id;
}

/// The values are checked by the recording, as a host's are.
void readLens(const JsonNode& node, DumpFrame& frame) {
    const JsonObject object = node.readObject(
        {"radius",
         "focusDistance",
         "focusDistances",
         "bladeRotation",
         "roundness",
         "squeeze",
         "blades"}
    );
    motion_blur::HostLens& lens = frame.motion.lens;
    lens.radius = object.require("radius").readNumber();
    // It does not count, and may be anything, where there is one per key.
    const JsonNode distance = object.require("focusDistance");
    lens.focusDistance = distance.isNull() ? 0.0 : distance.readNumber();
    for (const JsonNode& one : object.require("focusDistances").readArray())
        frame.focusDistances.push_back(one.readNumber());
    lens.bladeRotation = object.require("bladeRotation").readNumber();
    lens.roundness = object.require("roundness").readNumber();
    lens.squeeze = object.require("squeeze").readNumber();
    lens.blades = uint32_t(object.require("blades").readInteger(0, 16));
}

void readMotion(const JsonNode& node, DumpFrame& frame) {
    const JsonObject object = node.readObject(
        {"aheadIsPlusZ",
         "rowCount",
         "followsLast",
         "keys",
         "movers",
         "rowIds",
         "viewModelRows",
         "lens"}
    );
    frame.hasMotion = true;
    frame.motion.aheadIsPlusZ = object.require("aheadIsPlusZ").readBoolean();
    frame.motion.rowCount = uint32_t(object.require("rowCount").readInteger(1, (1 << 24) - 1));
    frame.motion.followsLast = object.require("followsLast").readBoolean();
    for (const JsonNode& one : object.require("keys").readArray(1, 64)) {
        const JsonObject key = one.readObject({"time", "viewFromWorld", "clipFromView"});
        frame.keys.push_back(
            {key.require("time").readNumber(kKeyTimes),
             readMatrix(key.require("viewFromWorld")),
             readMatrix(key.require("clipFromView"))}
        );
    }
    for (const JsonNode& one : object.require("movers").readArray()) {
        const JsonObject mover = one.readObject({"row", "worldFromObject"});
        frame.moverRows.push_back(
            uint32_t(mover.require("row").readInteger(0, int64_t{frame.motion.rowCount} - 1))
        );
        std::vector<glm::dmat4>& matrices = frame.moverMatrices.emplace_back();
        const JsonNode list = mover.require("worldFromObject");
        for (const JsonNode& matrix : list.readArray())
            matrices.push_back(readMatrix(matrix));
        if (!matrices.empty() && matrices.size() != frame.keys.size())
            list.fail("must have one matrix for each of the {} keys, or none", frame.keys.size());
    }
    const JsonNode ids = object.require("rowIds");
    for (const JsonNode& one : ids.readArray())
        frame.rowIds.push_back(readId(one));
    if (!frame.rowIds.empty() && frame.rowIds.size() != frame.motion.rowCount)
        ids.fail("must have one id for each of the {} rows, or none", frame.motion.rowCount);
    if (const auto rows = object.find("viewModelRows"); rows && !rows->isNull())
        for (const JsonNode& one : rows->readArray())
            frame.viewModelRows.push_back(
                uint32_t(one.readInteger(0, int64_t{frame.motion.rowCount} - 1))
            );
    const auto lens = object.find("lens"); // older dumps have none
    if (lens && !lens->isNull())
        readLens(*lens, frame);
}

void readSettings(const JsonObject& root, motion_blur::MotionBlurSettings& settings) {
    const JsonNode name = root.require("method");
    const motion_blur::Method* method = motion_blur::findMethod(name.readString());
    if (method)
        settings.method = method;
    else
        name.fail("is no method of the motion blur");
    for (const auto& [field, value] : root.require("settings").readFields()) {
        const auto* row = core::findRow(motion_blur::listSettingRows(), field);
        if (!row) {
            value.fail("is no setting");
            return;
        }
        if (const core::Status parsed = core::parseValue(*row, value.readString(), settings);
            !parsed)
            value.fail(parsed.error().message);
    }
}

DumpImage readImage(const JsonNode& node, const ImageRow& row, const DumpFrame& frame) {
    const JsonObject object =
        node.readObject({"file", "texels", "width", "height", "area", "format"});
    DumpImage image;
    const JsonNode file = object.require("file");
    image.file = file.readString(255);
    // A plain name: nothing outside of the folder is read.
    if (image.file.empty() || image.file.find_first_of("/\\") != std::string::npos ||
        image.file.starts_with('.') || image.file.find('\0') != std::string::npos)
        file.fail("must be the name of a file in the folder");
    const JsonNode texels = object.require("texels");
    image.texels = texels.readChoice(kTexels);
    if (image.texels != row.texels[0] && image.texels != row.texels[1])
        texels.fail("is not what this image holds");
    image.width = uint32_t(object.require("width").readInteger(1, kMaxPixels));
    image.height = uint32_t(object.require("height").readInteger(1, kMaxPixels));
    const JsonNode area = object.require("area");
    const std::array<double, 4> numbers = area.readNumbers<4>({0.0, double(kMaxPixels)});
    image.area = {
        {int32_t(numbers[0]), int32_t(numbers[1])}, {uint32_t(numbers[2]), uint32_t(numbers[3])}};
    if (numbers[2] < 1.0 || numbers[3] < 1.0 || numbers[0] + numbers[2] > image.width ||
        numbers[1] + numbers[3] > image.height)
        area.fail("must lie in the image of {} x {}", image.width, image.height);
    if (row.hasPictureSize &&
        (image.area.extent.width != frame.width || image.area.extent.height != frame.height))
        area.fail("must have the picture's size, {} x {}", frame.width, frame.height);
    (void)object.require("format").readString(64); // for people
    return image;
}

DumpedDraws readDraws(const JsonNode& node, const DumpFrame& frame) {
    const JsonObject object = node.readObject({"area", "instants", "parts", "opacityInAlpha"});
    DumpedDraws drawn;
    const JsonNode area = object.require("area");
    const std::array<double, 4> numbers = area.readNumbers<4>({0.0, double(kMaxPixels)});
    drawn.area = {
        {int32_t(numbers[0]), int32_t(numbers[1])}, {uint32_t(numbers[2]), uint32_t(numbers[3])}};
    if (numbers[2] < 1.0 || numbers[3] < 1.0 || numbers[0] + numbers[2] > frame.width ||
        numbers[1] + numbers[3] > frame.height)
        area.fail("must lie in the picture of {} x {}", frame.width, frame.height);
    drawn.instantCount = uint32_t(object.require("instants").readInteger(1, 256));
    drawn.partCount = uint32_t(object.require("parts").readInteger(1, 4));
    drawn.isOpacityInAlpha = object.require("opacityInAlpha").readBoolean();
    return drawn;
}

/// Images of the host's drawing have the size of its area.
void checkDrawn(const JsonNode& node, const DumpFrame& frame) {
    const DumpedDraws& drawn = *frame.drawn;
    for (uint32_t part = 0; part < drawn.partCount; ++part)
        for (const bool isOpacity : {false, true}) {
            if (isOpacity && drawn.isOpacityInAlpha)
                continue;
            const std::string name = nameDrawnImage(part, isOpacity);
            const DumpImage* const image = frame.find(name);
            if (!image || image->width != drawn.area.extent.width ||
                image->height != drawn.area.extent.height)
                node.fail(
                    "has no '{}' of {} x {}",
                    name,
                    drawn.area.extent.width,
                    drawn.area.extent.height
                );
        }
}

void readImages(const JsonNode& node, DumpFrame& frame) {
    for (const auto& [name, value] : node.readFields()) {
        const std::string_view wanted = name; // Clang 14 captures no structured binding
        const auto row =
            std::find_if(kImages.begin(), kImages.end(), [wanted](const ImageRow& one) {
                return one.name == wanted;
            });
        if (row == kImages.end())
            return value.fail("is no image of a dump");
        frame.images[name] = readImage(value, *row, frame);
    }
    // Without vectors nothing moves but the camera.
    const bool isMade = frame.hasConvention && !frame.find("motionDepth");
    std::vector<std::string_view> needed{"color", "picture", isMade ? "depth" : "motionDepth"};
    if (frame.reveal == DumpedReveal::Own)
        needed.insert(needed.end(), {"revealColor", "revealMotionDepth", "revealEntityId"});
    for (const std::string_view name : needed)
        if (!frame.find(std::string(name)))
            node.fail("has no '{}'", name);
    if (frame.drawn)
        checkDrawn(node, frame);
}

DumpFrame readFrame(const JsonNode& node) {
    const JsonObject root = node.readObject(
        {"format",
         "version",
         "device",
         "driver",
         "width",
         "height",
         "method",
         "settings",
         "rasterTime",
         "frameNumber",
         "view",
         "noEntity",
         "inPlace",
         "convention",
         "motion",
         "reveal",
         "drawn",
         "response",
         "images"}
    );
    constexpr std::array<std::string_view, 1> kFormat{"shutter motion blur dump"};
    DumpFrame frame;
    (void)root.require("format").readWord(kFormat);
    (void)root.require("version").readInteger(1, 1);
    (void)root.require("device").readString();
    (void)root.require("driver").readString();
    (void)root.require("inPlace").readBoolean();
    frame.width = uint32_t(root.require("width").readInteger(1, kMaxPixels));
    frame.height = uint32_t(root.require("height").readInteger(1, kMaxPixels));
    readSettings(root, frame.settings);
    frame.rasterTime = root.require("rasterTime").readNumber({0.0, 1.0});
    frame.frameNumber = root.require("frameNumber").readInteger();
    frame.view = uint32_t(root.require("view").readInteger(0, 63));
    frame.noEntity = uint32_t(root.require("noEntity").readInteger(0, 0xFFFFFFFF));
    const JsonNode convention = root.require("convention");
    frame.hasConvention = !convention.isNull();
    if (frame.hasConvention)
        frame.convention = readConvention(convention, frame.viewFromObject);
    const JsonNode motion = root.require("motion");
    if (!motion.isNull())
        readMotion(motion, frame);
    frame.reveal = root.require("reveal").readChoice(kReveals);
    frame.response = root.require("response").readChoice(kResponses);
    const auto drawn = root.find("drawn"); // older dumps have none
    if (drawn && !drawn->isNull())
        frame.drawn = readDraws(*drawn, frame);
    readImages(root.require("images"), frame);
    return frame;
}

core::Result<std::vector<uint8_t>>
readWhole(const std::filesystem::path& file, uint64_t bytes, std::string_view what) {
    std::error_code error;
    const auto size = std::filesystem::file_size(file, error);
    // Before memory is taken for it.
    if (!error && size != bytes)
        return core::makeError(
            "'{}' has {}, {} has {}", file.string(), core::countOf(size, "byte"), what, bytes
        );
    return io::readFileBytes(file, bytes);
}

} // namespace

std::string nameDrawnImage(uint32_t part, bool isOpacity) {
    return fmt::format("drawn{}{}", isOpacity ? "Opacity" : "Color", part);
}

uint32_t texelBytes(Texels texels) {
    switch (texels) {
    case Texels::Half4:
    case Texels::Float2:
        return 8;
    case Texels::Float4:
        return 16;
    default:
        return 4;
    }
}

core::Result<DumpFrame> readDumpManifest(const std::filesystem::path& file) {
    auto frame = json::readJsonFile(file, readFrame);
    if (frame)
        frame.value().name = file.stem().string();
    return frame;
}

core::Status readDumpTexels(const std::filesystem::path& folder, DumpFrame& frame) {
    for (auto& [name, image] : frame.images) {
        const uint64_t bytes = uint64_t{image.width} * image.height * texelBytes(image.texels);
        auto read = readWhole(
            folder / image.file,
            bytes,
            fmt::format("the image '{}' of {} x {}", name, image.width, image.height)
        );
        if (!read)
            return read.error();
        image.bytes = std::move(read).value();
    }
    if (frame.response != DumpedResponse::File)
        return {};
    auto table = readWhole(
        folder / (frame.name + "_response.bin"),
        sizeof(shader::ResponseTable),
        "a table of the shutter's response"
    );
    if (!table)
        return table.error();
    frame.responseBytes = std::move(table).value();
    return {};
}

core::Result<std::vector<std::filesystem::path>> listDumpFrames(const std::filesystem::path& folder
) {
    std::vector<std::filesystem::path> files;
    std::error_code ignored;
    for (uint32_t i = 0; i < 9999; ++i) {
        const auto file = folder / fmt::format("frame_{:04}.json", i);
        if (!std::filesystem::exists(file, ignored))
            break;
        files.push_back(file);
    }
    if (files.empty())
        return core::makeError("'{}' holds no dump: there is no frame_0000.json", folder.string());
    return files;
}

} // namespace shutter::replay
