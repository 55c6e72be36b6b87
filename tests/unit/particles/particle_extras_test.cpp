// SPDX-License-Identifier: MIT
// `extras.particles` of a node.
#include "engine/gltf/gltf_loader.h"
#include "modules/particles/particle_emitter.h"
#include "modules/particles/particle_extras.h"
#include "tests/support/outcomes.h"
#include "tests/support/temp_folder.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <ranges>
#include <string>
#include <utility>
#include <vector>

namespace shutter::particles {
namespace {

using math::dvec3;
using test::expectRefused;

/// Loads a file that holds nothing but `members`.
core::Result<gltf::LoadedScene> loadMembers(const std::string& members) {
    const test::TempFolder folder;
    const std::string json = R"({"asset":{"version":"2.0"},)" + members + "}";
    return gltf::loadGltf(folder.write("test.gltf", json), {}, {&kParticleExtras, 1});
}

core::Result<gltf::LoadedScene> loadExtras(const std::string& extras) {
    return loadMembers(
        R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"name":"it","extras":)" + extras + "}]"
    );
}

/// The only one.
const ParticleEmitter* findEmitter(const gltf::LoadedScene& loaded) {
    const ParticleEmitter* only = nullptr;
    for (auto [entity, emitter] : loaded.world.registry.view<ParticleEmitter>()) {
        EXPECT_EQ(only, nullptr) << "there are several";
        only = &emitter;
    }
    return only;
}

TEST(ParticleExtras, AnEmitterIsReadWithAllItsMembers) {
    const gltf::LoadedScene loaded = test::valueOf(loadExtras(
        R"({"particles":{"spans":[{"fromSeconds":1,"untilSeconds":2,"perSecond":30}],)"
        R"("bursts":[{"seconds":3,"count":4}],"lifeSeconds":5,"lifeSpread":0.5,)"
        R"("velocity":[1,2,3],"coneDegrees":20,"speedSpread":0.25,"inherit":0.75,"radius":6,)"
        R"("gravity":[0,-9.81,0],"drag":0.5,"sizeBirth":0.125,"spin":7,)"
        R"("colors":[[1,2,3,0.5],[4,5,6,1],[7,8,9,0]],"blend":"add","softMetres":0.75,)"
        R"("lit":true,"seed":9}})"
    ));
    EXPECT_TRUE(loaded.warnings.empty());
    const auto* emitter = findEmitter(loaded);
    ASSERT_TRUE(emitter);
    ASSERT_EQ(emitter->spans.size(), 1u);
    EXPECT_EQ(emitter->spans[0].fromSeconds, 1.0);
    EXPECT_EQ(emitter->spans[0].untilSeconds, 2.0);
    EXPECT_EQ(emitter->spans[0].perSecond, 30.0);
    ASSERT_EQ(emitter->bursts.size(), 1u);
    EXPECT_EQ(emitter->bursts[0].seconds, 3.0);
    EXPECT_EQ(emitter->bursts[0].count, 4u);
    EXPECT_EQ(emitter->lifeSeconds, 5.0);
    EXPECT_EQ(emitter->lifeSpread, 0.5);
    EXPECT_EQ(emitter->velocity, dvec3(1, 2, 3));
    EXPECT_EQ(emitter->coneDegrees, 20.0);
    EXPECT_EQ(emitter->speedSpread, 0.25);
    EXPECT_EQ(emitter->inherit, 0.75);
    EXPECT_EQ(emitter->radius, 6.0);
    EXPECT_EQ(emitter->gravity, dvec3(0, -9.81, 0));
    EXPECT_EQ(emitter->drag, 0.5);
    EXPECT_EQ(emitter->sizeBirth, 0.125);
    EXPECT_EQ(emitter->sizeDeath, 0.125) << "none is given: it keeps its size";
    EXPECT_EQ(emitter->spin, 7.0);
    EXPECT_EQ(emitter->colors[1], math::vec4(4, 5, 6, 1));
    EXPECT_EQ(emitter->texture, scene::kNone);
    EXPECT_EQ(emitter->blend, ParticleBlend::Add);
    EXPECT_EQ(emitter->softMetres, 0.75);
    EXPECT_TRUE(emitter->lit);
    EXPECT_EQ(emitter->seed, 9u);
}

