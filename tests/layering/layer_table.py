# SPDX-License-Identifier: MIT
"""The order of dependence as a table: core -> math -> {ecs | gpu | image} -> {graph | scene} -> io ->
render -> {app | modules} -> game. Lower never sees higher, siblings never see each other."""

import posixpath
from dataclasses import dataclass


def read_rows(rows):
    return {name: frozenset(sees.split()) for name, sees in rows.items()}


UP_TO_RENDER = frozenset(
    "core math ecs gpu image graph scene environment io json gltf flythrough extract gpu_scene rays render"
    .split())

# Which folders of engine/ each of them may see, lowest first.
ENGINE = read_rows({
    "core": "",
    "math": "core",
    "ecs": "core math",
    "gpu": "core math",
    "image": "core math",
    "graph": "core math gpu",
    "scene": "core math ecs",
    "environment": "core math image scene",
    "io": "core math image scene",
    "json": "core io",
    "gltf": "core math ecs image scene environment io",
    "flythrough": "core math ecs scene json",
    "extract": "core math ecs scene",
    "gpu_scene": "core math gpu graph scene extract",
    "rays": "core math ecs gpu graph scene extract gpu_scene",
    "render": "core math ecs gpu image graph scene extract gpu_scene rays",
}) | {"app": UP_TO_RENDER}

# Which rooms of the program a room may see; each sees all of engine/ and modules/, and none of tests/.
GAME = read_rows({
    "shot": "",
    "output": "shot",
    "options": "shot output",
    "demos": "",
    "play/panel": "shot demos",
    "play/loop": "shot output options demos play/panel",
    "bench/report": "",
    "bench/suites": "shot options",
    "bench/sequence": "shot options demos play/loop bench/suites",
    "bench": "shot options bench/report bench/suites bench/sequence",
    "replay": "shot output options",
    "blur": "shot output options replay",
    "cli": "shot output options play/panel play/loop replay blur",
    "examples": "",
})

# Rooms that shaders/render belongs to: extraction on the CPU, device data, tracing and drawing share
# the same shaders.
SCENE_ROOMS = {"extract", "gpu_scene", "rays", "render"}

# The headers of a folder of engine/ that other folders may include, where some are private to it.
PUBLIC_HEADERS = read_rows({
    "image": "channels.h flip.h image.h metrics.h",
    "graph": "compile.h execute.h graph.h ray_scene.h transient_pool.h types.h",
    "io": "file_bytes.h image_file.h process.h uri.h video.h",
    "json": "json_file.h json_rows.h",
    "gltf": "extras.h gltf_loader.h",
})

# Modules that other engines may take without our scene: files outside of plugin/ may include this.
MODULES_WITH_EFFECT = {"motion_blur"}
EFFECT_SEES = {"core", "math", "gpu", "graph"}

# Libraries that only some parts of the tree may name; "modules" means any module, "game" all of it.
LIBRARIES = read_rows({
    "tiny_gltf.h": "gltf",
    "OpenImageIO/": "io",
    "GLFW/": "app",
    "imgui": "app game",
    "vulkan/": "gpu graph gpu_scene rays render modules",
})


@dataclass(frozen=True)
class Part:
    """The part of the tree that a file belongs to. `name` is the folder below engine/, modules/ or
    shaders/; an effect is a module outside of plugin/ that other engines may take."""

    kind: str
    name: str = ""
    is_plugin: bool = False

    def __str__(self):
        if self.kind == "engine":
            return self.name
        if self.kind == "effect":
            return f"modules/{self.name} outside plugin/"
        if self.kind == "modules":
            return f"modules/{self.name}" + ("/plugin" if self.is_plugin else "")
        return f"{self.kind}/{self.name}" if self.name else self.kind


def find_room(path):
    """The room that a path below game/ lies in: the longest name that fits."""
    fitting = [room for room in GAME if path.startswith(f"game/{room}/")]
    return max(fitting, key=len, default=None)


def find_part(path):
    """None: the file lies in a folder without a row."""
    top, name, below, *_ = [*path.split("/")[:-1], "", "", ""]
    if top == "engine" and name in ENGINE:
        return Part("engine", name)
    if top == "modules" and name:
        is_plugin = below == "plugin"
        is_effect = name in MODULES_WITH_EFFECT and not is_plugin
        return Part("effect" if is_effect else "modules", name, is_plugin)
    if top == "game":
        room = find_room(path)
        return Part("game", room) if room else None
    if (top, name) == ("assets", "generator"):
        return Part("assets/generator")
    # Shaders made into headers (compiled, in double precision) belong to the folder they come from.
    if top in ("shaders", "spirv", "double") and name:
        return Part("shaders", name)
    return Part("tests") if top == "tests" else None


