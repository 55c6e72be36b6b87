// SPDX-License-Identifier: MIT
#include "engine/core/check.h"
#include "engine/environment/environment.h"
#include "modules/bloom/bloom.h"
#include "tests/conformance/demand/figures.h"

#include <fmt/format.h>

#include <algorithm>
#include <iterator>

namespace shutter::demand {

namespace {

using math::dvec3;

constexpr double kExposureSeconds = 1.0 / 48.0;
/// What a frame is made of does not depend on its size, unless that is tiny.
constexpr uint32_t kSmaller = 8;

/// What a scene of one floor and one ball is made of.
struct Content {
    bool hasSun = true;
    bool hasSolid = true; ///< the floor and the ball hold light back; else they are blended
    bool isSeen = true;   ///< the camera looks at them; else away from them
    bool moves = false;   ///< the ball
    bool hasEnvironment = false;
};

/// A picture of the content with the options under test against one without them.
struct Case {
    const char* name; ///< the options under test, and why they make no work
    Content content;
    void (*ask)(game::ShotArguments&);
    bool isFirst = true; ///< its first frame is looked at; else the one after
    /// The only pass that the frame cannot do without, which has one image; null: there is none.
    const char* pass = nullptr;
    double stepSeconds = 0.0; ///< from frame to frame
    bloom::BloomSettings bloom{};
};

void askNothing(game::ShotArguments&) {}

void askSharp(game::ShotArguments& arguments) {
    arguments.picture.shadows.mode = extract::ShadowMode::Sharp;
}

void askBlurred(game::ShotArguments& arguments) {
    arguments.picture.shadows.mode = extract::ShadowMode::Blurred;
}

void askUnlitShadows(game::ShotArguments& arguments) {
    arguments.picture.shadows.mode = extract::ShadowMode::Blurred;
    arguments.unlit = true;
}

void askUnlit(game::ShotArguments& arguments) {
    arguments.unlit = true;
}

void askTaa(game::ShotArguments& arguments) {
    arguments.picture.antiAliasing = game::AntiAliasing::Taa;
}

const Case kCases[] = {
    {.name = "taa where nothing moves, beyond taa itself",
     .content = {},
     .ask = askTaa,
     .isFirst = false,
     .pass = "'taa'"},
    {.name = "shadows without a light", .content = {.hasSun = false}, .ask = askBlurred},
    {.name = "shadows where nothing holds light back",
     .content = {.hasSolid = false},
     .ask = askBlurred},
    {.name = "shadows where nothing is in view", .content = {.isSeen = false}, .ask = askBlurred},
    {.name = "shadows of an unlit picture", .content = {}, .ask = askUnlitShadows},
    {.name = "sharp shadows where nothing moves, in the frame after",
     .content = {},
     .ask = askSharp,
     .isFirst = false},
    {.name = "blurred shadows where nothing moves, in the frame after",
     .content = {},
     .ask = askBlurred,
     .isFirst = false,
     .stepSeconds = scene::kStillFrameSeconds},
    {.name = "blurred shadows where only a blended ball moves",
     .content = {.hasSolid = false, .moves = true},
     .ask = askBlurred,
     .isFirst = false,
     .stepSeconds = scene::kStillFrameSeconds},
    {.name = "an environment, which the G-buffer draws",
     .content = {.hasEnvironment = true},
     .ask = askNothing},
    {.name = "an environment that an unlit picture leaves out",
     .content = {.hasEnvironment = true},
     .ask = askUnlit},
    {.name = "bloom that scatters no light", .content = {}, .ask = askNothing},
    {.name = "bloom where nothing is above its knee, in the frame after",
     .content = {},
     .ask = askNothing,
     .isFirst = false,
     .bloom = {.share = 0.1f, .threshold = 20.0f}},
};

scene::Environment makeGreySky() {
    image::Image picture(64, 32, 3);
    std::fill(picture.pixels.begin(), picture.pixels.end(), 0.5f);
    auto made = environment::makeEnvironment(std::move(picture), {});
    SHUTTER_CHECK(made.ok(), "a grey sky");
    return std::move(made).value();
}

std::unique_ptr<Stage> buildStage(const Case& wanted, bool isAsked) {
    const Content& content = wanted.content;
    test::SceneBuilder scene;
    scene.setPerspective(0.9);
    scene.moveCamera(
        {.position = dvec3(0.0, 2.0, 4.0),
         .rotation = glm::angleAxis(content.isSeen ? -0.45 : 2.0, dvec3(1, 0, 0))}
    );
    scene::Material material;
    if (!content.hasSolid) {
        material.alphaMode = scene::AlphaMode::Blend;
        material.baseColorFactor.w = 0.5f;
    }
    const auto used = scene.addMaterial(material);
    scene.add(
        test::makeQuad(8.0, 8.0, used),
        {.rotation = glm::angleAxis(-glm::radians(90.0), dvec3(1, 0, 0))}
    );
    test::Placement ball{.position = {0.0, 0.8, 0.0}};
    if (content.moves)
        ball.velocity = {1.0, 0.0, 0.0};
    scene.add(test::makeSphere(0.5, used), ball);
    if (content.hasSun)
        scene.addSun({-0.5, -1.0, -0.4}, 3.0f);
    if (content.hasEnvironment && isAsked)
        scene.world.assets.environment = makeGreySky();
    auto stage = makeStage(std::move(scene), kExposureSeconds);
    if (isAsked)
        wanted.ask(stage->arguments);
    else
        stage->arguments.unlit = wanted.ask == askUnlitShadows || wanted.ask == askUnlit;
    return stage;
}

core::Result<GraphParts>
drawParts(gpu::Device& device, const DemandOptions& options, const Case& wanted, bool isAsked) {
    const auto stage = buildStage(wanted, isAsked);
    const uint32_t width = std::max(options.width / kSmaller, 64u);
    const uint32_t height = std::max(options.height / kSmaller, 64u);
    auto subject = isAsked ? Subject::createWithEffect(
                                 device,
                                 *stage,
                                 std::make_unique<bloom::Bloom>(device, wanted.bloom),
                                 width,
                                 height
                             )
                           : Subject::create(device, *stage, "sharp", width, height);
    if (!subject)
        return subject.error();
    subject.value()->setStep(wanted.stepSeconds);
    subject.value()->setDump(true);
    if (!wanted.isFirst)
        if (auto before = subject.value()->draw(); !before)
            return before.error();
    auto frame = subject.value()->draw();
    if (!frame)
        return frame.error();
    return readDump(frame.value().dump);
}

core::Status
addCase(Findings& findings, gpu::Device& device, const DemandOptions& options, const Case& wanted) {
    auto plain = drawParts(device, options, wanted, false);
    if (!plain)
        return plain.error();
    auto asked = drawParts(device, options, wanted, true);
    if (!asked)
        return asked.error();
    std::vector<std::string> passes = asked.value().passes;
    if (wanted.pass != nullptr)
        std::erase_if(passes, [&](const std::string& line) {
            return line.starts_with(wanted.pass);
        });
    // Lines say how long images live, which a pass of its own changes: there, they are counted.
    const GraphParts& with = asked.value();
    const GraphParts& without = plain.value();
    const size_t images =
        wanted.pass == nullptr
            ? countBeyond(with.images, without.images)
            : with.images.size() - std::min(with.images.size(), without.images.size() + 1);
    const auto add = [&](const char* check, uint64_t found, uint64_t samples) {
        findings.counts.push_back(
            {fmt::format("{}: {}", wanted.name, check), double(found), 0.0, "", samples}
        );
    };
    add("passes", countBeyond(passes, without.passes), with.passes.size());
    add("images", images, asked.value().images.size());
    return {};
}

core::Result<Findings> measureLit(gpu::Device& device, const DemandOptions& options) {
    Findings findings;
    for (const Case& wanted : kCases)
        SHUTTER_TRY(addCase(findings, device, options, wanted));
    return findings;
}

} // namespace

Claim makeLitClaim() {
    return {
        "Lit",
        "Light costs what it does",
        "Frames with shadows, anti-aliasing, an environment or bloom asked for where the scene has "
        "no use for them against frames without: what they are made of.",
        measureLit};
}

} // namespace shutter::demand
