// SPDX-License-Identifier: MIT
// Components: plain data on entities of ecs::Registry. Each field's line gives its meaning, unit
// and range.
#pragma once

#include "engine/ecs/entity.h"
#include "engine/math/math.h"
#include "engine/math/transform.h"
#include "engine/scene/assets.h"

#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

namespace shutter::scene {

struct Name {
    std::string value;
};

/// Transform relative to the parent (to the world without one) in the rest pose.
struct LocalTransform {
    math::Transform transform;
};

/// For nodes given by a matrix that no TRS can express (shear). Replaces LocalTransform; velocities
/// move it, clips do not (glTF has no clips on matrix nodes).
struct LocalMatrix {
    math::dmat4 matrix{1.0};
};

struct Parent {
    ecs::Entity entity; ///< null: a root; chains must end, the loader refuses cycles
};

/// Draws a mesh.
struct MeshInstance {
    AssetIndex mesh = kNone;
};

/// Constant velocity in the parent's space (world space for a root), counted from time 0.
struct LinearVelocity {
    math::dvec3 metresPerSecond{0.0};
};

/// Constant rotation about the entity's own origin; axis in the parent's space, length in rad/s.
struct AngularVelocity {
    math::dvec3 radiansPerSecond{0.0};
};

/// Channels of the clips that drive this entity; see animation.h. Later clips win.
struct Animated {
    struct Channel {
        uint32_t clip = 0;    ///< index into Assets::clips
        uint32_t channel = 0; ///< index into AnimationClip::channels
    };

