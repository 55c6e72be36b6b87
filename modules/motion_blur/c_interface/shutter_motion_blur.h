/* SPDX-License-Identifier: MIT
 *
 * Motion blur for an engine that uses nothing else of Shutter, in C11: made from Vulkan handles,
 * recorded into the host's own command buffers, from the host's images into an image of the host.
 * shutter_motion_blur.hpp is the same for C++.
 *
 * Structures that begin with their size are made by the function of their name, which sets the size
 * and the default of every field:
 *
 *     ShutterBlurInputs inputs = shutterBlurDefaultInputs();
 *
 * A library takes the structures of older headers of its own major and minor version.
 *
 * Nothing is thrown and nothing aborts. On invalid calls the function returns an error, and
 * shutterBlurGetMessage() names the wrong field in one sentence.
 *
 * An object may be used by one thread at a time: a call during another thread's call, or from
 * within a callback, is refused, except for shutterBlurDestroy(). Matrices are column by column and
 * take columns. */
#ifndef SHUTTER_MOTION_BLUR_H
#define SHUTTER_MOTION_BLUR_H

#include <vulkan/vulkan.h>

#include <stdint.h>
#include <string.h>

#define SHUTTER_BLUR_VERSION_MAJOR 0
#define SHUTTER_BLUR_VERSION_MINOR 1
#define SHUTTER_BLUR_VERSION_PATCH 0
#define SHUTTER_BLUR_VERSION                                                                       \
    ((uint32_t                                                                                     \
    )((SHUTTER_BLUR_VERSION_MAJOR << 22) | (SHUTTER_BLUR_VERSION_MINOR << 12) |                    \
      SHUTTER_BLUR_VERSION_PATCH))

#if defined(_WIN32) && defined(SHUTTER_BLUR_SHARED)
#if defined(SHUTTER_BLUR_BUILDS)
#define SHUTTER_BLUR_API __declspec(dllexport)
#else
#define SHUTTER_BLUR_API __declspec(dllimport)
#endif
#elif defined(SHUTTER_BLUR_BUILDS)
#define SHUTTER_BLUR_API __attribute__((visibility("default")))
#else
#define SHUTTER_BLUR_API
#endif

