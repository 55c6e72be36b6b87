// SPDX-License-Identifier: MIT
// Interface between the renderer and its shaders. "Camera-relative space" here has the world's axes
// and its origin at the camera's position at the raster instant: small numbers wherever the camera
// is.
#ifndef SHUTTER_SCENE_SHARED_H
#define SHUTTER_SCENE_SHARED_H

#include "common/shim.h"

SHUTTER_SHADER_BEGIN

/// Mesh id of a pixel that no entity covers.
SHUTTER_CONST uint kNoEntity = 0xFFFFFFFFu;
/// Depth of such a pixel, metres: beyond everything, and its square is still finite.
SHUTTER_CONST float kSkyDepth = 1.0e9f;
SHUTTER_CONST uint kNoTexture = 0xFFFFFFFFu;

struct Vertex {
    vec4 positionU0; // xyz object space, metres; w = uv0.x
    vec4 normalV0;   // xyz unit; w = uv0.y
    vec4 tangent;    // xyz unit, w handedness; all 0: no tangent
    vec2 uv1;
    uvec2 color; // four half floats, linear RGBA
};

/// EntityRow::motion of an entity that is static in the picture.
SHUTTER_CONST uint kNoMotion = 0xFFFFFFFFu;

/// One drawn entity at the raster instant; its index in the table is the mesh id.
struct EntityRow {
    mat4 clipFromObjectRaster;  // with the camera at the raster instant (jittered on request)
    vec4 relWorldFromObject[3]; // rows of the 3x4 matrix
    uint firstGeometry;         // index into the geometry table
    float handedness;  // -1 where the winding is turned round, by relWorldFromObject or by a
                       // mirrored skeleton, else 1
    uint motion;       // index into the table of motions, or kNoMotion
    uint instanceMask; // bits of its instance that a ray clears to exclude it and no other
                       // entity (instance_masks.h); 0: it has no unique mask
};

/// Where an entity that moves in the picture, or whose shape changes, is at the exposure's ends.
struct EntityMotion {
    mat4 clipFromObjectOpen;  // with the camera at shutter open
    mat4 clipFromObjectClose; // with the camera at shutter close
};

/// Triangles with one material.
struct Geometry {
    uvec2 vertices;       // address of Vertex[]
    uvec2 indices;        // address of uint[]
    uvec2 openPositions;  // address of vec4[]: xyz object space at shutter open, w 1, one per
                          // vertex; 0: the shape is static
    uvec2 closePositions; // the same at shutter close
    uint material;
    uint firstIndex; // in the scene's index buffer
    uint indexCount;
    uint vertexCount;
};

/// A texture with its coordinates' affine map: uv' = axes * uv + offset.
struct TextureRef {
    vec4 axes; // columns: xy = image of u, zw = image of v
    vec2 offset;
    uint texture; // index of the bindless array, or kNoTexture
    uint uvSet;   // 0 or 1
};

SHUTTER_CONST uint kMaterialUnlit = 1u;
SHUTTER_CONST uint kMaterialDoubleSided = 2u;
SHUTTER_CONST uint kMaterialMask = 4u;
SHUTTER_CONST uint kMaterialBlend = 8u;
SHUTTER_CONST uint kMaterialAdd = 16u;           // with kMaterialBlend: it hides nothing
SHUTTER_CONST uint kMaterialPremultiplied = 32u; // with kMaterialBlend: its colour has alpha in it

/// Bits of an instance's mask and of a ray's: what can be hit. A ray that clears some of the solid
/// bits misses the instances that have no others.
SHUTTER_CONST uint kSolidMask = 0x7Fu;   // opaque and masked surfaces
SHUTTER_CONST uint kBlendedMask = 0x80u; // blended ones

struct MaterialRow {
    vec4 baseColor;
    vec4 emissiveCutoff; // rgb emissive, a alpha cutoff
    vec4 surface;        // metallic, roughness, normal scale, occlusion strength
    uint flags;          // kMaterial...
    uint padding0;
    uint padding1;
    uint padding2;
    TextureRef baseColorTexture;
    TextureRef metallicRoughnessTexture;
    TextureRef normalTexture;
    TextureRef occlusionTexture;
    TextureRef emissiveTexture;
};

SHUTTER_CONST uint kLightDirectional = 0u;
SHUTTER_CONST uint kLightPoint = 1u;
SHUTTER_CONST uint kLightSpot = 2u;