    std::vector<Channel> channels;
};

/// The mesh of this entity is deformed by joints (linear blend skinning). Its own transform has no
/// meaning then (glTF 2.0, 3.7.3.3): the joints' do.
struct Skinned {
    AssetIndex skin = kNone;
    std::vector<ecs::Entity> joints; ///< one per joint of the skin, alive
};

/// Weights of the morph targets of this entity's mesh.
struct MorphWeights {
    std::vector<float> weights; ///< at rest, one per morph target
    std::vector<Animated::Channel>
        channels; ///< into AnimationClip::weightChannels; later clips win
};

/// One wave of VertexWaves.
struct VertexWave {
    math::dvec3 displacement{0.0}; ///< of a crest, metres, each within 1e6
    math::dvec3 waveVector{0.0};   ///< radians per metre, each within 1e6: crests travel along it;
                                   ///< 0: all vertices move at once
    double hertz = 0.0;            ///< [0, 1e6]
    double phase = 0.0;            ///< radians at time 0 at the origin, [-1e6, 1e6]
};

/// The vertex attribute that determines its share of the waves.
enum class WaveShare : uint8_t {
    All,    ///< every vertex follows them whole
    Height, ///< how far along an axis it is
    Color,  ///< one channel of its colour, [0, 1]
};

/// Most waves of an entity.
inline constexpr size_t kMaxVertexWaves = 16;

/// The mesh of this entity waves, as wind moves grass and cloth: each vertex is displaced by
/// share^exponent * (lean + sum over waves of displacement * sin(2 pi hertz t - waveVector . p +
/// phase)), with p its place after morphing and before skinning. A pure function of time.
struct VertexWaves {
    math::dvec3 lean{0.0}; ///< constant displacement, metres
    std::vector<VertexWave> waves;
    /// Vectors and p are the world's, so that neighbours wave as one field; without effect on a
    /// skinned entity. Else they are the entity's own.
    bool inWorld = false;
    WaveShare share = WaveShare::All;
    math::dvec3 axis{0.0, 1.0, 0.0}; ///< Height: along which, entity's space
    double heldAt = 0.0;             ///< Height: metres along the axis where the share is 0
    double freeAt = 1.0;             ///< Height: where it is 1, other than heldAt; linear between
    uint32_t channel = 3;            ///< Color: 0 ... 3 for red, green, blue, alpha
    double exponent = 1.0;           ///< [1, 16]: what bends stays straight near its root
};

enum class CameraKind : uint8_t { Perspective, Orthographic };

/// A camera with forward -Z and up +Y in its entity's space.
struct Camera {
    std::string name; ///< of the camera itself, independent of its entity's Name; may be empty
    CameraKind kind = CameraKind::Perspective;
    double yFov = 0.8; ///< perspective: vertical field of view of its frame, radians, (0, pi)
    /// Perspective: width / height of its frame, above 0; nothing: that of the picture.
    std::optional<double> aspectRatio{};
    double xMag = 1.0;   ///< orthographic: half width of its frame, metres, not 0; below 0 mirrors
    double yMag = 1.0;   ///< orthographic: half height of its frame, likewise
    double near = 0.05;  ///< metres, above 0
    double far = 1000.0; ///< metres; orthographic only, perspective reaches to infinity
};

/// Where in the exposure the raster image lies (engine/scene/shutter.md).
enum class ShutterPhase : uint8_t {
    Start,  ///< exposure runs [t, t + E]
    Centre, ///< [t - E/2, t + E/2]
    End,    ///< [t - E, t]
};

/// What determines the length of the exposure.
enum class ShutterMode : uint8_t {
    Physical, ///< seconds, independent of the frame rate
    Angle,    ///< a share of the frame's duration, as a rotating disc's opening
    Capped,   ///< Angle, but never longer than at the reference rate: a hitch does not smear
};

enum class ResponseShape : uint8_t { Box, Triangle, Trapezoid, Sampled };

/// How sensitive the sensor is over the exposure; only its shape counts, not its height.
struct ShutterResponse {
    ResponseShape shape = ResponseShape::Box;
    double openShare = 0.0;      ///< Trapezoid: share of the exposure that opening takes, [0, 1]
    double closeShare = 0.0;     ///< Trapezoid: that closing takes; the two together at most 1
    std::vector<double> samples; ///< Sampled: 2 to 64 at equal distances from open to close, 0 or
                                 ///< more, one of them above 0; linear between them
};

/// Thresholds at which a jump of the camera during the exposure counts as a cut: nothing then moves
/// in that frame. A jump has the same size in any interval, so no smooth motion is one, at any
/// speed.
struct CutDetection {
    bool enabled = true;
    double degrees = 10.0; ///< smallest turn that is a cut, above 0; stepped shake is far below it
    double metres = 0.5;   ///< smallest displacement that is one, above 0
};

/// Sits on the camera's entity. Without it, or with exposure 0, the picture is sharp.
struct CameraShutter {
    double exposureSeconds = 0.0; ///< Physical: [0, inf)
    ShutterPhase phase = ShutterPhase::End;
    ShutterMode mode = ShutterMode::Physical;
    double angleDegrees = 180.0; ///< Angle, Capped: 360 is the whole frame; 0 or more
    double referenceFps = 24.0;  ///< Capped: frames a second, above 0
    ShutterResponse response{};
    double cameraRotationScale = 1.0;    ///< of the blur by the camera's turning, [0, 2]
    double cameraTranslationScale = 1.0; ///< of the blur by its displacement, [0, 2]
    double objectScale = 1.0;            ///< scale of the blur of movers, [0, 2]
    /// Maximum motion across the picture, percent of its width, 0 or more (MotionCap).
    double maxBlurPercent = std::numeric_limits<double>::infinity();
    CutDetection cuts{};
};

/// Sits on the camera's entity; without it, or with fStop 0, the camera is a pinhole. lens.h
/// defines its effect on the picture.
struct CameraLens {
    double fStop = 0.0; ///< focal length by width of the opening, [0.01, 1e9]; 0: a pinhole
    double focusDistance = 10.0; ///< metres along the axis, [1e-4, 1e9]
    double sensorHeight = 0.024; ///< metres, [1e-4, 10]
    uint32_t blades = 0;         ///< sides of the opening, 3 to 16; 0: a disc
    double bladeRotation = 0.0;  ///< of the first corner from the right, counterclockwise, radians,
                                 ///< [-2 pi, 2 pi]
    double roundness = 0.0;      ///< of the sides, [0, 1]; 1: a disc
    double squeeze = 1.0;        ///< width of the opening by its height, (0, 4]
    double blurScale = 1.0;      ///< of the lens's width, [0, 2]
};

/// What a viewer changes of a camera's lens, whatever else focuses it (lens.h). Sits on the
/// camera's entity; the default changes nothing.
struct LensOverride {
    double fStop = 0.0;         ///< in place of the camera's, [0.01, 1e9]; 0: the camera's own
    double focusDistance = 0.0; ///< in place of the camera's, metres, [1e-4, 1e9]; 0: its own
    double blurScale = 1.0;     ///< of the lens's width, on top of the camera's, [0, 2]; 0: a
                                ///< pinhole
};

/// Artist's control of one entity and its descendants; the nearest one upwards counts.
struct MotionBlur {
    double scale = 1.0;   ///< of all its blur on the screen, the camera's part too, [0, 2]
    bool exclude = false; ///< as scale 0: sharp, although the camera moves
};

/// Neither the entity nor its descendants are drawn or give light. history.h: hide(), show().
struct Hidden {
    double seconds = -std::numeric_limits<double>::infinity(); ///< from this time on
};

/// The entity was created or shown at this time: it has no past, and is hidden before (history.h).
struct Appeared {
    double seconds = 0.0;
};

/// The entity and its descendants were put elsewhere at this time, not moved there (history.h).
struct Teleported {
    double seconds = 0.0;
};

/// On a camera: from this time on its picture is unrelated to the earlier one.
struct CameraCut {
    double seconds = 0.0;
};

enum class LightKind : uint8_t { Directional, Point, Spot };

/// KHR_lights_punctual; shines down its entity's -Z.
struct Light {
    LightKind kind = LightKind::Point;
    math::vec3 color{1.0f}; ///< linear
    float intensity = 1.0f; ///< directional: lux; point and spot: candela
    float range = std::numeric_limits<float>::infinity(); ///< metres; no light beyond
    float innerConeAngle = 0.0f;                          ///< radians, spot only
    float outerConeAngle = 0.7853982f;                    ///< radians, spot only
};

} // namespace shutter::scene