#ifdef __cplusplus
extern "C" {
#endif

typedef enum ShutterBlurResult {
    SHUTTER_BLUR_SUCCESS = 0,
    SHUTTER_BLUR_ERROR_REFUSED = -1, /* an argument is wrong; nothing was done */
    SHUTTER_BLUR_ERROR_FAILED = -2,  /* out of memory, or the device is lost; reset the commands */
    SHUTTER_BLUR_RESULT_MAX = 0x7FFFFFFF
} ShutterBlurResult;

/* ---- Version ------------------------------------------------------------------------------- */

/* The library's SHUTTER_BLUR_VERSION. */
SHUTTER_BLUR_API uint32_t shutterBlurGetVersion(void);

/* Whether a program compiled with a header of this SHUTTER_BLUR_VERSION may use the library: the
 * same major and minor version, and a patch that is not newer. */
SHUTTER_BLUR_API VkBool32 shutterBlurIsCompatible(uint32_t headerVersion);

/* Why the last call of this thread that returned an error did so; empty: none has. Valid until the
 * thread's next call. */
SHUTTER_BLUR_API const char* shutterBlurGetMessage(void);

/* ---- What the device must have -------------------------------------------------------------- */

/* Switches the features on that the motion blur needs, in the structures that the chain holds:
 * `features` itself, VkPhysicalDeviceVulkan12Features or the ones that it replaces
 * (BufferDeviceAddress, ScalarBlockLayout), VkPhysicalDeviceVulkan13Features or the ones that it
 * replaces (Synchronization2, Maintenance4). SubgroupSizeControl is switched on, too, if the chain
 * has it: it is not required. All else in the chain is left as it is. Refused where the chain has
 * no structure for a required feature; the message names it. Vulkan 1.3 is needed, and no
 * extension. */
SHUTTER_BLUR_API ShutterBlurResult shutterBlurAddFeatures(VkPhysicalDeviceFeatures2* features);

/* Error, with a message that names the missing feature: the device cannot do that, or the queue
 * family has no compute shaders. */
SHUTTER_BLUR_API ShutterBlurResult
shutterBlurCheckDevice(VkPhysicalDevice physical, uint32_t queueFamily);

/* ---- The object ----------------------------------------------------------------------------- */

typedef struct ShutterBlur ShutterBlur;

/* One sentence for the person who writes the host, valid during the call. Called within
 * shutterBlurRecord(), shutterBlurMarkDone() and shutterBlurDestroy(); it must call none of them.
 */
typedef void (*ShutterBlurMessage)(void* user, const char* sentence);

/* Handles stay the host's and must outlive the object. */
typedef struct ShutterBlurDevice {
    uint32_t structBytes;
    uint32_t headerVersion; /* SHUTTER_BLUR_VERSION, checked; 0: unknown */
    VkPhysicalDevice physical;
    VkDevice device;         /* made with Vulkan 1.3 and the features above */
    uint32_t queueFamily;    /* of the command buffers */
    uint32_t framesInFlight; /* frames in flight times views, [1, 64] */
    VkBool32 hasDebugUtils;  /* VK_EXT_debug_utils is enabled: objects and passes get names */
    /* Pipeline cache, so that a host that saves it starts faster the next time; null: one that is
     * destroyed with the object. Not externally synchronized. */
    VkPipelineCache pipelineCache;
    /* The feature rayTracingPipelineTraceRaysIndirect is enabled. */
    VkBool32 tracesIndirect;
    /* VkApplicationInfo::apiVersion of the instance, checked; 0: unknown. */
    uint32_t apiVersion;
    /* The chain that the device was made with, checked; null: unknown, and subgroupSizeControl is
     * not used. Read by shutterBlurCreate() only. */
    const VkPhysicalDeviceFeatures2* enabledFeatures;
    /* shutterBlurRecord() takes the GPU's times and counts, for shutterBlurGetReport() and
     * ShutterBlurInputs::budgetMilliseconds: two timestamps a pass and a few small copies. */
    VkBool32 measures;
    /* Checks the inputs of each recording for range and consistency, and reports faults to
     * `message` (modules/motion_blur/embedding/README.md). 0 costs nothing. */
    VkBool32 checksInputs;
    /* Receives findings of the checker, failures of a dump, and a warning if the object is
     * destroyed too early; or null. */
    ShutterBlurMessage message;
    void* messageUser; /* its first argument */
} ShutterBlurDevice;

static inline ShutterBlurDevice shutterBlurDefaultDevice(void) {
    ShutterBlurDevice made;
    memset(&made, 0, sizeof(made));
    made.structBytes = (uint32_t)sizeof(made);
    made.headerVersion = SHUTTER_BLUR_VERSION;
    made.framesInFlight = 2;
    return made;
}

SHUTTER_BLUR_API ShutterBlurResult
shutterBlurCreate(const ShutterBlurDevice* device, ShutterBlur** blur);

/* The GPU must have finished with all that was recorded. Null: does nothing. */
SHUTTER_BLUR_API void shutterBlurDestroy(ShutterBlur* blur);

/* ---- Settings ------------------------------------------------------------------------------- */

/* "sampleCount" and "15", or "history" and "false": names, values and ranges are those of the page
 * modules/motion_blur/settings.md. */
typedef struct ShutterBlurValue {
    const char* name;
    const char* value;
} ShutterBlurValue;

typedef struct ShutterBlurSettings {
    uint32_t structBytes;
    /* One of shutterBlurGetMethod(). Null: resolved. But gather, where inputs.keys is null and
     * motionDepth is given, cameras are not, or vectors are without movers; the reason is reported
     * to `message` once. */
    const char* method;
    uint32_t sampleCount; /* taps or instants; 0: the method's own number */
    uint32_t valueCount;
    const ShutterBlurValue* values; /* all others are as the method's page has them */
    /* "off" (output gets a copy of color), "performance", "balanced" (neither needs rays),
     * "quality" (needs recordSamples) or "paper" (needs recordReveal): `values` override it;
     * `method` and a sampleCount of 0 are ignored. Null: none. */
    const char* preset;
} ShutterBlurSettings;

static inline ShutterBlurSettings shutterBlurDefaultSettings(void) {
    ShutterBlurSettings made;
    memset(&made, 0, sizeof(made));
    made.structBytes = (uint32_t)sizeof(made);
    return made;
}

/* Name of the index-th method that hosts can run, in order of rising quality; null: index out of
 * range. */
SHUTTER_BLUR_API const char* shutterBlurGetMethod(uint32_t index);

/* ---- Inputs --------------------------------------------------------------------------------- */

/* The host's use of an image before or after the motion blur. Stages of 0 are all commands, with
 * all they read and write; otherwise as in VkImageMemoryBarrier2. No barrier of the host's is
 * needed in between. */
typedef struct ShutterBlurUse {
    VkImageLayout layout; /* before: UNDEFINED drops the contents. After: UNDEFINED, as it comes */
    VkPipelineStageFlags2 stages;
    VkAccessFlags2 access;
} ShutterBlurUse;

/* 2D, one level, one sample, owned by the queue family of the commands. It may be destroyed once
 * the frame is complete. Usage and samples are checked as given, since Vulkan has no query for
 * them. Error: the image's memory is too small for the given format and extent. */
typedef struct ShutterBlurImage {
    VkImage image;
    VkFormat format;   /* UNDEFINED: the first that the input takes */
    VkExtent2D extent; /* of the whole image; 0 x 0: it ends where `area` does */
    /* The part that is used; an extent of 0 x 0: all of `extent` from the offset on, or the
     * picture's size if that is not given either. Inputs of another size than the picture's are
     * read at the nearest pixel. */
    VkRect2D area;
    VkImageUsageFlags usage;       /* that it was made with, checked; 0: unknown */
    VkSampleCountFlagBits samples; /* that it was made with, must be 1; 0: unknown */
    uint32_t layer; /* of an image of several, such as one for both eyes: the one that is used */
    ShutterBlurUse before;
    ShutterBlurUse after;
} ShutterBlurImage;

/* The camera of this frame and of the one before: needed for depth as the hardware stores it,
 * without vectors or with vectors that lack the camera's part, and where cameraScale is not
 * objectScale. */
typedef struct ShutterBlurCameras {
    VkBool32 areGiven;        /* the fields below count */
    VkBool32 aheadIsPlusZ;    /* of view space; 0: ahead is -Z */
    double viewFromWorld[16]; /* affine and not singular */
    /* Perspective or orthographic, any range and direction of depth, lenses may be shifted; without
     * jitter. y = -1 is the picture's top: a host that flips its viewport negates the second row.
     */
    double clipFromView[16];
    double viewFromWorldBefore[16];
    double clipFromViewBefore[16];
    /* By how much the pictures' samples lie right and down of their pixels' centres, pixels of the
     * picture, [-0.5, 0.5] as a rule. */
    double jitterPx[2];
    double jitterPxBefore[2];
} ShutterBlurCameras;

/* The camera at one shutter time, for "resolved". Between keys, translation is straight, rotation
 * takes the shorter arc, and scale, shear and projection are linear; before the first key and after
 * the last one everything is static. Three keys (open, raster, close) are enough for uniform
 * rotation by less than half a turn from key to key. */
typedef struct ShutterBlurCameraKey {
    /* Shutter time: 0 open, 1 close. One outside of [0, 1] affects the motion between it and the
     * next key, such as that of the previous frame: shutterBlurGetTimeBefore(). Within 1e6 of 0. */
    double time;
    double viewFromWorld[16]; /* in metres, as the depth in motionDepth */
    /* As above, the same kind in all keys, with the jitter of `color` in all keys: this frame's, or
     * none where anti-aliasing has taken it out before the blur. */
    double clipFromView[16];
} ShutterBlurCameraKey;

/* An entity that may not be static in the world, for "resolved". */
typedef struct ShutterBlurMover {
    uint32_t row; /* its value in `entityId`, below rowCount */
    /* World from the entity's own space, 16 numbers for each camera key, or where `keys` is null
     * for the frame before and for this one: affine, with any scale; where it is singular, the
     * entity is hidden. Null: it deforms, or its motion is unknown; its pixels then move by
     * ShutterBlurInputs::deformedMotion or else straight along their motion vectors. */
    const double* worldFromObject;
} ShutterBlurMover;

/* The camera's lens, for "resolved" and "adaptive": surfaces at the focus distance are sharp,
 * others are spread over the image of the lens's opening, together with their motion. A point at
 * depth z is spread over 2 s radius |1 / focusDistance - 1 / z| pixels, where s is half the
 * picture's height, in pixels, times the scale of y in clipFromView. */
typedef struct ShutterBlurLens {
    /* Half the height of the opening, metres, [0, 1000]: focal length / (2 f-number), at
     * rasterTime; it grows with the focal length where that changes from key to key. 0: a pinhole,
     * and no field below counts. */
    double radius;
    double focusDistance; /* along the view, metres, [1e-4, 1e9] */
    /* One for each camera key, or two as of worldFromObject, in place of focusDistance, for a focus
     * that is pulled during the exposure; its inverse is linear in between. Null: none. */
    const double* focusDistances;
    double bladeRotation; /* of the first corner from the right, counterclockwise, [-2 pi, 2 pi] */
    double roundness;     /* of the sides, [0, 1]; 1: a disc */
    double squeeze;       /* width of the opening by its height, (0, 4] */
    uint32_t blades;      /* sides of the opening, 3 to 16; 0: a disc */
} ShutterBlurLens;

/* A weapon, cockpit or the like that is drawn over the world in a range of depth values, and often
 * with a projection, of its own. In that range only its pixels lie, whatever `entityId` has there.
 * The camera does not blur them. */
typedef struct ShutterBlurViewModel {
    /* Lowest and highest value of `depth`, as stored, that its pixels have and no others: the depth
     * range of its viewport. Both 0: there is none. */
    float depthMin;
    float depthMax;
    /* Projection that it is drawn with, that range included, as cameras.clipFromView. All 0:
     * cameras.clipFromView itself. 0 where depthIsLinear. */
    double clipFromView[16];
    /* For "resolved" and "adaptive": view space from the model's own, 16 numbers for each camera
     * key, or two as of worldFromObject: how it moves before the camera. Null: it is sharp. Filters
     * blur it by `vectors`, which have no camera's part in it; without vectors it is sharp. */
    const double* viewFromObject;
} ShutterBlurViewModel;

/* How stored values become light: see ShutterBlurInputs::transfer. */
typedef enum ShutterBlurTransfer {
    SHUTTER_BLUR_TRANSFER_LINEAR = 0, /* light is the value */
    SHUTTER_BLUR_TRANSFER_SRGB = 1,   /* by the curve of sRGB (IEC 61966-2-1) */
    SHUTTER_BLUR_TRANSFER_POWER = 2,  /* light is the value to the power of transferPower */
    SHUTTER_BLUR_TRANSFER_MAX = 0x7FFFFFFF
} ShutterBlurTransfer;

/* The sensor's sensitivity at a shutter time, relative to that at others. */
typedef struct ShutterBlurResponsePoint {
    double time;        /* shutter time, [0, 1]: 0 open, 1 close */
    double sensitivity; /* finite, 0 or more, and not 0 at all points */
} ShutterBlurResponsePoint;

typedef struct ShutterBlurRevealTarget {
    VkImage image;
    VkImageView view;
} ShutterBlurRevealTarget;

/* For "hybrid": the buffers and images that the host's commands from recordReveal() read and write.
 * All of it is ready for compute shaders, and for ray-tracing shaders with revealByRayPipeline; no
 * barrier is needed after writes. Its images are in VK_IMAGE_LAYOUT_GENERAL. The images of
 * ShutterBlurInputs that the effect reads may be sampled: they are in
 * VK_IMAGE_LAYOUT_SHADER_READ_ONLY_OPTIMAL. */
typedef struct ShutterBlurRevealTask {
    uint32_t structBytes;
    VkCommandBuffer commands; /* those of the recording */
    uint32_t width;           /* of the picture */
    uint32_t height;
    /* Number of requested pixels (uint32_t), 12 bytes of other counts, then the pixels:
     * x | y << 16. */
    VkBuffer list;
    VkDeviceAddress listAddress;
    VkDeviceSize listBytes;
    /* VkDispatchIndirectCommand: groups of 64 threads. Thread t of group (x, y) serves pixel
     * (y * 256 + x) * 64 + t, if there are that many. */
    VkBuffer groups;
    /* VkTraceRaysIndirectCommandKHR, one launch a pixel; null unless
     * ShutterBlurDevice::tracesIndirect. */
    VkBuffer launch;
    VkDeviceAddress launchAddress;
    /* Storage images of the picture's size, to be written at every requested pixel: the surface
     * visible there past the entity in front. */
    ShutterBlurRevealTarget color;       /* RGBA16F */
    ShutterBlurRevealTarget motionDepth; /* RGBA32F: as ShutterBlurInputs::motionDepth */
    ShutterBlurRevealTarget entityId;    /* R32_UINT; 0xFFFFFFFF: the sky */
} ShutterBlurRevealTask;

/* For "adaptive": the buffers that the host's commands from recordSamples() read and write. All of
 * it is ready for compute shaders, and for ray-tracing shaders with samplesByRayPipeline; no
 * barrier is needed after writes. */
typedef struct ShutterBlurSampleTask {
    uint32_t structBytes;
    VkCommandBuffer commands; /* those of the recording */
    uint32_t width;           /* of the picture */
    uint32_t height;
    /* Number of requested samples (uint32_t), 12 bytes of other counts, then 8 bytes per sample:
     * its pixel, x | y << 16 (uint32_t), and its shutter time, 0 open to 1 close (float). */
    VkBuffer list;
    VkDeviceAddress listAddress;
    VkDeviceSize listBytes;
    /* VkDispatchIndirectCommand: groups of 64 threads. Thread t of group (x, y) serves sample
     * (y * 256 + x) * 64 + t, if there are that many. */
    VkBuffer groups;
    /* VkTraceRaysIndirectCommandKHR, one launch a sample; null unless
     * ShutterBlurDevice::tracesIndirect and samplesByRayPipeline. */
    VkBuffer launch;
    VkDeviceAddress launchAddress;
    /* 16 bytes per sample, to be written: red, green, blue (linear floats) of the surface visible
     * through the pixel's centre at that time, and a fourth float of 1; with a lens the surface's
     * depth along the view, metres, 1e9 for the sky. Samples that are not written retain the
     * looked-up colour. */
    VkBuffer answers;
    VkDeviceAddress answersAddress;
    VkDeviceSize answersBytes;
    /* 8 bytes per sample: its place of the lens, metres right and up in the picture (floats). The
     * ray starts there, and meets the focus plane where the pinhole's ray through the pixel's
     * centre does. Null: there is no lens. */
    VkBuffer lensPlaces;
    VkDeviceAddress lensPlacesAddress;
    VkDeviceSize lensPlacesBytes;
} ShutterBlurSampleTask;

/* The buffers and images that the host's commands from recordBlended() read and write for one part
 * of the exposure. All of it is ready for vertex, fragment and compute shaders; no barrier is
 * needed after writes. Images are in VK_IMAGE_LAYOUT_GENERAL. */
typedef struct ShutterBlurBlendedTask {
    uint32_t structBytes;
    VkCommandBuffer commands; /* those of the recording */
    VkRect2D area;            /* of the picture, pixels: the size of the images below */
    uint32_t part;            /* of the exposure, below partCount */
    uint32_t partCount;
    uint32_t firstInstant; /* of the part */
    uint32_t partInstantCount;
    uint32_t instantCount; /* of the whole exposure */
    /* Shutter times of all instants, rising: 0 open, 1 close. Valid during the call. */
    const double* times;
    /* 32-bit words: 8 reserved, then for each pair of instants one per pixel of the area, row by
     * row: two halves, the depth visible to the pixel at the even instant (low) and at the next
     * one, metres along the view; infinity for the sky, and this frame's depth where the uncovered
     * surface is unknown. Null: the method reads no instants; use this frame's depth. */
    VkBuffer surfaces;
    VkDeviceAddress surfacesAddress;
    VkDeviceSize surfacesBytes;
    /* RGBA16F, undefined before: colour attachment, storage image or target of copies. To be
     * written at every pixel: the sum over the part's instants of premultiplied colour divided by
     * instantCount, and of opacity likewise. */
    ShutterBlurRevealTarget color;
    ShutterBlurRevealTarget opacity; /* in red; null with blendedOpacityInAlpha */
} ShutterBlurBlendedTask;

/* As ShutterBlurRecordReveal. */
typedef void (*ShutterBlurRecordBlended)(void* user, const ShutterBlurBlendedTask* task);

/* As ShutterBlurRecordReveal. */
typedef void (*ShutterBlurRecordSamples)(void* user, const ShutterBlurSampleTask* task);

/* Records the host's commands, outside of rendering; they may bind anything. */
typedef void (*ShutterBlurRecordReveal)(void* user, const ShutterBlurRevealTask* task);

/* Arrays are read during the call only. */
typedef struct ShutterBlurInputs {
    uint32_t structBytes;
    uint32_t width; /* of the picture, pixels, [1, 32768] */
    uint32_t height;
    /* RGBA16F, RGBA32F, B10G11R11, RGBA8, BGRA8, A2B10G10R10, A2R10G10B10, RGBA16 (UNORM),
     * RGBA8 or BGRA8 (sRGB), by `transfer`. Sampled; RGBA16F of the picture's size: transfer
     * source, too; in place: as `output`, too. */
    ShutterBlurImage color;
    /* Like `color`. Storage usage for the first three formats, transfer-destination usage for the
     * others and for RGBA16F of the picture's size. Null: in place; the blurred picture replaces
     * `color`. */
    ShutterBlurImage output;

    /* Either motion and depth in the effect's own format, RGBA32F: displacement over the exposure,
     * pixels right and down; metres along the view, 1e9 for the sky. */
    ShutterBlurImage motionDepth;
    /* Or the host's motion vectors and depth, of any size; sampled. Null vectors: motion is the
     * camera's, from `cameras`; otherwise only movers with matrices move, for "resolved". */
    ShutterBlurImage vectors; /* RG16F, RG32F, RGBA16F or RGBA32F */
    ShutterBlurImage depth;   /* D32F, D16, X8D24, D24S8, D32FS8, or a first channel of floats */
    /* Factor from vectors to pixels of the picture, right and down, from the previous frame to this
     * one: (-width, -height) for vectors back in time in texture coordinates,
     * (-width / 2, height / 2) for vectors back in normalised device coordinates with y up. Not 0.
     */
    float pixelsPerUnit[2];
    VkBool32 vectorsLackCamera; /* vectors exclude camera motion; it is computed from `cameras` */
    VkBool32 vectorsHaveJitter; /* vectors include cameras.jitterPx */
    /* linear along the view; 0: hardware depth, decoded with `cameras` */
    VkBool32 depthIsLinear;
    float metresPerUnit; /* unit of linear depth, above 0 */
    /* Depth of the background. Linear: this value and all beyond it; otherwise the clear value, 0
     * for reversed depth. NaN: no value marks the sky. */
    float skyValue;
    ShutterBlurCameras cameras;
    /* Exposure divided by the time between frames, [0, 16]: 0.5 is a 180-degree shutter. With
     * motionDepth only "rosado2007" uses it, for the motion from `cameras`. */
    float exposureShare;
    /* Scale of the blur by camera motion and by object motion, [0, 16]. With keys the camera and
     * the movers go their ways faster or slower from rasterTime on, as far as their keys reach.
     * Must be 1 with motionDepth (except for "rosado2007"), with deformedMotion where that counts,
     * and for "adaptive". */
    float cameraScale;
    float objectScale;
    /* Displayed frames per rendered frame, with frame generation, [1, 16]: the exposure, and so the
     * blur, is divided by this. */
    float displayedPerRendered;
    /* R8, R16F or R32F: scale of the blur per pixel; null: 1. Refused with motionDepth, and by
     * "resolved" and "adaptive": see viewModelRows. */
    ShutterBlurImage blurScale;
    /* The previous frame showed another place, or there is none: nothing is blurred, and the
     * previous cameras are ignored. Without motionDepth, followsLast and all `keys` but the
     * raster's are ignored, too. */
    VkBool32 isCut;

    double rasterTime;   /* the raster instant in the exposure: 0 open, 0.5 centre, 1 close */
    int64_t frameNumber; /* consecutive frames have consecutive numbers */

    /* For "resolved": */
    /* R32_UINT, R16_UINT or R8_UINT, or the stencil of D24S8, D32FS8, D16S8 or S8, of any size;
     * sampled. It may be the image of `depth`, with the same use before and after. Null, without
     * movers: all but the sky is static in the world, and rowCount does not count. */
    ShutterBlurImage entityId;
    uint32_t noEntity; /* its value for the background, which the format must hold */
    /* [1, 2^24 - 1]. Values are rows below it; a pixel of another one, but noEntity, counts as
     * unresolved. */
    uint32_t rowCount;
    /* [1, 64]; 0, where cameras are given and motionDepth is not: two keys are made of them, the
     * frame before at shutterBlurGetTimeBefore() and this one. More keys are better where the
     * camera turns. */
    uint32_t keyCount;
    /* Times rising, one at rasterTime; ahead by cameras.aheadIsPlusZ. They alone determine the
     * length of the exposure: exposureShare scales vectors. */
    const ShutterBlurCameraKey* keys;
    uint32_t moverCount;
    /* In any order, each row once. A row without one is static in the world: where it is, and in
     * the previous frame. One that is listed but does not move costs next to nothing. */
    const ShutterBlurMover* movers;
    /* rowCount ids that entities have in every frame, so that history finds them in any row; one
     * that occurs twice is not found, and a new id removes an entity's history after a teleport.
     * Null: the rows themselves, so entities must not be added, removed or change their row. */
    const uint64_t* rowIds;
    uint32_t view; /* index of the view, below framesInFlight: each has its own history */
    /* The previous recording of this view was submitted before this one, to the same queue, and
     * shows the previous frame in the same world space, or nothing has moved since. Its raster is
     * looked up, too, unless it had another size or kind of projection. */
    VkBool32 followsLast;

    /* For "hybrid", with entityId and noEntity: */
    ShutterBlurImage normal;              /* RGBA16F or RGBA32F: xyz unit, of one space; sampled */
    ShutterBlurRecordReveal recordReveal; /* called once, before shutterBlurRecord() returns */
    void* revealUser;                     /* its first argument */
    VkBool32 revealByRayPipeline;         /* its commands launch a ray-tracing pipeline */

    /* For "adaptive", with all that is for "resolved": */
    ShutterBlurRecordSamples recordSamples; /* called once, before shutterBlurRecord() returns */
    void* samplesUser;                      /* its first argument */
    VkBool32 samplesByRayPipeline;          /* its commands launch a ray-tracing pipeline */

    /* For "resolved" and "adaptive" with followsLast, from a host that still has the previous
     * frame's images; null images: the object stores what it needs. None of them is written. */
    ShutterBlurImage lastColor;       /* sharp: that frame's `color` before the blur */
    ShutterBlurImage lastMotionDepth; /* RGBA32F, of the picture's size, as `motionDepth` */
    ShutterBlurImage lastEntityId;    /* null where that frame had none */

    /* GPU time that the effect may take of the frame: it gives up quality to stay within. 0:
     * unlimited. With ShutterBlurDevice::measures. */
    double budgetMilliseconds;

    /* For debugging: panels over the blurred picture show the effect's inputs, and the part that
     * the camera explains (modules/motion_blur/embedding/README.md). Dumps are without. */
    VkBool32 showsInputs;
    /* The shutter's response: times rise from 0 to 1, and it is straight between them. */
    const ShutterBlurResponsePoint* responsePoints;
    uint32_t responsePointCount; /* 2 to 64; 0: light is taken evenly over the exposure */

    /* For "resolved" and "adaptive": what movers without worldFromObject do, by pixel, for a host
     * that deforms its meshes itself. RGBA16F or RGBA32F: how far right and down of the pixel, in
     * pixels of the picture and without jitter, its surface is at shutter open (red, green) and at
     * close (blue, alpha). The way is the parabola through both and the pixel at rasterTime;
     * where that is within 0.1 of 0 or 1, it is straight. Other pixels do not count. Null: those
     * movers follow their motion vectors, and have no history. */
    ShutterBlurImage deformedMotion;
    /* The same for the raster of the previous frame: displacement of its pixels' surfaces from
     * there during this exposure. The host draws deforming entities again, posed as in that frame
     * and with its camera. With followsLast and deformedMotion; null: deforming entities have no
     * history. */
    ShutterBlurImage lastDeformedMotion;

    /* Transparent surfaces and particles as they are over the exposure, which go over the blurred
     * picture. RGBA16F or RGBA32F: premultiplied colour, linear, and opacity in alpha, [0, 1];
     * light that hides nothing has opacity 0. `color` and lastColor are opaque then. Null: none. */
    ShutterBlurImage blended;
    /* The same drawn by the host at instants of the exposure, against what "resolved" and
     * "adaptive" see at each of them, and over their background of each part of the exposure;
     * `blended` goes over that. Called once for each part, before shutterBlurRecord() returns. */
    ShutterBlurRecordBlended recordBlended;
    void* blendedUser;              /* its first argument */
    VkRect2D blendedArea;           /* that it may draw in; an extent of 0 x 0: the picture */
    uint32_t blendedInstants;       /* at most, [0, 256]; 0: the method's, 15 for filters */
    uint32_t blendedParts;          /* at most, [0, 4]; 0: 4. Filters have one */
    VkBool32 blendedOpacityInAlpha; /* opacity goes into alpha of the colours */

    /* For "resolved" and "adaptive", with perspective `keys`; other methods refuse it. Movers are
     * not required, nor a camera that moves. */
    ShutterBlurLens lens;

    /* For "resolved" and "adaptive": rows of a view model, such as a weapon or cockpit, that is
     * drawn with any projection and range of depth and follows the camera: it is sharp, and what it
     * hides is blurred behind it. None of them is a mover. Filters take such pixels' motion from
     * `vectors` or `blurScale`. */
    const uint32_t* viewModelRows;
    uint32_t viewModelRowCount;

    /* A camera that goes farther (in the unit of its matrices) or turns by more (degrees) between
     * the two frames of `cameras` counts as isCut, for a host that is not told of cuts. 0 or more;
     * 0: never.
     */
    double cutDistance;
    double cutDegrees;

    /* Named by depth, in place of viewModelRows or with them. Counts without motionDepth. */
    ShutterBlurViewModel viewModel;

    /* How values of `color`, lastColor and `output` become light, which alone can be averaged:
     * light is the curve of transferScale times the value. Alpha is not converted, and sRGB formats
     * have their own curve. `blended`, and what the host's callbacks write, is light. */
    ShutterBlurTransfer transfer;
    double transferPower; /* of SHUTTER_BLUR_TRANSFER_POWER, [1, 3] */
    double transferScale; /* 2 for a picture that is displayed twice as bright, [1/16, 16] */
} ShutterBlurInputs;

static inline ShutterBlurInputs shutterBlurDefaultInputs(void) {
    ShutterBlurInputs made;
    memset(&made, 0, sizeof(made));
    made.structBytes = (uint32_t)sizeof(made);
    made.pixelsPerUnit[0] = made.pixelsPerUnit[1] = 1.0f;
    made.metresPerUnit = 1.0f;
    made.exposureShare = 0.5f;
    made.cameraScale = made.objectScale = 1.0f;
    made.displayedPerRendered = 1.0f;
    made.rasterTime = 1.0;
    made.noEntity = 0xFFFFFFFFu;
    made.lens.focusDistance = 10.0;
    made.lens.squeeze = 1.0;
    made.transferPower = 2.2;
    made.transferScale = 1.0;
    return made;
}

/* Shutter time of the frame before's raster, for a host that knows that frame and this one alone:
 * it gives two keys, that frame's matrices at this time, and its own at inputs->rasterTime.
 * Exposures lie displayedPerRendered / exposureShare apart; a share below 1e-4 counts as that. */
static inline double shutterBlurGetTimeBefore(const ShutterBlurInputs* inputs) {
    const double share = inputs->exposureShare > 1.0e-4f ? inputs->exposureShare : 1.0e-4;
    return inputs->rasterTime - inputs->displayedPerRendered / share;
}

/* ---- Each frame ----------------------------------------------------------------------------- */

/* Records the effect into `commands`, which are being recorded, outside of rendering, and are
 * submitted once at most. It binds pipelines, sets 0 and push constants of the compute bind point.
 * `frame` is below framesInFlight: the GPU must have finished the last recording with that number,
 * and the host has waited for it; otherwise the call fails. Call shutterBlurMarkDone() for a
 * recording that is never submitted. After an error, the next frame of the view has no history,
 * regardless of followsLast. Settings may be null. */
SHUTTER_BLUR_API ShutterBlurResult shutterBlurRecord(
    ShutterBlur* blur,
    VkCommandBuffer commands,
    uint32_t frame,
    const ShutterBlurInputs* inputs,
    const ShutterBlurSettings* settings
);

/* Declares that the GPU has finished `frame`, or will never run it: for a recording that was
 * dropped, and for a number that is not recorded again soon, since resources retired after it, by
 * any frame, are freed only then. Resources retired by a resize are freed once every frame recorded
 * before it is complete. */
SHUTTER_BLUR_API ShutterBlurResult shutterBlurMarkDone(ShutterBlur* blur, uint32_t frame);

/* Closes the view: the history of "resolved" is freed once the view's frames are complete. Its
 * index may be reused. */
SHUTTER_BLUR_API ShutterBlurResult shutterBlurCloseView(ShutterBlur* blur, uint32_t view);

/* ---- Entities without names ----------------------------------------------------------------- */

/* An entity that a host lists anew in each frame. */
typedef struct ShutterBlurEntity {
    uint64_t model;  /* equal for what may be the same entity: model, skin, part, the host's hint */
    double place[3]; /* in the world */
} ShutterBlurEntity;

/* Finds each entity's place in the list of the frame before: pairs of the same model, the nearest
 * first, no farther apart than `reach`, each entity once. `indexBefore` gets nowCount indices into
 * `before`, UINT32_MAX for what is new. With them a host makes rowIds and movers' matrices. Takes
 * time by the number of pairs within `reach`. Places that are not finite match nothing. Error: a
 * pointer is null, or `reach` is negative or NaN. */
SHUTTER_BLUR_API ShutterBlurResult shutterBlurMatchEntities(
    const ShutterBlurEntity* before,
    uint32_t beforeCount,
    const ShutterBlurEntity* now,
    uint32_t nowCount,
    double reach,
    uint32_t* indexBefore
);

/* ---- Times and counters --------------------------------------------------------------------- */

typedef struct ShutterBlurPassTime {
    const char* name;
    double gpuMilliseconds;
    double cpuMilliseconds; /* to record it */
} ShutterBlurPassTime;

typedef struct ShutterBlurCounter {
    const char* name; /* "pixels masked", "rays traced", "unresolved samples" and the like */
    uint64_t value;
} ShutterBlurCounter;

/* Pointers are valid until the object's next call. */
typedef struct ShutterBlurReport {
    uint32_t structBytes;
    uint32_t passCount;
    const ShutterBlurPassTime* passes; /* in the order in which they ran */
    uint32_t counterCount;
    const ShutterBlurCounter* counters;
    double gpuMilliseconds;     /* of all passes together */
    const char* droppedQuality; /* to stay within budgetMilliseconds; empty: nothing */
} ShutterBlurReport;

static inline ShutterBlurReport shutterBlurDefaultReport(void) {
    ShutterBlurReport made;
    memset(&made, 0, sizeof(made));
    made.structBytes = (uint32_t)sizeof(made);
    return made;
}

/* Returns times and counters of the last recording with that number. Requires
 * ShutterBlurDevice::measures. Error: the GPU has not run the frame yet. */
SHUTTER_BLUR_API ShutterBlurResult
shutterBlurGetReport(ShutterBlur* blur, uint32_t frame, ShutterBlurReport* report);

/* ---- Memory and pipelines ------------------------------------------------------------------- */

/* Description of future recordings, before there are images. */
typedef struct ShutterBlurPlan {
    uint32_t structBytes;
    uint32_t width; /* of the picture, pixels */
    uint32_t height;
    uint32_t viewCount;                  /* that "resolved" keeps a frame of */
    const ShutterBlurSettings* settings; /* null: those of shutterBlurDefaultSettings() */
    VkFormat colorFormat;
    VkFormat outputFormat;   /* UNDEFINED: in place */
    VkFormat entityIdFormat; /* UNDEFINED: no ids */
    VkBool32 areParts;       /* color and output are parts or layers of larger images, or half
                              * floats with another transfer than LINEAR */
    VkBool32 hasVectors;     /* vectors and depth of the host's own in place of motionDepth */
    VkBool32 lendsLast;      /* lastColor and those with it */
    uint32_t rowCount;
    uint32_t moverCount;          /* with matrices, at most */
    VkBool32 givesDeformedMotion; /* deformedMotion and lastDeformedMotion */
    uint64_t blendedPixels;       /* of `blended`, or of blendedArea; 0: neither is given */
    VkBool32 drawsBlended;        /* recordBlended in place of `blended`, with the fields below */
    uint32_t blendedInstants;
    uint32_t blendedParts;
    VkBool32 blendedOpacityInAlpha;
    VkBool32 hasLens; /* all frames, or some, have a `lens` of a radius above 0 */
} ShutterBlurPlan;

static inline ShutterBlurPlan shutterBlurDefaultPlan(void) {
    ShutterBlurPlan made;
    memset(&made, 0, sizeof(made));
    made.structBytes = (uint32_t)sizeof(made);
    made.viewCount = 1;
    made.colorFormat = made.outputFormat = VK_FORMAT_R16G16B16A16_SFLOAT;
    made.entityIdFormat = VK_FORMAT_R32_UINT;
    made.rowCount = 1;
    return made;
}

/* Device memory that an object made for `device` will hold once it has recorded the plan under each
 * of its numbers: within a tenth. Makes no object. */
SHUTTER_BLUR_API ShutterBlurResult shutterBlurEstimateMemory(
    const ShutterBlurDevice* device, const ShutterBlurPlan* plan, uint64_t* bytes
);

/* Makes the pipelines that recording the plan needs, so that shutterBlurRecord() makes none: tens
 * to hundreds of milliseconds without a pipeline cache. */
SHUTTER_BLUR_API ShutterBlurResult
shutterBlurWarmUp(ShutterBlur* blur, const ShutterBlurPlan* plan);

/* The same on a background thread: shutterBlurIsWarm() returns whether it is done.
 * shutterBlurDestroy() waits for it. */
SHUTTER_BLUR_API ShutterBlurResult
shutterBlurStartWarmUp(ShutterBlur* blur, const ShutterBlurPlan* plan);

/* The call that finds the thread done takes a few milliseconds. */
SHUTTER_BLUR_API ShutterBlurResult shutterBlurIsWarm(ShutterBlur* blur, VkBool32* isWarm);

/* ---- Debugging ------------------------------------------------------------------------------ */

/* Writes inputs, settings and pictures of the next `frames` recordings, [1, 9999], to a folder,
 * which is created if missing, for `shutter replay`: each once its frame is complete. The first
 * recording of a view uses no history. Later errors are reported to ShutterBlurDevice::message. */
SHUTTER_BLUR_API ShutterBlurResult
shutterBlurDump(ShutterBlur* blur, const char* folder, uint32_t frames);

/* Device memory that the object holds now. */
typedef struct ShutterBlurMemory {
    uint32_t structBytes;
    uint32_t blockCount;
    uint64_t bytes;
} ShutterBlurMemory;

static inline ShutterBlurMemory shutterBlurDefaultMemory(void) {
    ShutterBlurMemory made;
    memset(&made, 0, sizeof(made));
    made.structBytes = (uint32_t)sizeof(made);
    return made;
}

SHUTTER_BLUR_API ShutterBlurResult
shutterBlurGetMemory(const ShutterBlur* blur, ShutterBlurMemory* memory);

#ifdef __cplusplus
}
#endif

#endif
