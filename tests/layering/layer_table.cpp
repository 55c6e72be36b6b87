// SPDX-License-Identifier: MIT
#include "tests/layering/layer_table.h"

#include <algorithm>
#include <array>
#include <filesystem>
#include <set>

namespace shutter::layering {

namespace {

using Names = std::set<std::string_view>;

/// Which folders of engine/ a part of the tree may see.
struct Row {
    std::string_view from;
    Names sees;
};

const Names kUpToRender = {
    "core",
    "math",
    "ecs",
    "gpu",
    "image",
    "graph",
    "scene",
    "environment",
    "io",
    "json",
    "gltf",
    "flythrough",
    "extract",
    "gpu_scene",
    "rays",
    "render"};

const std::vector<Row> kEngineRows = {
    {"core", {}},
    {"math", {"core"}},
    {"ecs", {"core", "math"}},
    {"gpu", {"core", "math"}},
    {"image", {"core", "math"}},
    {"graph", {"core", "math", "gpu"}},
    {"scene", {"core", "math", "ecs"}},
    {"environment", {"core", "math", "image", "scene"}},
    {"io", {"core", "math", "image", "scene"}},
    {"json", {"core", "io"}},
    {"gltf", {"core", "math", "ecs", "image", "scene", "environment", "io"}},
    {"flythrough", {"core", "math", "ecs", "scene", "json"}},
    {"extract", {"core", "math", "ecs", "scene"}},
    {"gpu_scene", {"core", "math", "gpu", "graph", "scene", "extract"}},
    {"rays", {"core", "math", "ecs", "gpu", "graph", "scene", "extract", "gpu_scene"}},
    {"render",
     {"core", "math", "ecs", "gpu", "image", "graph", "scene", "extract", "gpu_scene", "rays"}},
    {"app", kUpToRender},
};

/// Which rooms of the program a room may see; each sees all of engine/ and modules/, and none of
/// tests/.
const std::vector<Row> kGameRows = {
    {"shot", {}},
    {"output", {"shot"}},
    {"options", {"shot", "output"}},
    {"demos", {}},
    {"play/panel", {"shot", "demos"}},
    {"play/loop", {"shot", "output", "options", "demos", "play/panel"}},
    {"bench/report", {}},
    {"bench/suites", {"shot", "options"}},
    {"bench/sequence", {"shot", "options", "demos", "play/loop", "bench/suites"}},
    {"bench", {"shot", "options", "bench/report", "bench/suites", "bench/sequence"}},
    {"replay", {"shot", "output", "options"}},
    {"cli", {"shot", "output", "options", "play/panel", "play/loop", "replay"}},
    {"examples", {}},
};

/// Rooms that shaders/render belongs to: extraction on the CPU, device data, tracing and drawing
/// share the same shaders.
const Names kSceneRooms = {"extract", "gpu_scene", "rays", "render"};

/// The headers of a folder of engine/ that other folders may include, where some are private to it.
struct PublicHeaders {
    std::string_view folder;
    Names headers;
};

const std::vector<PublicHeaders> kPublicHeaders = {
    {"image", {"channels.h", "flip.h", "image.h", "metrics.h"}},
    {"graph", {"compile.h", "execute.h", "graph.h", "ray_scene.h", "transient_pool.h", "types.h"}},
    {"io", {"file_bytes.h", "image_file.h", "process.h", "uri.h", "video.h"}},
    {"json", {"json_file.h", "json_rows.h"}},
    {"gltf", {"gltf_loader.h"}},
};

/// A module that other engines may take without our scene: files outside of its plugin/ may include
/// this.
const Names kModulesWithEffect = {"motion_blur"};
const Names kEffectSees = {"core", "math", "gpu", "graph"};

/// Libraries that only some parts of the tree may name; "modules" means any module, "game" for all
/// of it.
struct LibraryRow {
    std::string_view prefix;
    Names owners;
};

const std::vector<LibraryRow> kLibraryRows = {
    {"tiny_gltf.h", {"gltf"}},
    {"OpenImageIO/", {"io"}},
    {"GLFW/", {"app"}},
    {"imgui", {"app", "game"}},
    {"vulkan/", {"gpu", "graph", "gpu_scene", "rays", "render", "modules"}},
};

enum class Kind { Unknown, Engine, Effect, Module, Game, Generator, Shaders, Tests };

/// The part of the tree a file belongs to. `name` is the folder below engine/, modules/, shaders/.
struct Part {
    Kind kind = Kind::Unknown;
    std::string name;
    bool isPlugin = false;

