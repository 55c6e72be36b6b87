// SPDX-License-Identifier: MIT
// What a device cannot draw, and which option or device would do.
#include "game/shot/picture_drawer.h"

#include <fmt/format.h>

#include <cstdint>
#include <string>
#include <vector>

namespace shutter::game {

namespace {

core::Status
checkSize(const gpu::Device& device, const MethodInfo& method, uint32_t width, uint32_t height) {
    const uint32_t longest = device.limits().maxImageDimension2D;
    if (width > longest || height > longest)
        return core::makeError(
            "--size {}x{}: {} draws at most {} pixels a side",
            width,
            height,
            device.info().name,
            longest
        );
    const uint64_t bytesPerPixel = method.blur ? method.blur->listBytesPerPixel : 0;
    const uint64_t listBytes = uint64_t(width) * height * bytesPerPixel + 16;
    if (listBytes > device.limits().maxStorageBufferRange)
        return core::makeError(
            "--size {}x{}: method {} needs a buffer of {} MiB, {} has at most {}",
            width,
            height,
            method.name,
            listBytes >> 20,
            device.info().name,
            device.limits().maxStorageBufferRange >> 20
        );
    return {};
}

/// "; --device 'llvmpipe' can", or nothing where no other device of the machine can.
std::string suggestDevice(const gpu::Device& device, const MethodInfo& method) {
    std::vector<gpu::DeviceInfo> others = gpu::listDevices(device.instance());
    std::erase_if(others, [&](const gpu::DeviceInfo& other) {
        return other.handle == device.physical();
    });
    const gpu::DeviceInfo* found = findDeviceFor(method, others);
    return found ? fmt::format("; --device '{}' can", found->name) : std::string();
}

core::Status checkRays(const gpu::Device& device, const MethodInfo& method) {
    if (canRun(method, device))
        return {};
    const std::string other = suggestDevice(device, method);
    if (device.hasRays())
        return core::makeError(
            "--method {} nests ray queries (VK_KHR_ray_query), which {} lacks or --rays hides{}; "
            "resolved, hybrid and accumulate do without",
            method.name,
            device.info().name,
            other
        );
    return core::makeError(
        "--method {} needs ray tracing (VK_KHR_ray_query or, for hybrid, "
        "VK_KHR_ray_tracing_pipeline), which {} lacks or --rays hides{}; resolved and gather do "
        "without",
        method.name,
        device.info().name,
        other
    );
}

} // namespace

core::Status PictureDrawer::check(
    const gpu::Device& device, const MethodOptions& method, uint32_t width, uint32_t height
) {
    SHUTTER_TRY(checkRays(device, *method.method));
    return checkSize(device, *method.method, width, height);
}

} // namespace shutter::game
