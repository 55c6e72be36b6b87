// SPDX-License-Identifier: MIT
// The checker itself, on includes made up for it.
#include "tests/layering/layer_table.h"

#include <gtest/gtest.h>

#include <set>

using namespace shutter::layering;

namespace {

struct Case {
    std::string file;
    std::string directive; ///< what follows #include
};

/// The verdict on one include, in a tree where these files exist.
std::optional<std::string> judge(const Case& c) {
    static const std::set<std::string> files = {
        "engine/render/gbuffer.h",
        "engine/scene/world.h",
        "modules/tonemap/passes/a.h",
        "shaders/common/shim.h",
        "shaders/render/brdf.glsl",
        "shaders/render/scene_shared.h",
        "shaders/tonemap/curve.glsl",
        "shaders/motion_blur/tile.glsl",
        "assets/generator/textures.h",
    };
    const auto includes = readIncludes(c.file, "#include " + c.directive);
    EXPECT_EQ(includes.size(), 1u);
    return findViolation(includes.at(0), [](const std::string& f) { return files.contains(f); });
}

void expectRefused(const std::vector<Case>& cases) {
    for (const Case& c : cases)
        EXPECT_TRUE(judge(c).has_value()) << c.file << " includes " << c.directive;
}

void expectAllowed(const std::vector<Case>& cases) {
    for (const Case& c : cases)
        EXPECT_EQ(judge(c).value_or(""), "") << c.file << " includes " << c.directive;
}

} // namespace

TEST(LayerTable, AViolationIsOneLineThatNamesBothSides) {
    EXPECT_EQ(
        judge({"engine/render/renderer.cpp", "\"modules/tonemap/tonemap.h\""}),
        "engine/render/renderer.cpp:1 includes modules/tonemap/tonemap.h: render may not see "
        "modules/tonemap"
    );
    EXPECT_EQ(
        judge({"engine/core/log.h", "<GLFW/glfw3.h>"}),
        "engine/core/log.h:1 includes GLFW/glfw3.h: core may not see GLFW/"
    );
}

TEST(LayerTable, EngineFoldersSeeThoseBelowThem) {
    expectAllowed({
        {"engine/core/log.cpp", "\"engine/core/log.h\""},
        {"engine/core/log.cpp", "<vector>"},
        {"engine/core/log.cpp", "<fmt/format.h>"},
        {"engine/math/math.h", "\"engine/core/check.h\""},
        {"engine/ecs/registry.h", "\"engine/math/math.h\""},
        {"engine/graph/graph.h", "\"engine/gpu/device.h\""},
        {"engine/scene/world.h", "\"engine/ecs/registry.h\""},
        {"engine/gltf/gltf_loader.h", "\"engine/scene/world.h\""},
        {"engine/io/image_file.h", "\"engine/image/image.h\""},
        {"engine/gltf/gltf_loader.cpp", "\"engine/io/file_bytes.h\""},
        {"engine/json/json_file.cpp", "\"engine/io/file_bytes.h\""},
        {"engine/flythrough/flythrough.cpp", "\"engine/json/json_file.h\""},
        {"engine/flythrough/flythrough.h", "\"engine/scene/path.h\""},
        {"engine/extract/extracted_frame.h", "\"engine/scene/world.h\""},
        {"engine/extract/extracted_frame.h", "\"shaders/render/scene_shared.h\""},
        {"engine/gpu_scene/entity_table.h", "\"engine/extract/extracted_frame.h\""},
        {"engine/gpu_scene/deformer.cpp", "\"spirv/render/deform.comp.h\""},
        {"engine/rays/tlas.h", "\"engine/gpu_scene/gpu_scene.h\""},
        {"engine/render/renderer.h", "\"engine/rays/tlas.h\""},
        {"engine/render/renderer.h", "\"engine/graph/graph.h\""},
        {"engine/render/renderer.cpp", "\"gbuffer.h\""},
        {"engine/app/runner.cpp", "\"engine/render/renderer.h\""},
    });
}