struct LightRow {
    vec4 positionRange; // xyz camera-relative space, metres; w range in metres, 0: unlimited
    vec4 direction;     // xyz unit, the way the light travels
    vec4 radiance;      // rgb colour times intensity (lux or candela)
    uint kind;          // kLight...
    float spotScale;    // angular attenuation of KHR_lights_punctual
    float spotOffset;
    uint padding0;
};

SHUTTER_CONST uint kFrameUnlit = 1u;       // base colour only
SHUTTER_CONST uint kFrameEnvironment = 4u; // an environment is seen and lights the scene

/// Image-based light of a scene, in addition to its lights (scene::Environment).
struct EnvironmentConstants {
    vec4 irradiance[9];   // rgb: factors of the polynomials of evaluateIrradiance()
    vec4 mapFromWorld[3]; // xyz: rows
    uint background;      // indices of the bindless array
    uint mirrored;
    float roughestLevel;   // of `mirrored`: for a roughness of 1
    float texelsPerRadian; // of `background`, at the horizon
};

/// Tables that features add to shading: their places in FrameConstants::slots.
/// What holds light back (shaders/shadows/shadow_shared.h: ShadowConstants).
SHUTTER_CONST uint kSlotOcclusion = 0u;
/// Where shading of static surfaces changes from frame to frame (changing_tiles.glsl): uint[], the
/// number of tiles across the raster, then a word per tile, 0 where nothing changes.
SHUTTER_CONST uint kSlotChanging = 1u;
SHUTTER_CONST uint kShadingSlots = 2u;

/// Width and height of the tiles of kSlotChanging, pixels.
SHUTTER_CONST uint kChangingTilePx = 32u;

/// Lights beyond these, in the order of the table of lights, shine through everything.
SHUTTER_CONST uint kMaxOccludedLights = 16u;

struct FrameConstants {
    mat4 clipFromRelWorld;
    mat4 relWorldFromClip;
    mat4 clipFromRelWorldOpen;  // maps points at the raster instant to their place at shutter open,
                                // if static in the world
    mat4 clipFromRelWorldClose; // ... and at shutter close; a direction of the world has w = 0
    vec4 forward;        // xyz unit view direction; w: the smallest clip w in front of the camera
    vec4 background;     // linear RGB
    vec4 ambient;        // uniform radiance from everywhere, linear RGB
    vec2 sizePx;         // picture's width and height
    vec2 pixelFootprint; // pixel width, x: at distance 1 (perspective), y: at any (orthographic)
    float lodBias;       // added to every texture level of detail, except as below
    float staticLodBias; // added instead in the raster where an entity has no motion
    uint flags;          // kFrame...
    uint lightCount;
    uint entityCount; // rows of `entities`: no row is read for a mesh id that is not below it
    uvec2 entities;   // addresses of the tables
    uvec2 entityMotions;
    uvec2 geometries;
    uvec2 materials;
    uvec2 lights;
    uvec2 movingTlas;           // address of a second TLAS, of movers; 0: there is none
    uvec2 slots[kShadingSlots]; // addresses of kSlot...; 0: the frame has no such table
    uvec2 environment;          // address of EnvironmentConstants, where kFrameEnvironment is set
    /// Address of uint[], a bit for each row: 1 where rays meet no blended surface of the entity,
    /// which is drawn over the picture. 0: all are met.
    uvec2 takenRows;
};

/// Push constants of the G-buffer's draws.
struct DrawConstants {
    uvec2 frame; // address of FrameConstants
    uint entity;
    uint geometry;
};

SHUTTER_SHADER_END

#ifdef __cplusplus
static_assert(sizeof(shutter::shader::Vertex) == 64);
static_assert(sizeof(shutter::shader::EntityRow) == 128);
static_assert(sizeof(shutter::shader::EntityMotion) == 128);
static_assert(sizeof(shutter::shader::Geometry) == 48);
static_assert(sizeof(shutter::shader::TextureRef) == 32);
static_assert(sizeof(shutter::shader::MaterialRow) == 224);
static_assert(sizeof(shutter::shader::LightRow) == 64);
static_assert(sizeof(shutter::shader::FrameConstants) == 420);
static_assert(sizeof(shutter::shader::EnvironmentConstants) == 208);
static_assert(sizeof(shutter::shader::DrawConstants) == 16);
#endif

#endif
