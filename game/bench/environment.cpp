// SPDX-License-Identifier: MIT
#include "game/bench/results.h"
#include "game/bench/revision.h"

#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include <chrono>
#include <fstream>
#include <string>
#include <thread>
#include <unistd.h>

namespace shutter::bench {

namespace {

/// The value of the first line that starts with `key`, without the separators; empty where there is
/// no such line.
std::string readField(const char* path, const std::string& key, const char* separators) {
    std::ifstream stream(path);
    for (std::string line; std::getline(stream, line);) {
        if (line.compare(0, key.size(), key) != 0)
            continue;
        const size_t start = line.find_first_not_of(separators, key.size());
        const size_t end = line.find_last_not_of(" \"");
        return start == std::string::npos ? std::string() : line.substr(start, end + 1 - start);
    }
    return {};
}

} // namespace

nlohmann::json describeMachine() {
    const auto memory = uint64_t(::sysconf(_SC_PHYS_PAGES)) * uint64_t(::sysconf(_SC_PAGE_SIZE));
    return {
        {"cpu", readField("/proc/cpuinfo", "model name", "\t :")},
        {"cores", std::thread::hardware_concurrency()},
        {"memoryBytes", memory},
        {"os", readField("/etc/os-release", "PRETTY_NAME", "=\"")}};
}

nlohmann::json describeDevice(const gpu::DeviceInfo& device) {
    return {
        {"name", device.name},
        {"driver", device.driver},
        {"api",
         fmt::format(
             "{}.{}.{}",
             device.apiVersion >> 22 & 0x7F,
             device.apiVersion >> 12 & 0x3FF,
             device.apiVersion & 0xFFF
         )},
        {"rays", gpu::describe(device.rayTier)},
        {"software", device.kind == "software"}};
}

nlohmann::json describeRevision() {
    return {{"git", SHUTTER_REVISION}, {"dirty", SHUTTER_REVISION_DIRTY != 0}};
}

nlohmann::json describeOrigin(const std::string& suite, const gpu::DeviceInfo& device) {
    return {
        {"schema", "shutter-bench"},
        {"version", 2},
        {"suite", suite},
        {"created", describeNow()},
        {"complete", false},
        {"revision", describeRevision()},
        {"machine", describeMachine()},
        {"device", describeDevice(device)}};
}

std::string describeNow() {
    const auto now = std::chrono::floor<std::chrono::seconds>(std::chrono::system_clock::now());
    return fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(now));
}

} // namespace shutter::bench
