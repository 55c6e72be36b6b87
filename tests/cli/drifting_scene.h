// SPDX-License-Identifier: MIT
#pragma once

namespace shutter::cli {

/// A triangle that drifts three metres in a second, and no camera: one made to fit depends on when
/// it is made. glTF, to be written to a file.
inline constexpr const char* kDriftingScene =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
        "nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 2, "type": "SCALAR",
             "min": [0], "max": [1]},
            {"bufferView": 2, "componentType": 5126, "count": 2, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 8},
            {"buffer": 0, "byteOffset": 44, "byteLength": 24}],
        "animations": [{"name": "drift", "samplers": [{"input": 1, "output": 2}],
            "channels": [{"sampler": 0, "target": {"node": 0, "path": "translation"}}]}],
        "buffers": [{"byteLength": 68, "uri": "data:application/octet-stream;base64,)"
    "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAAAA"
    "AAAAAAAAAAAAAEBAAAAAAAAAAAA="
    R"("}]})";

/// Two triangles that drift to and fro against one another, one of glass, and particles that the
/// other one emits. No camera.
inline constexpr const char* kGlassScene =
    R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0, 2]}],
        "nodes": [
            {"mesh": 0, "children": [3]},
            {"mesh": 1},
            {"children": [1], "translation": [2, 0.3, 0.5], "scale": [-1, 1, 1]},
            {"extras": {"particles": {
                "spans": [{"fromSeconds": -3, "perSecond": 30}], "lifeSeconds": 0.6,
                "lifeSpread": 0.5, "velocity": [0, 2, 0], "coneDegrees": 50, "sizeBirth": 0.3,
                "inherit": 1, "gravity": [0, -3, 0], "drag": 0.5}}}],
        "materials": [
            {"pbrMetallicRoughness": {"baseColorFactor": [0.9, 0.3, 0.2, 1]}},
            {"pbrMetallicRoughness": {"baseColorFactor": [0.2, 0.5, 0.9, 0.6]},
             "alphaMode": "BLEND", "doubleSided": true}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}, "material": 0}]},
                   {"primitives": [{"attributes": {"POSITION": 0}, "material": 1}]}],
        "accessors": [
            {"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3",
             "min": [-1, -1, 0], "max": [1, 1, 0]},
            {"bufferView": 1, "componentType": 5126, "count": 7, "type": "SCALAR",
             "min": [0], "max": [6]},
            {"bufferView": 2, "componentType": 5126, "count": 7, "type": "VEC3"}],
        "bufferViews": [{"buffer": 0, "byteLength": 36},
            {"buffer": 0, "byteOffset": 36, "byteLength": 28},
            {"buffer": 0, "byteOffset": 64, "byteLength": 84}],
        "animations": [{"name": "drift", "samplers": [{"input": 1, "output": 2}],
            "channels": [
                {"sampler": 0, "target": {"node": 0, "path": "translation"}},
                {"sampler": 0, "target": {"node": 1, "path": "translation"}}]}],
        "buffers": [{"byteLength": 148, "uri": "data:application/octet-stream;base64,)"
    "AACAvwAAgL8AAAAAAACAPwAAgL8AAAAAAAAAAAAAgD8AAAAAAAAAAAAAgD8AAABA"
    "AABAQAAAgEAAAKBAAADAQAAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAA"
    "AAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAAEAAAAAAAAAAAAAAAAAAAAAA"
    "AAAAAA=="
    R"("}]})";

} // namespace shutter::cli