TEST(ParticleExtras, BadValuesAreRefusedByName) {
    const std::pair<const char*, const char*> cases[] = {
        {R"(3)", ""},
        {R"({"spans":{"a":1}})", ".spans is not an array"},
        {R"({"spans":[1]})", ".spans[0] is not an object"},
        {R"({"spans":[{"perSecond":-1}]})", "spans[0].perSecond"},
        {R"({"spans":[{"fromSeconds":"now"}]})", ".spans[0].fromSeconds"},
        {R"({"spans":[{"perSecond":1},{"perSecond":1}]})", "spans[1] begins"},
        {R"({"bursts":[{"count":1.5}]})", ".bursts[0].count"},
        {R"({"lifeSeconds":0})", "lifeSeconds"},
        {R"({"lifeSpread":1})", "lifeSpread"},
        {R"({"velocity":[1,2]})", ".velocity"},
        {R"({"colors":[[1,1,1,1]]})", ".colors is not an array of 3"},
        {R"({"colors":[[1,1,1],[1,1,1,1],[1,1,1,1]]})", ".colors[0]"},
        {R"({"colors":[[1,1,1,1],[1,1,1,2],[1,1,1,1]]})", "colors[1]"},
        {R"({"texture":0})", ".texture is 0, but there are 0 textures"},
        {R"({"blend":"screen"})", ".blend is none of 'alpha', 'add'"},
        {R"({"lit":1})", ".lit"},
        {R"({"seed":-1})", ".seed"}};
    for (const auto& [member, part] : cases) {
        SCOPED_TRACE(member);
        const auto loaded = loadExtras("{\"particles\":" + std::string(member) + "}");
        expectRefused(loaded, "nodes[0].extras.particles");
        expectRefused(loaded, part);
    }
}

TEST(ParticleExtras, UnknownMembersAreWarnedOf) {
    const auto warnings =
        test::valueOf(
            loadExtras(R"({"particles":{"speed":1,"spans":[{"rate":2}],"bursts":[{"size":1}]}})")
        )
            .warnings;
    ASSERT_EQ(warnings.size(), 3u);
    EXPECT_NE(warnings[0].find("'speed'"), std::string::npos);
}

TEST(ParticleExtras, WithoutAReaderTheyAreAnotherProgramsExtras) {
    const test::TempFolder folder;
    const auto loaded = test::valueOf(gltf::loadGltf(folder.write(
        "test.gltf",
        R"({"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],)"
        R"("nodes":[{"extras":{"particles":{"seed":-1}}}]})"
    )));
    EXPECT_EQ(findEmitter(loaded), nullptr);
    EXPECT_TRUE(loaded.warnings.empty());
}

// A 1x1 RGBA PNG of (200, 100, 50, 128).
constexpr const char* kPng = "data:image/png;base64,"
                             "iVBORw0KGgoAAAANSUhEUgAAAAEAAAABCAYAAAAfFcSJAAAA"
                             "DUlEQVR4nGM4kWLUAAAFNQHfc2Lj2wAAAABJRU5ErkJggg==";

std::string picture() {
    return fmt::format(R"({{"uri":"{}"}})", kPng);
}

std::string oneTexture() {
    return fmt::format(R"("images":[{}],"textures":[{{"source":0}}])", picture());
}

/// A scene of one node that emits particles with this texture.
std::string emitting(const std::string& texture) {
    return R"("scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"extras":{"particles":{"texture":)" +
           texture + "}}}]";
}

TEST(ParticleExtras, APictureThatParticlesAloneShowIsRead) {
    const std::string textures = fmt::format(
        R"("images":[{{"uri":"none.png"}},{}],"textures":[{{"source":0}},{{"source":1}}],)",
        picture()
    );
    const gltf::LoadedScene alone = test::valueOf(loadMembers(textures + emitting("1")));
    const scene::Assets& assets = alone.world.assets;
    ASSERT_EQ(assets.textures.size(), 1u) << "the other one is not opened";
    EXPECT_TRUE(assets.textures[0].isLoose);
    EXPECT_EQ(
        assets.images.at(assets.textures[0].image).rgba, (std::vector<uint8_t>{200, 100, 50, 128})
    );
    EXPECT_EQ(findEmitter(alone)->texture, 0u);
    // A material's own is shared.
    const gltf::LoadedScene shared = test::valueOf(
        loadMembers(textures + emitting("1") + R"(,"materials":[{"emissiveTexture":{"index":1}}])")
    );
    ASSERT_EQ(shared.world.assets.textures.size(), 1u);
    EXPECT_TRUE(shared.world.assets.textures[0].isLoose);
    EXPECT_EQ(findEmitter(shared)->texture, 0u);
}

TEST(ParticleExtras, APictureThatIsNotThereIsRefusedByName) {
    const std::string at = "nodes[0].extras.particles.texture";
    expectRefused(
        loadMembers(oneTexture() + "," + emitting("1")), at + " is 1, but there is 1 texture"
    );
    for (const char* wrong : {"-1", "0.5", "1e12", "\"puff\"", "[0]"})
        expectRefused(loadMembers(oneTexture() + "," + emitting(wrong)), at);
    expectRefused(
        loadMembers(R"("images":[{"uri":"none.png"}],"textures":[{"source":0}],)" + emitting("0")),
        "none.png"
    );
    // As a material does, they go without one that names no picture.
    const gltf::LoadedScene without =
        test::valueOf(loadMembers(R"("textures":[{}],)" + emitting("0")));
    EXPECT_EQ(findEmitter(without)->texture, scene::kNone);
    EXPECT_TRUE(std::ranges::any_of(without.warnings, [](const std::string& one) {
        return one.find("textures[0]") != std::string::npos;
    }));
}

} // namespace
} // namespace shutter::particles