TEST(LayerTable, EngineFoldersSeeNothingAboveThemAndNoSibling) {
    expectRefused({
        {"engine/core/log.h", "\"engine/math/math.h\""},
        {"engine/math/math.h", "\"engine/ecs/entity.h\""},
        {"engine/ecs/registry.h", "\"engine/gpu/device.h\""},
        {"engine/gpu/device.h", "\"engine/image/image.h\""},
        {"engine/image/image.h", "\"engine/ecs/entity.h\""},
        {"engine/graph/graph.h", "\"engine/ecs/entity.h\""},
        {"engine/graph/graph.h", "\"engine/scene/world.h\""},
        {"engine/scene/world.h", "\"engine/gpu/device.h\""},
        {"engine/scene/world.h", "\"engine/graph/graph.h\""},
        {"engine/scene/world.h", "\"engine/image/image.h\""},
        {"engine/gltf/gltf_loader.h", "\"engine/gpu/device.h\""},
        {"engine/gltf/gltf_loader.h", "\"engine/graph/graph.h\""},
        {"engine/gltf/gltf_loader.cpp", "\"engine/json/json_file.h\""},
        {"engine/io/file_bytes.h", "\"engine/json/json_file.h\""},
        {"engine/json/json_file.h", "\"engine/scene/world.h\""},
        {"engine/scene/path.h", "\"engine/flythrough/flythrough.h\""},
        {"engine/extract/extracted_frame.h", "\"engine/gpu/device.h\""},
        {"engine/extract/extracted_frame.h", "\"engine/graph/graph.h\""},
        {"engine/extract/extracted_frame.h", "\"engine/image/image.h\""},
        {"engine/extract/extracted_frame.h", "\"spirv/render/deform.comp.h\""},
        {"engine/gpu_scene/gpu_scene.h", "\"engine/rays/tlas.h\""},
        {"engine/rays/tlas.h", "\"engine/render/renderer.h\""},
        {"engine/render/renderer.h", "\"engine/io/image_file.h\""},
        {"engine/render/renderer.h", "\"engine/app/window.h\""},
        {"engine/app/runner.cpp", "\"modules/motion_blur/motion_blur.h\""},
        {"engine/app/runner.cpp", "\"game/cli/commands.h\""},
        {"engine/render/renderer.h", "\"tests/support/device.h\""},
        {"engine/render/renderer.h", "\"assets/generator/textures.h\""},
    });
}

TEST(LayerTable, PrivateHeadersAreSeenByTheirOwnFolderOnly) {
    expectAllowed({
        {"engine/gltf/gltf_mesh.cpp", "\"engine/gltf/gltf_parts.h\""},
        {"engine/json/json_file.cpp", "\"engine/json/json_tree.h\""},
        {"engine/io/image_file.cpp", "\"engine/io/oiio_codec.h\""},
        {"game/shot/shot.cpp", "\"engine/gltf/gltf_loader.h\""},
    });
    expectRefused({
        {"game/shot/shot.cpp", "\"engine/gltf/gltf_parts.h\""},
        {"game/shot/shot.cpp", "\"engine/json/json_tree.h\""},
        {"engine/gltf/gltf_material.cpp", "\"engine/io/oiio_codec.h\""},
    });
    EXPECT_EQ(
        judge({"game/shot/shot.cpp", "\"engine/gltf/gltf_new.h\""}),
        "game/shot/shot.cpp:1 includes engine/gltf/gltf_new.h: the header is private to gltf"
    );
}

TEST(LayerTable, AWayRoundIsSeenThrough) {
    expectRefused({
        {"engine/gpu/device.h", "\"../scene/world.h\""},
        {"engine/gpu/device.h", "\"engine/gpu/../scene/world.h\""},
        {"engine/gpu/device.h", "<engine/scene/world.h>"},
        {"engine/ecs/view.h", "\"render/brdf.glsl\""},
        {"engine/gpu/device.h", "SCENE_HEADER"},
        {"engine/gpu/device.h", "\"nowhere.h\""},
        {"engine/new_folder/a.h", "<vector>"},
    });
}