    bool operator==(const Part&) const = default;
};

const Row* findEngineRow(std::string_view folder) {
    const auto row = std::find_if(kEngineRows.begin(), kEngineRows.end(), [&](const Row& r) {
        return r.from == folder;
    });
    return row == kEngineRows.end() ? nullptr : &*row;
}

/// The room that a path below game/ lies in: the longest name that fits.
const Row* findGameRow(std::string_view path) {
    path.remove_prefix(std::string_view("game/").size());
    const Row* best = nullptr;
    for (const Row& row : kGameRows)
        if (path.starts_with(row.from) && path.substr(row.from.size()).starts_with('/') &&
            (best == nullptr || row.from.size() > best->from.size()))
            best = &row;
    return best;
}

/// The n-th component of a path, or nothing when that is its last one, the file name.
std::string folderAt(std::string_view path, size_t n) {
    for (; n > 0; --n) {
        const size_t slash = path.find('/');
        if (slash == std::string_view::npos)
            return {};
        path.remove_prefix(slash + 1);
    }
    const size_t slash = path.find('/');
    return slash == std::string_view::npos ? std::string() : std::string(path.substr(0, slash));
}

Part findPart(std::string_view path) {
    const std::string top = folderAt(path, 0);
    const std::string name = folderAt(path, 1);
    if (top == "engine" && findEngineRow(name) != nullptr)
        return {Kind::Engine, name};
    if (top == "modules" && !name.empty()) {
        const bool isPlugin = folderAt(path, 2) == "plugin";
        const bool isEffect = kModulesWithEffect.contains(name) && !isPlugin;
        return {isEffect ? Kind::Effect : Kind::Module, name, isPlugin};
    }
    if (top == "game") {
        const Row* room = findGameRow(path);
        return room ? Part{Kind::Game, std::string(room->from)} : Part{};
    }
    if (top == "assets" && name == "generator")
        return {Kind::Generator, {}};
    // Shaders made into headers (compiled, in double precision) belong to the folder they come
    // from.
    if ((top == "shaders" || top == "spirv" || top == "double") && !name.empty())
        return {Kind::Shaders, name};
    if (top == "tests")
        return {Kind::Tests, {}};
    return {};
}

std::string describe(const Part& part) {
    switch (part.kind) {
    case Kind::Engine:
        return part.name;
    case Kind::Effect:
        return "modules/" + part.name + " outside plugin/";
    case Kind::Module:
        return "modules/" + part.name + (part.isPlugin ? "/plugin" : "");
    case Kind::Game:
        return "game/" + part.name;
    case Kind::Generator:
        return "assets/generator";
    case Kind::Shaders:
        return "shaders/" + part.name;
    case Kind::Tests:
        return "tests";
    case Kind::Unknown:
        break;
    }
    return "a folder without a row in the layer table";
}

bool maySeeEngine(const Part& from, std::string_view folder) {
    switch (from.kind) {
    case Kind::Engine:
        return from.name == folder || findEngineRow(from.name)->sees.contains(folder);
    case Kind::Effect:
        return kEffectSees.contains(folder);
    case Kind::Module:
        return kUpToRender.contains(folder);
    case Kind::Game:
        return true;
    default:
        return false;
    }
}

bool maySeeModule(const Part& from, const Part& to) {
    if (from.kind == Kind::Game)
        return true;
    if (from.kind == Kind::Effect)
        return from.name == to.name && !to.isPlugin;
    return from.kind == Kind::Module && from.name == to.name;
}

bool maySeeRoom(const Part& from, const Part& to) {
    const auto row = std::find_if(kGameRows.begin(), kGameRows.end(), [&](const Row& r) {
        return r.from == from.name;
    });
    return row != kGameRows.end() && row->sees.contains(to.name);
}

bool isShared(std::string_view path) {
    return path.ends_with("_shared.h");
}

/// C++ takes shared headers, functions and compiled shaders, each from their owner or above it.
bool cppMaySeeShaders(const Part& from, const Part& to, std::string_view path) {
    if (from.kind == Kind::Generator || from.kind == Kind::Tests)
        return false;
    if (to.name == "common")
        return true;
    if (!isShared(path) && !path.ends_with(".glsl") && !path.starts_with("spirv/") &&
        !path.starts_with("double/"))
        return false;
    if (findEngineRow(to.name) == nullptr)
        return maySeeModule(from, Part{Kind::Module, to.name});
    // The effect alone reads what its shaders share with the renderer's, but runs no shader of it.
    if (from.kind == Kind::Effect)
        return isShared(path);
    if (to.name == "render" && from.kind == Kind::Engine && kSceneRooms.contains(from.name))
        return from.name != "extract" || !path.starts_with("spirv/");
    return maySeeEngine(from, to.name);
}

/// common, then render, then the modules' own.
bool shadersMaySee(const Part& from, const Part& to) {
    if (to.kind != Kind::Shaders)
        return false;
    if (from.name == to.name)
        return true;
    if (from.name == "common")
        return false;
    return to.name == "common" || (from.name != "render" && to.name == "render");
}

bool maySee(const Part& from, const Part& to, std::string_view path) {
    if (from == to)
        return true;
    if (from.kind == Kind::Shaders)
        return shadersMaySee(from, to);
    switch (to.kind) {
    case Kind::Engine:
        return maySeeEngine(from, to.name);
    case Kind::Effect:
    case Kind::Module:
        return maySeeModule(from, to);
    case Kind::Shaders:
        return cppMaySeeShaders(from, to, path);
    case Kind::Game:
        return from.kind == Kind::Game && maySeeRoom(from, to);
    case Kind::Generator:
        return from.kind == Kind::Game && from.name.starts_with("bench"); // it makes its scenes
    default:
        return false;
    }
}

bool isPrivateTo(const Part& to, std::string_view path) {
    if (to.kind != Kind::Engine)
        return false;
    const auto row =
        std::find_if(kPublicHeaders.begin(), kPublicHeaders.end(), [&](const PublicHeaders& r) {
            return r.folder == to.name;
        });
    if (row == kPublicHeaders.end())
        return false;
    return !row->headers.contains(path.substr(path.rfind('/') + 1));
}

/// The file an include means, from the repository root; empty for one that is not of this tree.
std::string resolve(const Include& include, const FileExists& exists) {
    namespace fs = std::filesystem;
    const std::string asWritten = fs::path(include.target).lexically_normal().generic_string();
    if (include.quoted) {
        const fs::path inFolder = fs::path(include.file).parent_path() / include.target;
        const std::string candidate = inFolder.lexically_normal().generic_string();
        if (exists(candidate))
            return candidate;
    }
    // A file that does not exist yet, or is generated, still determines its part of the tree.
    static const Names kTops = {
        "engine", "modules", "game", "assets", "shaders", "spirv", "double", "tests"};
    if (kTops.contains(folderAt(asWritten, 0)) || exists(asWritten))
        return asWritten;
    const std::string belowShaders = "shaders/" + asWritten;
    return exists(belowShaders) ? belowShaders : std::string();
}

/// Why a library may not be named there, or nothing.
std::optional<std::string> findLibraryViolation(const Part& from, std::string_view target) {
    const bool isModule = from.kind == Kind::Module || from.kind == Kind::Effect;
    const std::string_view owner = isModule                    ? "modules"
                                   : from.kind == Kind::Game   ? "game"
                                   : from.kind == Kind::Engine ? std::string_view(from.name)
                                                               : std::string_view();
    for (const LibraryRow& row : kLibraryRows)
        if (target.starts_with(row.prefix) && !row.owners.contains(owner))
            return describe(from) + " may not see " + std::string(row.prefix);
    return std::nullopt;
}

/// A separate project, built against the installed package: it may include installed and its own
/// headers.
bool isExample(std::string_view file) {
    return file.starts_with("game/examples/");
}

std::optional<std::string> findExampleViolation(std::string_view target) {
    for (const std::string_view folder : {"game/", "assets/", "tests/"})
        if (target.starts_with(folder))
            return "what lies in " + std::string(folder) + " is not installed";
    return std::nullopt;
}

std::optional<std::string> findReason(const Include& include, const FileExists& exists) {
    const Part from = findPart(include.file);
    if (from.kind == Kind::Unknown)
        return "the file lies in " + describe(from);
    if (include.target.empty())
        return "an include must name its file";
    if (isExample(include.file))
        return findExampleViolation(include.target);
    if (const auto reason = findLibraryViolation(from, include.target))
        return reason;
    const std::string path = resolve(include, exists);
    if (path.empty()) {
        if (include.quoted)
            return "not a file of this tree; write <" + include.target + "> if it is a library's";
        return std::nullopt;
    }
    const Part to = findPart(path);
    if (!(from == to) && isPrivateTo(to, path))
        return "the header is private to " + describe(to);
    if (maySee(from, to, path))
        return std::nullopt;
    return describe(from) + " may not see " + describe(to);
}

} // namespace

const std::vector<std::string_view>& engineFolders() {
    static const std::vector<std::string_view> folders = [] {
        std::vector<std::string_view> names;
        for (const Row& row : kEngineRows)
            names.push_back(row.from);
        return names;
    }();
    return folders;
}

std::optional<std::string> findViolation(const Include& include, const FileExists& exists) {
    const std::optional<std::string> reason = findReason(include, exists);
    if (!reason)
        return std::nullopt;
    return include.file + ":" + std::to_string(include.line) + " includes " +
           (include.target.empty() ? "a macro" : include.target) + ": " + *reason;
}

} // namespace shutter::layering
