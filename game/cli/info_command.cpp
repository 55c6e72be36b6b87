// SPDX-License-Identifier: MIT
#include "engine/core/words.h"
#include "engine/gltf/gltf_loader.h"
#include "engine/gpu/device_select.h"
#include "engine/scene/camera.h"
#include "game/cli/commands.h"
#include "game/options/program.h"
#include "game/play/panel/play_settings.h"
#include "game/shot/clips.h"
#include "game/shot/methods.h"
#include "game/shot/picture_features.h"

#include <CLI/CLI.hpp>
#include <fmt/format.h>

#include <cstdio>
#include <memory>
#include <string>
#include <vector>

namespace shutter::game {

namespace {

struct InfoArguments {
    std::string scene;
    bool allowOutside = false;
    bool devices = false;
    bool methods = false;
    bool schema = false;
};

std::string nameOrIndex(const std::string& name, size_t index) {
    return name.empty() ? std::to_string(index) : name;
}

core::Status printDevices() {
    SHUTTER_TRY(gpu::loadVulkan());
    VkApplicationInfo application{VK_STRUCTURE_TYPE_APPLICATION_INFO};
    application.apiVersion = VK_API_VERSION_1_3;
    VkInstanceCreateInfo info{VK_STRUCTURE_TYPE_INSTANCE_CREATE_INFO};
    info.pApplicationInfo = &application;
    std::vector<const char*> extensions;
    gpu::listPortableDrivers(info.flags, extensions);
    info.enabledExtensionCount = static_cast<uint32_t>(extensions.size());
    info.ppEnabledExtensionNames = extensions.data();
    VkInstance instance = VK_NULL_HANDLE;
    gpu::require(vkCreateInstance(&info, nullptr, &instance), "creating the Vulkan instance");
    const auto devices = gpu::listDevices(instance);
    for (size_t i = 0; i < devices.size(); ++i)
        fmt::print(
            "{}: {} ({}, {}), rays: {}{}\n",
            i,
            devices[i].name,
            devices[i].kind,
            devices[i].driver,
            gpu::describeTiers(devices[i]),
            devices[i].missing.empty() ? "" : ", unusable: lacks " + devices[i].missing
        );
    vkDestroyInstance(instance, nullptr);
    if (devices.empty())
        return core::makeError("no Vulkan device was found");
    return {};
}

core::Status printScene(const std::string& path, io::Reach reach) {
    auto loaded = gltf::loadGltf(path, {.reach = reach}, listExtraReaders());
    if (!loaded)
        return loaded.error();
    const scene::World& world = loaded.value().world;
    uint64_t drawn = 0;
    uint64_t instances = 0;
    uint64_t lights = 0;
    for (auto [entity, instance] : world.registry.view<scene::MeshInstance>()) {
        (void)entity;
        ++instances;
        for (const auto& primitive : world.assets.meshes[instance.mesh].primitives)
            drawn += primitive.indices.size() / 3;
    }
    for (auto [entity, light] : world.registry.view<scene::Light>()) {
        (void)entity;
        (void)light;
        ++lights;
    }
    fmt::print(
        "entities {}, drawn {}, triangles drawn {}\nmeshes {}, materials {}, textures {}, lights "
        "{}\n",
        world.registry.aliveCount(),
        instances,
        drawn,
        world.assets.meshes.size(),
        world.assets.materials.size(),
        world.assets.textures.size(),
        lights
    );
    const math::Bounds bounds = scene::computeWorldBounds(world, 0.0);
    if (!bounds.isEmpty())
        fmt::print(
            "bounds {:.4g} {:.4g} {:.4g} to {:.4g} {:.4g} {:.4g} m\n",
            bounds.min.x,
            bounds.min.y,
            bounds.min.z,
            bounds.max.x,
            bounds.max.y,
            bounds.max.z
        );
    for (size_t i = 0; i < world.cameras.size(); ++i) {
        const auto& camera = world.registry.get<scene::Camera>(world.cameras[i]);
        const auto* name = world.registry.find<scene::Name>(world.cameras[i]);
        fmt::print("camera {}: '{}' at node '{}'\n", i, camera.name, name ? name->value : "");
    }
    for (uint32_t i = 0; i < world.assets.clips.size(); ++i) {
        const scene::AnimationClip& clip = world.assets.clips[i];
        fmt::print(
            "clip {}: {:.4g} s, {}\n",
            describeClip(world, i),
            clip.duration,
            core::countOf(clip.channels.size() + clip.weightChannels.size(), "channel")
        );
    }
    const auto& skins = world.assets.skins;
    for (size_t i = 0; i < skins.size(); ++i)
        fmt::print(
            "skin {}: {}\n",
            nameOrIndex(skins[i].name, i),
            core::countOf(skins[i].jointFromBind.size(), "joint")
        );
    const auto& meshes = world.assets.meshes;
    for (size_t i = 0; i < meshes.size(); ++i)
        if (!meshes[i].morphWeights.empty())
            fmt::print(
                "mesh {}: {}\n",
                nameOrIndex(meshes[i].name, i),
                core::countOf(meshes[i].morphWeights.size(), "morph target")
            );
    for (const std::string& warning : loaded.value().warnings)
        fmt::print("warning: {}\n", warning);
    if (const std::string resting = describeRestingClips(world); !resting.empty())
        fmt::print("{}: {}\n", path, resting);
    return {};
}

int runInfo(const InfoArguments& arguments) {
    if (arguments.scene.empty() && !arguments.devices && !arguments.methods && !arguments.schema) {
        fmt::print(stderr, "shutter: info needs a SCENE, --devices, --methods or --schema\n");
        return kExitUsage;
    }
    if (arguments.methods)
        for (const MethodInfo& method : listMethods())
            fmt::print("{}\n", method.name);
    if (arguments.schema)
        fmt::print("{}\n", makeSettingsSchema());
    core::Status done;
    if (arguments.devices)
        done = printDevices();
    if (done && !arguments.scene.empty())
        done = printScene(
            arguments.scene, arguments.allowOutside ? io::Reach::Anywhere : io::Reach::Folder
        );
    if (!done)
        printError(done.error());
    return done ? kExitDone : kExitFailed;
}

} // namespace

void addInfoCommand(CLI::App& app, int& exitStatus) {
    CLI::App* command = app.add_subcommand(
        "info", "what a scene holds, what a device can do, which methods there are"
    );
    auto arguments = std::make_shared<InfoArguments>();
    command->add_option("scene", arguments->scene, "glTF 2.0 scene");
    command->add_flag(
        "--allow-outside",
        arguments->allowOutside,
        "allow the scene to read files outside its folder"
    );
    command->add_flag("--devices", arguments->devices, "list the Vulkan devices");
    command->add_flag("--methods", arguments->methods, "list the methods, one per line");
    command->add_flag(
        "--schema", arguments->schema, "print the JSON schema of the settings of `play`"
    );
    command->callback([arguments, &exitStatus] { exitStatus = runInfo(*arguments); });
}

} // namespace shutter::game