TEST(LayerTable, ModulesSeeRenderAndBelowButNeverEachOther) {
    expectAllowed({
        {"modules/tonemap/tonemap.cpp", "\"engine/render/renderer.h\""},
        {"modules/tonemap/tonemap.cpp", "\"engine/scene/world.h\""},
        {"modules/tonemap/tonemap.cpp", "\"modules/tonemap/tonemap.h\""},
        {"modules/tonemap/tonemap.cpp", "\"passes/a.h\""},
        {"game/cli/main.cpp", "\"modules/tonemap/tonemap.h\""},
        {"game/cli/main.cpp", "\"modules/motion_blur/plugin/plugin.h\""},
        {"game/cli/main.cpp", "\"engine/app/window.h\""},
    });
    expectRefused({
        {"modules/tonemap/tonemap.cpp", "\"engine/app/window.h\""},
        {"modules/tonemap/tonemap.cpp", "\"modules/motion_blur/motion_blur.h\""},
        {"modules/motion_blur/plugin/plugin.cpp", "\"modules/tonemap/tonemap.h\""},
        {"modules/tonemap/tonemap.cpp", "\"game/cli/commands.h\""},
    });
}

TEST(LayerTable, OnlyThePluginOfMotionBlurSeesTheScene) {
    for (const std::string header :
         {"ecs/a.h",
          "scene/a.h",
          "extract/a.h",
          "gpu_scene/a.h",
          "rays/a.h",
          "render/a.h",
          "io/image_file.h",
          "gltf/gltf_loader.h",
          "flythrough/a.h",
          "image/image.h"}) {
        const std::string directive = "\"engine/" + header + "\"";
        expectRefused({
            {"modules/motion_blur/motion_blur.h", directive},
            {"modules/motion_blur/passes/gather.cpp", directive},
        });
        expectAllowed({{"modules/motion_blur/plugin/plugin.h", directive}});
    }
    expectRefused({{"modules/motion_blur/motion_blur.h", "\"modules/motion_blur/plugin/p.h\""}});
    expectAllowed({
        {"modules/motion_blur/plugin/plugin.h", "\"modules/motion_blur/motion_blur.h\""},
        {"modules/motion_blur/motion_blur.h", "\"engine/graph/graph.h\""},
        {"modules/motion_blur/passes/gather.cpp", "\"engine/gpu/device.h\""},
        {"modules/motion_blur/passes/gather.cpp", "\"modules/motion_blur/motion_blur.h\""},
    });
}

TEST(LayerTable, RoomsOfTheProgramDependOneWay) {
    expectAllowed({
        {"game/output/film.cpp", "\"game/shot/shot.h\""},
        {"game/options/shot_arguments.cpp", "\"game/output/render_options.h\""},
        {"game/play/loop/play_loop.cpp", "\"game/play/panel/panel.h\""},
        {"game/bench/bench_run.cpp", "\"game/bench/suites/suite.h\""},
        {"game/bench/suites/scaling_suite.cpp", "\"assets/generator/scenes.h\""},
        {"game/cli/main.cpp", "\"game/play/loop/play_options.h\""},
    });
    expectRefused({
        {"game/shot/shot.cpp", "\"game/output/render_options.h\""},
        {"game/output/film.cpp", "\"game/options/render_arguments.h\""},
        {"game/play/panel/panel.cpp", "\"game/play/loop/play_loop.h\""},
        {"game/bench/suites/suite.cpp", "\"game/bench/bench_run.h\""},
        {"game/bench/bench_run.cpp", "\"game/play/panel/panel.h\""},
        {"game/cli/main.cpp", "\"game/bench/bench_run.h\""},
        {"game/shot/shot.cpp", "\"assets/generator/scenes.h\""},
        {"game/new_room/a.cpp", "\"engine/core/log.h\""},
        {"game/a.cpp", "\"engine/core/log.h\""},
    });
}