def may_see_engine(part, folder):
    if part.kind == "engine":
        return part.name == folder or folder in ENGINE[part.name]
    seen = {"effect": EFFECT_SEES, "modules": UP_TO_RENDER, "game": ENGINE}
    return folder in seen.get(part.kind, ())


def may_see_module(part, to):
    if part.kind == "effect":
        return part.name == to.name and not to.is_plugin
    return part.kind == "game" or (part.kind == "modules" and part.name == to.name)


def cpp_may_see_shaders(part, to, path):
    """C++ takes shared headers, functions and compiled shaders, each from their owner or above it."""
    is_shared = path.endswith("_shared.h")
    if part.kind in ("assets/generator", "tests"):
        return False
    if to.name == "common":
        return True
    if not (is_shared or path.endswith(".glsl") or path.startswith(("spirv/", "double/"))):
        return False
    if to.name not in ENGINE:
        return may_see_module(part, Part("modules", to.name))
    # The effect alone reads what its shaders share with the renderer's, but runs no shader of it.
    if part.kind == "effect":
        return is_shared
    if to.name == "render" and part.kind == "engine" and part.name in SCENE_ROOMS:
        return part.name != "extract" or not path.startswith("spirv/")
    return may_see_engine(part, to.name)


# Composes what features add to shading, since GLSL has no late binding.
SHADING_ROOT, SHADING_FEATURES = "shaders/render/shading.glsl", {"shadows"}


def shaders_may_see(part, to, file):
    """common, then render, then the modules' own."""
    if to.kind != "shaders":
        return False
    if file == SHADING_ROOT and to.name in SHADING_FEATURES:
        return True
    return part.name == to.name or (
        part.name != "common" and (to.name == "common" or (to.name == "render" != part.name)))


def may_see(part, to, path, file):
    if part == to:
        return True
    if to is None:
        return False
    if part.kind == "shaders":
        return shaders_may_see(part, to, file)
    if to.kind == "engine":
        return may_see_engine(part, to.name)
    if to.kind in ("effect", "modules"):
        return may_see_module(part, to)
    if to.kind == "shaders":
        return cpp_may_see_shaders(part, to, path)
    if part.kind != "game":
        return False
    if to.kind == "assets/generator":
        return part.name.startswith("bench")  # it makes its scenes
    return to.kind == "game" and to.name in GAME[part.name]


def resolve(include, is_file):
    """The file that an include means, from the repository root; None: it is not of this tree. An
    include is searched in its file's folder, from the root and from shaders/, as compilers do."""
    if include.quoted:
        beside = posixpath.normpath(posixpath.join(posixpath.dirname(include.file), include.target))
        if is_file(beside):
            return beside
    path = posixpath.normpath(include.target)
    # A file that does not exist yet, or is generated, still determines its part of the tree.
    tops = ("engine/", "modules/", "game/", "assets/", "shaders/", "spirv/", "double/", "tests/")
    for candidate in (path, f"shaders/{path}"):
        if path.startswith(tops) or is_file(candidate):
            return candidate
    return None


def find_library_fault(part, target):
    owner = {"effect": "modules", "engine": part.name}.get(part.kind, part.kind)
    for prefix, owners in LIBRARIES.items():
        if target.startswith(prefix) and owner not in owners:
            return f"{part} may not see {prefix}"
    return None


def find_reason(include, is_file):
    part = find_part(include.file)
    if part is None:
        return "the file lies in a folder without a row in the layer table"
    if not include.target:
        return "an include must name its file"
    # The examples are separate projects, built against the installed package.
    if part == Part("game", "examples"):
        is_ours = include.target.startswith(("game/", "assets/", "tests/"))
        return "what lies there is not installed" if is_ours else None
    if fault := find_library_fault(part, include.target):
        return fault
    path = resolve(include, is_file)
    if path is None:
        advice = f"not a file of this tree; write <{include.target}> if it is a library's"
        return advice if include.quoted else None
    to = find_part(path)
    if to != part and to and to.kind == "engine" and to.name in PUBLIC_HEADERS:
        if posixpath.basename(path) not in PUBLIC_HEADERS[to.name]:
            return f"the header is private to {to}"
    if may_see(part, to, path, include.file):
        return None
    return f"{part} may not see {to or 'a folder without a row in the layer table'}"


def find_violation(include, is_file):
    """"file:line includes X: why not", or None where the table allows it.
    \\param is_file whether a path from the repository root is a file there"""
    reason = find_reason(include, is_file)
    return reason and f"{include.file}:{include.line} includes {include.target or 'a macro'}: {reason}"
