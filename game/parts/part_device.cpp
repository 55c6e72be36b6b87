// SPDX-License-Identifier: MIT
#include "game/parts/part_device.h"

#include "engine/io/file_bytes.h"
#include "engine/json/json_file.h"

#include <nlohmann/json.hpp>

#include <system_error>

namespace shutter::parts {

namespace fs = std::filesystem;

core::Result<std::optional<PartDevice>> readDevice(const fs::path& file) {
    std::error_code ignored;
    if (!fs::exists(file, ignored))
        return std::optional<PartDevice>();
    return json::readJsonFile(file, [](const json::JsonNode& root) {
        const auto object = root.readObject({"device", "driver"});
        return std::optional<PartDevice>(
            {object.require("device").readString(), object.require("driver").readString()}
        );
    });
}

core::Status settleDevice(const fs::path& file, const PartDevice& device, const std::string& noun) {
    nlohmann::ordered_json root;
    root["device"] = device.name;
    root["driver"] = device.driver;
    // A link to a whole file either appears under the name or finds it taken, on file systems that
    // machines share as well.
    const fs::path whole = io::makeTemporaryPath(file);
    SHUTTER_TRY(json::writeJsonFile(whole, root));
    std::error_code failure;
    std::error_code ignored;
    fs::create_hard_link(whole, file, failure);
    fs::remove(whole, ignored);
    if (failure && failure != std::errc::file_exists)
        return core::makeError("cannot write '{}': {}", file.string(), failure.message());
    const auto settled = readDevice(file);
    if (!settled)
        return settled.error();
    if (!settled.value())
        return core::makeError("cannot read '{}': it is gone", file.string());
    if (*settled.value() == device)
        return {};
    return core::makeError(
        "the {} is drawn by '{}' with driver '{}', and this is '{}' with driver '{}', whose "
        "pictures may differ",
        noun,
        settled.value()->name,
        settled.value()->driver,
        device.name,
        device.driver
    );
}

} // namespace shutter::parts