TEST(LayerTable, NothingOutsideOfTestsSeesATest) {
    expectRefused({
        {"engine/render/renderer.cpp", "\"tests/kit/scene_builder.h\""},
        {"modules/motion_blur/motion_blur.cpp", "\"tests/kit/graph_rig.h\""},
        {"modules/tonemap/tonemap.cpp", "\"tests/kit/graph_rig.h\""},
        {"game/shot/shot.cpp", "\"tests/support/stage.h\""},
        {"game/bench/suites/suite.h", "\"tests/conformance/demand/claim.h\""},
        {"game/examples/bare_renderer/main.cpp", "\"tests/kit/scene_builder.h\""},
        {"assets/generator/scenes.cpp", "\"tests/conformance/stability/shapes.h\""},
        {"shaders/render/gbuffer.frag", "\"tests/erring/erring_arithmetic.h\""},
    });
}

TEST(LayerTable, LibrariesStayWithTheirOwners) {
    expectAllowed({
        {"engine/gltf/gltf_loader.cpp", "<tiny_gltf.h>"},
        {"engine/io/oiio_codec.cpp", "<OpenImageIO/imageio.h>"},
        {"engine/app/window.cpp", "<GLFW/glfw3.h>"},
        {"engine/app/ui.cpp", "<imgui.h>"},
        {"game/play/panel/panel.cpp", "<imgui.h>"},
        {"engine/gpu/vulkan.h", "<vulkan/vulkan.h>"},
        {"engine/graph/graph.cpp", "<vulkan/vulkan.h>"},
        {"engine/render/gbuffer.cpp", "<vulkan/vulkan.h>"},
        {"modules/motion_blur/motion_blur.cpp", "<vulkan/vulkan.h>"},
    });
    expectRefused({
        {"engine/render/renderer.cpp", "<tiny_gltf.h>"},
        {"engine/io/image_file.cpp", "<tiny_gltf.h>"},
        {"engine/render/renderer.cpp", "\"tiny_gltf.h\""},
        {"engine/image/metrics.cpp", "<OpenImageIO/imageio.h>"},
        {"engine/gpu/device.cpp", "<GLFW/glfw3.h>"},
        {"game/cli/main.cpp", "<GLFW/glfw3.h>"},
        {"engine/render/renderer.cpp", "<imgui.h>"},
        {"modules/tonemap/tonemap.cpp", "<imgui_internal.h>"},
        {"engine/scene/world.h", "<vulkan/vulkan_core.h>"},
        {"engine/gltf/gltf_loader.cpp", "<vulkan/vulkan.h>"},
        {"shaders/common/shim.h", "<vulkan/vulkan.h>"},
    });
}

TEST(LayerTable, CppSeesTheShadersOfItsOwnFolderAndBelow) {
    expectAllowed({
        {"engine/math/math.h", "\"shaders/common/shim.h\""},
        {"engine/render/renderer.cpp", "\"shaders/render/scene_shared.h\""},
        {"engine/render/renderer.cpp", "\"shaders/render/brdf.glsl\""},
        {"engine/render/renderer.cpp", "\"spirv/render/gbuffer.vert.h\""},
        {"modules/tonemap/tonemap.cpp", "\"shaders/render/brdf.glsl\""},
        {"modules/tonemap/tonemap.cpp", "\"shaders/tonemap/tonemap_shared.h\""},
        {"modules/tonemap/tonemap.cpp", "\"spirv/tonemap/tonemap.comp.h\""},
        {"modules/motion_blur/motion_blur.cpp", "\"shaders/motion_blur/tile.glsl\""},
        {"modules/motion_blur/motion_blur.cpp", "\"shaders/render/scene_shared.h\""},
        {"game/cli/main.cpp", "\"shaders/tonemap/tonemap_shared.h\""},
    });
    expectRefused({
        {"engine/graph/graph.cpp", "\"shaders/render/scene_shared.h\""},
        {"engine/graph/graph.cpp", "\"spirv/render/gbuffer.vert.h\""},
        {"engine/render/renderer.cpp", "\"shaders/tonemap/tonemap_shared.h\""},
        {"engine/render/renderer.cpp", "\"shaders/render/gbuffer.frag\""},
        {"modules/tonemap/tonemap.cpp", "\"shaders/motion_blur/tile.glsl\""},
        {"modules/tonemap/tonemap.cpp", "\"spirv/motion_blur/tile.comp.h\""},
        {"modules/tonemap/tonemap.cpp", "\"double/motion_blur/taps.glsl.h\""},
        {"modules/motion_blur/motion_blur.cpp", "\"shaders/render/brdf.glsl\""},
        {"modules/motion_blur/motion_blur.cpp", "\"spirv/render/gbuffer.vert.h\""},
    });
}

