// SPDX-License-Identifier: MIT
// The structs of shaders/**_shared.h are compiled twice. Here glslang is asked where it puts every
// member, and the answer is held against C++'s.
#include "shaders/accumulate/accumulate_shared.h"
#include "shaders/common/shutter_response_shared.h"
#include "shaders/motion_blur/motion_blur_shared.h"
#include "shaders/render/deform_shared.h"
#include "shaders/render/scene_shared.h"
#include "shaders/render/timed_scene_shared.h"
#include "shaders/tonemap/tonemap_shared.h"
#include "shaders/truth/truth_shared.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <memory>
#include <regex>
#include <string>
#include <unistd.h>
#include <vector>

namespace shutter::shader {

namespace {

namespace fs = std::filesystem;

struct Member {
    const char* name;
    size_t offset;
    size_t bytes;
};

struct Struct {
    const char* name;
    size_t bytes;
    std::vector<Member> members;
};

#define MEMBER(type, name)                                                                         \
    { #name, offsetof(type, name), sizeof(type::name) }

const std::vector<Struct>& listStructs() {
    static const std::vector<Struct> kStructs = {
        {"Vertex",
         sizeof(Vertex),
         {MEMBER(Vertex, positionU0),
          MEMBER(Vertex, normalV0),
          MEMBER(Vertex, tangent),
          MEMBER(Vertex, uv1),
          MEMBER(Vertex, color)}},
        {"EntityRow",
         sizeof(EntityRow),
         {MEMBER(EntityRow, clipFromObjectRaster),
          MEMBER(EntityRow, eyeFromObject),
          MEMBER(EntityRow, firstGeometry),
          MEMBER(EntityRow, handedness),
          MEMBER(EntityRow, motion),
          MEMBER(EntityRow, instanceMask)}},
        {"EntityMotion",
         sizeof(EntityMotion),
         {MEMBER(EntityMotion, clipFromObjectOpen), MEMBER(EntityMotion, clipFromObjectClose)}},
        {"Geometry",
         sizeof(Geometry),
         {MEMBER(Geometry, vertices),
          MEMBER(Geometry, indices),
          MEMBER(Geometry, openPositions),
          MEMBER(Geometry, closePositions),
          MEMBER(Geometry, material),
          MEMBER(Geometry, firstIndex),
          MEMBER(Geometry, indexCount),
          MEMBER(Geometry, vertexCount)}},
        {"JointInfluences",
         sizeof(JointInfluences),
         {MEMBER(JointInfluences, joints), MEMBER(JointInfluences, weights)}},
        {"MorphDelta",
         sizeof(MorphDelta),
         {MEMBER(MorphDelta, position), MEMBER(MorphDelta, normal), MEMBER(MorphDelta, tangent)}},
        {"DeformJob",
         sizeof(DeformJob),
         {MEMBER(DeformJob, vertices),
          MEMBER(DeformJob, influences),
          MEMBER(DeformJob, deltas),
          MEMBER(DeformJob, joints),
          MEMBER(DeformJob, weights),
          MEMBER(DeformJob, output_),
          MEMBER(DeformJob, vertexCount),
          MEMBER(DeformJob, influenceCount),
          MEMBER(DeformJob, jointCount),
          MEMBER(DeformJob, targetCount),
          MEMBER(DeformJob, weightStride),
          MEMBER(DeformJob, positionsOnly)}},
        {"DeformedBoxJob",
         sizeof(DeformedBoxJob),
         {MEMBER(DeformedBoxJob, vertices),
          MEMBER(DeformedBoxJob, indices),
          MEMBER(DeformedBoxJob, boxes),
          MEMBER(DeformedBoxJob, boxStride),
          MEMBER(DeformedBoxJob, vertexCount),
          MEMBER(DeformedBoxJob, triangleCount),
          MEMBER(DeformedBoxJob, padding0)}},
        {"TextureRef",
         sizeof(TextureRef),
         {MEMBER(TextureRef, axes),
          MEMBER(TextureRef, offset),
          MEMBER(TextureRef, texture),
          MEMBER(TextureRef, uvSet)}},
        {"MaterialRow",
         sizeof(MaterialRow),
         {MEMBER(MaterialRow, baseColor),
          MEMBER(MaterialRow, emissiveCutoff),
          MEMBER(MaterialRow, surface),
          MEMBER(MaterialRow, flags),
          MEMBER(MaterialRow, padding0),
          MEMBER(MaterialRow, padding1),
          MEMBER(MaterialRow, padding2),
          MEMBER(MaterialRow, baseColorTexture),
          MEMBER(MaterialRow, metallicRoughnessTexture),
          MEMBER(MaterialRow, normalTexture),
          MEMBER(MaterialRow, occlusionTexture),
          MEMBER(MaterialRow, emissiveTexture)}},
        {"LightRow",
         sizeof(LightRow),
         {MEMBER(LightRow, positionRange),
          MEMBER(LightRow, direction),
          MEMBER(LightRow, radiance),
          MEMBER(LightRow, kind),
          MEMBER(LightRow, spotScale),
          MEMBER(LightRow, spotOffset),
          MEMBER(LightRow, padding0)}},
        {"FrameConstants",
         sizeof(FrameConstants),
         {MEMBER(FrameConstants, clipFromEye),
          MEMBER(FrameConstants, eyeFromClip),
          MEMBER(FrameConstants, clipFromDirectionOpen),
          MEMBER(FrameConstants, clipFromDirectionClose),
          MEMBER(FrameConstants, forward),
          MEMBER(FrameConstants, background),
          MEMBER(FrameConstants, ambient),
          MEMBER(FrameConstants, sizePx),
          MEMBER(FrameConstants, pixelFootprint),
          MEMBER(FrameConstants, lodBias),
          MEMBER(FrameConstants, flags),
          MEMBER(FrameConstants, lightCount),
          MEMBER(FrameConstants, padding0),
          MEMBER(FrameConstants, entities),
          MEMBER(FrameConstants, entityMotions),
          MEMBER(FrameConstants, geometries),
          MEMBER(FrameConstants, materials),
          MEMBER(FrameConstants, lights),
          MEMBER(FrameConstants, movingTlas)}},
        {"TimedRow",
         sizeof(TimedRow),
         {MEMBER(TimedRow, keys),
          MEMBER(TimedRow, keyCount),
          MEMBER(TimedRow, firstGeometry),
          MEMBER(TimedRow, meshScene),
          MEMBER(TimedRow, deformationKeyCount),
          MEMBER(TimedRow, handedness)}},
        {"TimedConstants",
         sizeof(TimedConstants),
         {MEMBER(TimedConstants, view),
          MEMBER(TimedConstants, rows),
          MEMBER(TimedConstants, boxes),
          MEMBER(TimedConstants, cameraKeys),
          MEMBER(TimedConstants, lights),
          MEMBER(TimedConstants, cameraKeyCount),
          MEMBER(TimedConstants, lightKeyCount),
          MEMBER(TimedConstants, lightCount),
          MEMBER(TimedConstants, padding0)}},
        {"TruthParams",
         sizeof(TruthParams),
         {MEMBER(TruthParams, sizePx),
          MEMBER(TruthParams, frame),
          MEMBER(TruthParams, moving),
          MEMBER(TruthParams, firstRay),
          MEMBER(TruthParams, rayCount),
          MEMBER(TruthParams, seed),
          MEMBER(TruthParams, boxFilter),
          MEMBER(TruthParams, response)}},
        {"DrawConstants",
         sizeof(DrawConstants),
         {MEMBER(DrawConstants, frame),
          MEMBER(DrawConstants, entity),
          MEMBER(DrawConstants, geometry)}},
        {"MotionBlurParams",
         sizeof(MotionBlurParams),
         {MEMBER(MotionBlurParams, sizePx),
          MEMBER(MotionBlurParams, tileCount),
          MEMBER(MotionBlurParams, tileSizePx),
          MEMBER(MotionBlurParams, neighbourRadius),
          MEMBER(MotionBlurParams, sampleCount),
          MEMBER(MotionBlurParams, softDepthExtent),
          MEMBER(MotionBlurParams, edgeThreshold),
          MEMBER(MotionBlurParams, rasterTime),
          MEMBER(MotionBlurParams, foregroundMagnification),
          MEMBER(MotionBlurParams, backgroundMagnification),
          MEMBER(MotionBlurParams, jitter),
          MEMBER(MotionBlurParams, recursionLimit),
          MEMBER(MotionBlurParams, flags),
          MEMBER(MotionBlurParams, luminanceThreshold),
          MEMBER(MotionBlurParams, frame),
          MEMBER(MotionBlurParams, centreBias),
          MEMBER(MotionBlurParams, speedThresholdPx),
          MEMBER(MotionBlurParams, moving),
          MEMBER(MotionBlurParams, luminanceSigma),
          MEMBER(MotionBlurParams, stepPx),
          MEMBER(MotionBlurParams, response),
          MEMBER(MotionBlurParams, uniformMotionPx),
          MEMBER(MotionBlurParams, maxMotionDepth),
          MEMBER(MotionBlurParams, marginPx),
          MEMBER(MotionBlurParams, rayShare),
          MEMBER(MotionBlurParams, halfResolutionPx)}},
        {"ResponseKnot",
         sizeof(ResponseKnot),
         {MEMBER(ResponseKnot, s),
          MEMBER(ResponseKnot, density),
          MEMBER(ResponseKnot, cumulative),
          MEMBER(ResponseKnot, padding0)}},
        {"ResponseTable",
         sizeof(ResponseTable),
         {MEMBER(ResponseTable, knotCount),
          MEMBER(ResponseTable, padding0),
          MEMBER(ResponseTable, padding1),
          MEMBER(ResponseTable, padding2),
          MEMBER(ResponseTable, knots)}},
        {"DispatchArguments",
         sizeof(DispatchArguments),
         {MEMBER(DispatchArguments, groupsX),
          MEMBER(DispatchArguments, groupsY),
          MEMBER(DispatchArguments, groupsZ)}},
        {"BlockHeader",
         sizeof(BlockHeader),
         {MEMBER(BlockHeader, uniformCount),
          MEMBER(BlockHeader, mixedCount),
          MEMBER(BlockHeader, maskedCount),
          MEMBER(BlockHeader, padding0)}},
        {"TileHeader",
         sizeof(TileHeader),
         {MEMBER(TileHeader, count),
          MEMBER(TileHeader, padding0),
          MEMBER(TileHeader, padding1),
          MEMBER(TileHeader, padding2)}},
        {"MaskHeader",
         sizeof(MaskHeader),
         {MEMBER(MaskHeader, listedPixels),
          MEMBER(MaskHeader, raysTraced),
          MEMBER(MaskHeader, sharingPixels),
          MEMBER(MaskHeader, padding0)}},
        {"AccumulateParams",
         sizeof(AccumulateParams),
         {MEMBER(AccumulateParams, sizePx),
          MEMBER(AccumulateParams, index),
          MEMBER(AccumulateParams, scale)}},
        {"TonemapParams",
         sizeof(TonemapParams),
         {MEMBER(TonemapParams, sizePx),
          MEMBER(TonemapParams, gain),
          MEMBER(TonemapParams, operator_)}},
    };
    return kStructs;
}

/// Members that are structs or arrays themselves are asked for their first scalar or vector.
std::string leafOf(const Struct& type, const Member& member) {
    const std::string name = member.name;
    if (std::string(type.name) == "MaterialRow" && name.ends_with("Texture"))
        return name + ".axes";
    if (name == "eyeFromObject")
        return name + "[0]";
    if (name == "knots")
        return name + "[0].s";
    return name;
}

/// Touches every member, so that reflection lists it.
std::string writeShader(const Struct& type) {
    std::string text = "#version 460\n"
                       "#extension GL_GOOGLE_include_directive : require\n"
                       "#extension GL_EXT_scalar_block_layout : require\n";
    for (const char* header :
         {"common/shutter_response_shared.h",
          "render/scene_shared.h",
          "render/timed_scene_shared.h",
          "render/deform_shared.h",
          "truth/truth_shared.h",
          "motion_blur/motion_blur_shared.h",
          "accumulate/accumulate_shared.h",
          "tonemap/tonemap_shared.h"})
        text += fmt::format("#include \"{}\"\n", header);
    text += fmt::format(
        "layout(local_size_x = 1) in;\n"
        "layout(binding = 0, scalar) buffer Block {{ {0} value; {0} next; }};\n"
        "void main() {{\n",
        type.name
    );
    for (const Member& member : type.members) {
        const std::string leaf = leafOf(type, member);
        text += fmt::format("    value.{0} = next.{0};\n", leaf);
    }
    return text + "}\n";
}

std::string readOutput(const std::string& command) {
    std::string output;
    const std::unique_ptr<std::FILE, int (*)(std::FILE*)> pipe(popen(command.c_str(), "r"), pclose);
    std::array<char, 4096> chunk{};
    while (pipe && std::fgets(chunk.data(), chunk.size(), pipe.get()))
        output += chunk.data();
    return output;
}

/// Offsets by "value.member" and "next.member", and the block's bytes under "".
std::map<std::string, size_t> reflect(const Struct& type) {
    const fs::path folder =
        fs::temp_directory_path() / fmt::format("shutter_layout_{}_{}", getpid(), type.name);
    fs::create_directories(folder);
    std::ofstream(folder / "layout.comp") << writeShader(type);
    const std::string output = readOutput(fmt::format(
        "'{}' -V --target-env vulkan1.3 -q '-I{}/shaders' -o '{}' '{}' 2>&1",
        SHUTTER_GLSLANG,
        SHUTTER_SOURCE_DIR,
        (folder / "layout.spv").string(),
        (folder / "layout.comp").string()
    ));
    fs::remove_all(folder);
    std::map<std::string, size_t> offsets;
    static const std::regex kMember(R"(([\w.\[\]]+): offset (\d+), type)");
    static const std::regex kBlock(R"(Block: offset -1, type \w+, size (\d+))");
    std::smatch block;
    if (std::regex_search(output, block, kBlock))
        offsets[""] = std::stoul(block[1]);
    for (std::sregex_iterator at(output.begin(), output.end(), kMember), end; at != end; ++at)
        offsets[(*at)[1].str()] = std::stoul((*at)[2]);
    EXPECT_FALSE(offsets.empty()) << output;
    return offsets;
}

class SharedLayout : public testing::TestWithParam<Struct> {
  protected:
    void SetUp() override {
        if (access(SHUTTER_GLSLANG, X_OK) != 0)
            GTEST_SKIP() << "glslang is not installed";
    }
};

} // namespace

TEST_P(SharedLayout, GlslPutsEveryMemberWhereCppDoes) {
    const Struct& type = GetParam();
    const std::map<std::string, size_t> offsets = reflect(type);
    for (const Member& member : type.members) {
        const std::string leaf = leafOf(type, member);
        // Without "[0]" where reflection names an array by its variable.
        const std::string bare = std::regex_replace(leaf, std::regex(R"(\[0\])"), "");
        const auto find = [&](const std::string& prefix) {
            const auto found = offsets.find(prefix + leaf);
            return found != offsets.end() ? found : offsets.find(prefix + bare);
        };
        const auto first = find("value.");
        const auto second = find("next.");
        ASSERT_TRUE(first != offsets.end() && second != offsets.end()) << leaf;
        EXPECT_EQ(first->second, member.offset) << leaf;
        EXPECT_EQ(second->second, type.bytes + member.offset) << leaf; // the stride
    }
    EXPECT_EQ(offsets.at(""), 2 * type.bytes);
}

TEST_P(SharedLayout, TheTableForgetsNoMemberAndNoPaddingIsHidden) {
    size_t end = 0;
    for (const Member& member : GetParam().members) {
        EXPECT_EQ(member.offset, end) << member.name;
        end = member.offset + member.bytes;
    }
    EXPECT_EQ(end, GetParam().bytes);
}

INSTANTIATE_TEST_SUITE_P(
    All,
    SharedLayout,
    testing::ValuesIn(listStructs()),
    [](const auto& instance) { return std::string(instance.param.name); }
);

} // namespace shutter::shader