TEST(LayerTable, ShadersSeeCommonThenRenderThenTheirOwn) {
    expectAllowed({
        {"shaders/common/shim.h", "<glm/glm.hpp>"},
        {"shaders/render/gbuffer.frag", "\"common/shim.h\""},
        {"shaders/render/gbuffer.frag", "\"render/brdf.glsl\""},
        {"shaders/tonemap/tonemap.comp", "\"common/shim.h\""},
        {"shaders/tonemap/tonemap.comp", "\"render/brdf.glsl\""},
        {"shaders/tonemap/tonemap.comp", "\"tonemap/curve.glsl\""},
        {"shaders/tonemap/tonemap.comp", "\"curve.glsl\""},
    });
    expectRefused({
        {"shaders/common/shim.h", "\"render/brdf.glsl\""},
        {"shaders/common/shim.h", "\"engine/math/math.h\""},
        {"shaders/render/brdf.glsl", "\"tonemap/curve.glsl\""},
        {"shaders/tonemap/tonemap.comp", "\"motion_blur/tile.glsl\""},
        {"shaders/tonemap/tonemap.comp", "\"shaders/motion_blur/tile.glsl\""},
        {"shaders/tonemap/tonemap.comp", "\"../motion_blur/tile.glsl\""},
        {"shaders/tonemap/tonemap.comp", "\"modules/tonemap/tonemap.h\""},
    });
}

TEST(LayerTable, ExamplesAreProjectsOfTheirOwn) {
    expectAllowed({
        {"game/examples/bare_renderer/main.cpp", "<vulkan/vulkan_raii.hpp>"},
        {"game/examples/new_effect/vignette.h", "<spirv/vignette.comp.h>"},
    });
    expectRefused({
        {"game/cli/main.cpp", "<vulkan/vulkan_raii.hpp>"},
        {"game/cli/main.cpp", "\"spirv/vignette.comp.h\""},
        {"game/examples/new_effect/main.cpp", "\"game/shot/shot.h\""},
        {"game/examples/new_effect/main.cpp", "\"tests/support/stage.h\""},
    });
}

TEST(LayerTable, TheAssetGeneratorSeesItselfAloneAndIsSeenByTheGameAlone) {
    expectAllowed({
        {"assets/generator/main.cpp", "\"assets/generator/textures.h\""},
        {"assets/generator/main.cpp", "\"textures.h\""},
        {"assets/generator/main.cpp", "<nlohmann/json.hpp>"},
    });
    expectAllowed({{"game/bench/suites/scaling_suite.cpp", "\"assets/generator/textures.h\""}});
    expectRefused({
        {"assets/generator/main.cpp", "\"engine/core/log.h\""},
        {"assets/generator/main.cpp", "\"shaders/common/shim.h\""},
        {"assets/generator/main.cpp", "\"modules/tonemap/tonemap.h\""},
        {"assets/generator/main.cpp", "\"game/cli/commands.h\""},
        {"modules/tonemap/tonemap.cpp", "\"assets/generator/textures.h\""},
    });
}
